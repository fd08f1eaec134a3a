"""What the experimenter's page asks the server for, over real sockets."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, WSServerHandshakeError
from studies import TOKEN, Served, served

from .conftest import ask, page_of, state_of


@pytest.mark.parametrize(
    'path', ['', '/state', '/begin', '/close', '/reopen', '?token=wrong', '/state?token=' + TOKEN]
)
def test_without_the_token_nothing_is_the_experimenters(study: Served, path: str) -> None:
    async def talk(client: ClientSession) -> None:
        method = 'POST' if path in ('/begin', '/close', '/reopen') else 'GET'
        async with client.request(
            method, f'{study.base}/experimenter{path}', json={}, headers={'Origin': study.base}
        ) as answer:
            assert answer.status == 401

    ask(talk)
    assert len(study.desk.standings()) == 1


def test_the_experimenter_begins_closes_and_opens_again(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        assert (await state_of(study, client))['current'] == 'P01'
        assert (await command(client, 'begin', 'P02'))[0] == 409
        assert (await command(client, 'close', ''))[1]['may_begin']
        status, state = await command(client, 'begin', 'P02')
        assert (status, state['current']) == (200, 'P02')
        assert (await command(client, 'begin', '../x'))[0] == 409
        await command(client, 'close', '')
        status, state = await command(client, 'reopen', 'P01')
        assert [one['status'] for one in state['participants']] == ['running', 'closed']
        async with page_of(study, client) as page:
            assert page.frame['step'] == 0
            await command(client, 'close', '')
            assert (await page.hear())['stage'] == 'waiting'

    async def command(client: ClientSession, name: str, code: str) -> tuple[int, Any]:
        headers = {'Origin': study.base}
        url = f'{study.base}/experimenter/{name}'
        async with client.post(url, json={'code': code}, headers=headers) as answer:
            return answer.status, await answer.json()

    ask(talk)


@pytest.mark.parametrize('origin', ['http://evil.example', 'null', None])
def test_another_page_changes_nothing(study: Served, origin: str | None) -> None:
    headers = {} if origin is None else {'Origin': origin}

    async def talk(client: ClientSession) -> None:
        await state_of(study, client)
        url = f'{study.base}/experimenter/close'
        async with client.post(url, json={'code': ''}, headers=headers) as answer:
            assert answer.status == 403
        with pytest.raises(WSServerHandshakeError):
            await client.ws_connect(f'{study.base}/live', headers=headers)

    ask(talk)
    assert study.desk.session is not None


def test_from_other_machines_each_page_needs_its_own_token(tmp_path: Path) -> None:
    theirs = 'a-participants-token'

    async def talk(client: ClientSession) -> None:
        async def status(path: str) -> int:
            async with client.get(study.base + path) as answer:
                return answer.status

        assert await status('/study.css') == 200
        assert await status(f'/experimenter?token={theirs}') == 401
        assert await status(f'/experimenter?token={TOKEN}') == 200
        assert await status('/experimenter/state') == 200
        assert await status('/') == 401  # the experimenter's token is for that page alone
        with pytest.raises(WSServerHandshakeError):
            await client.ws_connect(f'{study.base}/live', headers={'Origin': study.base})
        assert await status(f'/?token={theirs}') == 200
        async with page_of(study, client) as page:
            assert page.frame['stage'] == 'waiting'

    with served(tmp_path, token=theirs) as study:
        ask(talk)
