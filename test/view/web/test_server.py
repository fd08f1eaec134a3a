"""The server of the page, over real sockets."""

from __future__ import annotations

import asyncio
import json
import re
import socket
import threading
from collections.abc import Awaitable, Callable, Iterator
from concurrent.futures import Future
from dataclasses import replace
from functools import reduce
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, WSMsgType, WSServerHandshakeError

from blocks_planning.errors import ConfigurationError
from blocks_planning.subgoals.drawn import MalformedProposal, Refused
from blocks_planning.view.web import live
from blocks_planning.view.web import server as module
from blocks_planning.view.web.frame import Seen, frame_json
from blocks_planning.view.web.guards import HEADERS, Address, address_of
from blocks_planning.view.web.live import Mailbox
from blocks_planning.view.web.server import PageServer
from blocks_planning.view.web.serving import MOST_BYTES
from blocks_planning.view.web.session import Session, session_after

from .conftest import Heard

TOKEN = 'a-token_of-24-characters'
DEADLINE_S = 20.0
STATIC = Path(module.__file__).with_name('static')


class Served:
    """A server that runs, and what was proposed to it."""

    def __init__(self, address: Address) -> None:
        self.mailbox = Mailbox()
        self.proposed: list[Any] = []
        self.answer: Refused | Exception | None = None
        self.server = PageServer(address, self.mailbox, self._propose)
        self.server.start()
        self.base = f'http://127.0.0.1:{self.server.address.port}'
        self.from_page = {'Origin': self.base}

    def _propose(self, data: Any) -> Future[Refused | None]:
        self.proposed.append(data)
        answer: Future[Refused | None] = Future()
        if isinstance(self.answer, Exception):
            answer.set_exception(self.answer)
        else:
            answer.set_result(self.answer)
        return answer

    def show(self, trial: Heard, count: int | None = None) -> None:
        """Put what was heard so far into the mailbox."""
        session = reduce(session_after, trial.messages[:count], self.mailbox.seen.session)
        self.mailbox.put(Seen(session))


@pytest.fixture
def served() -> Iterator[Served]:
    """A server on the loopback."""
    made = Served(Address())
    yield made
    made.server.stop()


@pytest.fixture
def with_token() -> Iterator[Served]:
    """A server that asks for a token."""
    made = Served(address_of('0.0.0.0', 0, TOKEN))
    yield made
    made.server.stop()


def ask(talk: Callable[[ClientSession], Awaitable[Any]]) -> Any:
    """Talk with a server as a client of its own."""

    async def run() -> Any:
        async with ClientSession() as client:
            return await asyncio.wait_for(talk(client), DEADLINE_S)

    return asyncio.run(run())


def status_of(served: Served, method: str, path: str, **options: Any) -> int:
    """What a request is answered with."""

    async def talk(client: ClientSession) -> int:
        options.setdefault('allow_redirects', False)
        async with client.request(method, served.base + path, **options) as answer:
            await answer.read()
            return answer.status

    status: int = ask(talk)
    return status


def post(served: Served, data: Any = None, **headers: str) -> tuple[int, Any]:
    """Propose something, as the page does."""

    async def talk(client: ClientSession) -> tuple[int, Any]:
        sent = served.from_page | headers
        async with client.post(
            f'{served.base}/proposal', json={} if data is None else data, headers=sent
        ) as answer:
            return answer.status, await answer.json()

    said: tuple[int, Any] = ask(talk)
    return said


async def next_frame(live: Any) -> Any:
    """The next frame of a socket."""
    message = await live.receive()
    assert message.type is WSMsgType.TEXT, message
    return json.loads(message.data)


# What is served


def test_every_file_of_the_page_is_served(served: Served) -> None:
    async def talk(client: ClientSession) -> None:
        for path in STATIC.iterdir():
            name = '' if path.name == 'index.html' else path.name
            async with client.get(f'{served.base}/{name}') as answer:
                assert answer.status == 200, path
                assert await answer.read() == path.read_bytes()

    ask(talk)


def test_page_needs_nothing_from_elsewhere_and_has_no_inline_script() -> None:
    """It works offline, and under its own policy."""
    served_names = {path.name for path in STATIC.iterdir()}
    text = (STATIC / 'index.html').read_text()
    used = re.findall(r'(?:src|href)="([^"#]*)"', text)
    assert {name.removeprefix('/') for name in used} <= served_names
    assert not re.search(r'<script(?![^>]*src=)|<style|\son\w+=|\sstyle=', text)
    for path in STATIC.glob('*.js'):
        script = path.read_text()
        assert set(re.findall(r"from '\./([^']*)'", script)) <= served_names
        assert not re.search(
            r'innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(', script
        )
        assert re.findall(r'https?://[^\'"`$]*', script) in ([], ['http://www.w3.org/2000/svg'])
    assert not re.search(r'url\((?!#)|@import', (STATIC / 'style.css').read_text())


@pytest.mark.parametrize(
    'path', ['/', '/style.css', '/trials', '/replays', '/nothing', '/trials?from=x']
)
def test_every_answer_has_the_headers_that_protect(served: Served, path: str) -> None:
    async def talk(client: ClientSession) -> None:
        async with client.get(served.base + path) as answer:
            assert {name: answer.headers.get(name) for name in HEADERS} == dict(HEADERS)

    ask(talk)


@pytest.mark.parametrize(
    'path',
    ['/../server.py', '/%2e%2e/server.py', '/static/app.js', '/index.html/', '//etc/passwd'],
)
def test_nothing_but_the_page_is_served(served: Served, path: str) -> None:
    host, port = '127.0.0.1', served.server.address.port
    with socket.create_connection((host, port), timeout=DEADLINE_S) as raw:
        request = f'GET {path} HTTP/1.1\r\nHost: {host}:{port}\r\nConnection: close\r\n\r\n'
        raw.sendall(request.encode())
        assert raw.recv(64).startswith(b'HTTP/1.1 404 ')


def test_frames_are_what_was_seen(served: Served, scoped: Heard) -> None:
    async def talk(client: ClientSession) -> None:
        async with client.ws_connect(f'{served.base}/live', headers=served.from_page) as live:
            assert (await next_frame(live))['phase'] == 'waiting'
            served.show(scoped, 3)
            frame = await next_frame(live)
            assert (frame['kind'], frame['trial']['id']) == ('frame', scoped.spec.trial_id)

    ask(talk)


def test_a_frame_comes_also_when_nothing_is_new(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(live, 'QUIET_S', 0.1)

    async def talk(client: ClientSession) -> None:
        async with client.ws_connect(f'{served.base}/live', headers=served.from_page) as live:
            frames = [await next_frame(live) for _ in range(4)]
            assert all(frame['phase'] == 'waiting' for frame in frames)

    ask(talk)


def test_frames_are_dropped_and_never_queued(
    served: Served, scoped: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Somebody who does not read for a while gets the latest then, not all that were missed."""
    monkeypatch.setattr(live, 'FRAME_S', 0.0005)
    made = threading.Event()
    count = 0

    def padded(seen: Seen, now_s: float) -> Any:
        nonlocal count
        count += 1
        if count > 300:
            made.set()
        return {
            **frame_json(seen, now_s),
            'number': seen.session.told_again,
            'padding': 'x' * 100_000,
        }

    monkeypatch.setattr(live, 'frame_json', padded)

    async def talk(client: ClientSession) -> None:
        async with client.ws_connect(
            f'{served.base}/live', headers=served.from_page, max_msg_size=0
        ) as live:
            number = 0
            live._reader._protocol.pause_reading()
            while not made.is_set():
                number += 1
                served.mailbox.put(Seen(replace(Session(), told_again=number)))
                await asyncio.sleep(0.001)
            live._reader._protocol.resume_reading()
            read = 1
            while (await next_frame(live))['number'] != number:
                read += 1
            assert read < count / 2

    ask(talk)


def test_trials_that_ran_can_be_fetched(served: Served, scoped: Heard, by_person: Heard) -> None:
    for trial in (scoped, by_person):
        served.show(trial)

    async def talk(client: ClientSession) -> None:
        async with client.get(f'{served.base}/trials?from=1') as answer:
            assert [one['number'] for one in await answer.json()] == [1]
        async with client.get(f'{served.base}/replays') as answer:
            replays = await answer.json()
            assert [one['number'] for one in replays] == [0, 1]
            assert replays[0]['blocks'] == scoped.record.blocks
        for query in ('x', '-1', '1' * 10, '%20'):
            async with client.get(f'{served.base}/trials?from={query}') as answer:
                assert answer.status == 400

    ask(talk)


def test_replays_come_a_few_at_a_time(
    served: Served, scoped: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(module, 'MOST_REPLAYS', 1)
    served.show(scoped)
    served.show(replace_id(scoped))

    async def talk(client: ClientSession) -> None:
        async with client.get(f'{served.base}/replays?from=0') as answer:
            assert [one['number'] for one in await answer.json()] == [0]

    ask(talk)


def replace_id(trial: Heard) -> Heard:
    """The same under another name."""
    return trial._replace(messages=[replace(m, trial_id='other') for m in trial.messages])


def test_while_costs_are_hidden_none_is_served(
    served: Served, scoped: Heard, hidden: Heard
) -> None:
    served.show(scoped)
    served.show(hidden, 5)

    async def talk(client: ClientSession) -> None:
        for path in ('trials', 'replays'):
            async with client.get(f'{served.base}/{path}') as answer:
                (one,) = await answer.json()
                assert (one['action_cost'], one['subgoal_cost']) == (None, None)
                assert one.get('decisions', []) == []

    ask(talk)


def test_the_end_of_the_session_is_said_with_what_ran(served: Served, scoped: Heard) -> None:
    async def talk(client: ClientSession) -> None:
        async with client.ws_connect(f'{served.base}/live', headers=served.from_page) as live:
            await next_frame(live)
            served.show(scoped)
            await asyncio.get_running_loop().run_in_executor(None, served.server.stop)
            frames: list[Any] = []
            while not frames or frames[-1]['kind'] != 'over':
                frames.append(await next_frame(live))
            assert [one['blocks'] for one in frames[-1]['replays']] == [scoped.record.blocks]
            closing = await live.receive()
            assert (closing.type, closing.data) == (WSMsgType.CLOSE, 1001)

    ask(talk)


def test_an_address_that_is_taken_is_refused(served: Served) -> None:
    second = PageServer(served.server.address, served.mailbox, served._propose)
    place = f'127.0.0.1:{served.server.address.port}'
    with pytest.raises(ConfigurationError, match=f'cannot be served at {place}: .*in use'):
        second.start()


# What is said


def test_proposal_is_handed_on(served: Served) -> None:
    assert post(served, {'kind': 'build'}) == (200, {'taken': True})
    assert served.proposed == [{'kind': 'build'}]


@pytest.mark.parametrize(
    ('answer', 'status', 'code'),
    [
        (Refused('stale', 'changed'), 409, 'stale'),
        (Refused('waiting', 'wait'), 409, 'waiting'),
        (Refused('empty', 'nothing'), 422, 'empty'),
        (MalformedProposal('kind: what?'), 400, 'malformed'),
    ],
)
def test_why_it_is_not_taken_is_said(
    served: Served, answer: Refused | Exception, status: int, code: str
) -> None:
    served.answer = answer
    got, said = post(served)
    assert (got, said['code']) == (status, code)
    assert said['reason'] == (answer.reason if isinstance(answer, Refused) else str(answer))


# Who may


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
