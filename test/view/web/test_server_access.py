"""The server of the page, over real sockets: who may use it, and how much."""

from __future__ import annotations

import asyncio
from pathlib import Path

import pytest
from aiohttp import ClientSession, WSMsgType, WSServerHandshakeError
from served import TOKEN, Served, ask, next_frame, post, status_of

from blocks_planning.view.web import server as module
from blocks_planning.view.web.serving import MOST_BYTES


@pytest.mark.parametrize('host', ['evil.example', '127.0.0.1', '127.0.0.1.evil.example:{port}'])
@pytest.mark.parametrize('path', ['/', '/live', '/trials', '/proposal'])
def test_a_foreign_name_for_this_server_is_refused(served: Served, host: str, path: str) -> None:
    headers = {'Host': host.format(port=served.server.address.port), **served.from_page}
    method = 'POST' if path == '/proposal' else 'GET'
    assert status_of(served, method, path, headers=headers) == 403
    assert served.proposed == []


@pytest.mark.parametrize('origin', ['http://evil.example', 'null', 'http://127.0.0.1:1', None])
def test_another_page_can_neither_propose_nor_look(served: Served, origin: str | None) -> None:
    headers = {} if origin is None else {'Origin': origin}
    assert status_of(served, 'POST', '/proposal', headers=headers, json={}) == 403
    assert status_of(served, 'GET', '/live', headers=headers) == 403
    assert served.proposed == []


@pytest.mark.parametrize('method', ['GET', 'HEAD', 'PUT', 'DELETE', 'OPTIONS', 'PATCH'])
def test_nothing_is_changed_but_by_post(served: Served, method: str) -> None:
    status = status_of(served, method, '/proposal', headers=served.from_page)
    assert status == 405
    assert served.proposed == []


@pytest.mark.parametrize('kind', ['text/plain', 'application/x-www-form-urlencoded', ''])
def test_only_json_is_read(served: Served, kind: str) -> None:
    headers = {**served.from_page, 'Content-Type': kind}
    assert status_of(served, 'POST', '/proposal', headers=headers, data='{}') in (400, 415)
    assert served.proposed == []


@pytest.mark.parametrize('body', ['', '{', '[' * 10_000, '\xff'])
def test_nonsense_is_refused(served: Served, body: str) -> None:
    headers = {**served.from_page, 'Content-Type': 'application/json'}
    assert (
        status_of(served, 'POST', '/proposal', headers=headers, data=body.encode('latin1')) == 400
    )
    assert served.proposed == []


def test_size_is_limited(served: Served) -> None:
    large = {'padding': 'x' * MOST_BYTES}
    assert post(served, large)[0] == 413
    assert served.proposed == []


def test_rate_is_limited(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(served.server._limit, '_per_s', 0.0)
    answers = [post(served)[0] for _ in range(module._BURST + 1)]
    assert answers == [200] * module._BURST + [429]
    assert len(served.proposed) == module._BURST


def test_number_of_browsers_is_limited(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, 'MOST_CLIENTS', 2)

    async def talk(client: ClientSession) -> None:
        place, headers = f'{served.base}/live', served.from_page
        first = await client.ws_connect(place, headers=headers)
        second = await client.ws_connect(place, headers=headers)
        with pytest.raises(WSServerHandshakeError) as refused:
            await client.ws_connect(place, headers=headers)
        assert refused.value.status == 503
        await first.close()
        while served.server.clients == 2:
            await asyncio.sleep(0)
        await next_frame(await client.ws_connect(place, headers=headers))
        await second.close()

    ask(talk)


def test_who_talks_on_the_socket_is_shown_out(served: Served) -> None:
    async def talk(client: ClientSession) -> None:
        for word in ('hello', 'x' * 5000):
            async with client.ws_connect(f'{served.base}/live', headers=served.from_page) as live:
                await live.send_str(word)
                while (message := await live.receive()).type is WSMsgType.TEXT:
                    pass
                assert message.type is WSMsgType.CLOSE
        assert served.proposed == []

    ask(talk)


@pytest.mark.parametrize('path', ['/', '/app.js', '/live', '/trials', '/replays', '/proposal'])
def test_without_the_token_nothing_is_served(with_token: Served, path: str) -> None:
    method = 'POST' if path == '/proposal' else 'GET'
    for headers in ({}, {'Cookie': f'{with_token.server.address.cookie}=wrong'}):
        sent = with_token.from_page | headers
        assert status_of(with_token, method, path, headers=sent) == 401
    assert with_token.proposed == []


def test_wrong_token_is_refused(with_token: Served) -> None:
    for wrong in ('', 'x', TOKEN[:-1], TOKEN + 'x', '%00'):
        assert status_of(with_token, 'GET', f'/?token={wrong}') == 401


def test_token_in_the_address_becomes_a_cookie(with_token: Served) -> None:
    async def talk(client: ClientSession) -> None:
        url = f'{with_token.base}/?token={TOKEN}'
        async with client.get(url, allow_redirects=False) as answer:
            assert (answer.status, answer.headers['Location']) == (303, '/')
            said = answer.headers['Set-Cookie']
        cookie = said.split(';')[0]
        assert {'HttpOnly', 'SameSite=Strict', 'Path=/'} <= set(said.split('; '))
        headers = with_token.from_page | {'Cookie': cookie}
        async with client.get(with_token.base, headers=headers) as answer:
            assert answer.status == 200
        async with client.post(f'{with_token.base}/proposal', headers=headers, json={}) as answer:
            assert answer.status == 200
        async with client.ws_connect(f'{with_token.base}/live', headers=headers) as live:
            await next_frame(live)

    ask(talk)


def test_it_listens_to_this_machine_alone(served: Served) -> None:
    port = served.server.address.port
    listening = [
        line.split()[1]
        for name in ('tcp', 'tcp6')
        for line in Path(f'/proc/net/{name}').read_text().splitlines()[1:]
        if line.split()[1].endswith(f':{port:04X}') and line.split()[3] == '0A'
    ]
    assert listening == [f'0100007F:{port:04X}']
