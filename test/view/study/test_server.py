"""The server of a study, over real sockets."""

from __future__ import annotations

import asyncio
import errno
import json
import os
from collections.abc import Awaitable, Callable, Iterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, CookieJar, WSMsgType, WSServerHandshakeError
from studies import TOKEN, Served, served

from blocks_planning.study.log import read_events
from blocks_planning.view.study.seat import REPLACED, TAKEN

DEADLINE_S = 20.0
KEYS = ('a' * 16, 'b' * 16)
SHOWN = {
    *('kind', 'title', 'stage', 'text', 'trial', 'acts', 'step', 'steps', 'may_stop', 'stopped'),
}
SHOWN_OF_TRIALS = {
    *('id', 'stimulus', 'width', 'height', 'silhouette', 'library', 'wishes', 'all_blocks'),
    *('sequence', 'proposals', 'answer', 'status', 'timed_out', 'left_s', 'limit_s', 'places'),
}


@pytest.fixture
def study(tmp_path: Path) -> Iterator[Served]:
    """A study whose first participant's session has begun."""
    with served(tmp_path) as made:
        made.desk.begin('P01')
        yield made


def ask(talk: Callable[[ClientSession], Awaitable[Any]]) -> Any:
    """Talk with a server as a client of its own."""

    async def run() -> Any:
        # A number is an address that cookies are kept for, too.
        async with ClientSession(cookie_jar=CookieJar(unsafe=True)) as client:
            return await asyncio.wait_for(talk(client), DEADLINE_S)

    return asyncio.run(run())


class Page:
    """A participant's page."""

    def __init__(self, socket: Any) -> None:
        self.socket = socket
        self.frame: dict[str, Any] = {}

    async def hear(self) -> dict[str, Any]:
        """What the server says next."""
        message = await self.socket.receive()
        assert message.type is WSMsgType.TEXT, message
        said: dict[str, Any] = json.loads(message.data)
        if said['kind'] == 'frame':
            self.frame = said
        return said

    async def act(self, word: str, **fields: Any) -> dict[str, Any]:
        """Do something, and hear what becomes of it."""
        said = {'act': word, 'number': self.frame['acts'], 'step': self.frame['step']}
        await self.socket.send_json({'thinking_s': 1.0, **said, **fields})
        return await self.hear()

    async def go_to(self, step: int) -> None:
        """Go on up to a step, without a trial between."""
        while self.frame['step'] < step:
            await self.act('agree' if self.frame['stage'] == 'consent' else 'next')


@asynccontextmanager
async def page_of(study: Served, client: ClientSession, key: str = KEYS[0]) -> Any:
    """A participant's page that is connected."""
    headers = {'Origin': study.base}
    async with client.ws_connect(f'{study.base}/live', headers=headers) as socket:
        await socket.send_json({'hello': key})
        page = Page(socket)
        await page.hear()
        yield page


def kinds(study: Served) -> list[str]:
    folder = study.folder / 'participants' / 'P01'
    return [event.kind.value for event in read_events(folder)]


# The participant


def test_a_participant_sees_this_and_nothing_else(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            texts = []
            while page.frame['stage'] != 'debrief':
                texts.append(json.dumps(page.frame))
                assert set(page.frame) <= SHOWN
                trial = page.frame['trial']
                if trial is None:
                    await page.act('agree' if page.frame['stage'] == 'consent' else 'next')
                    continue
                assert set(trial) <= SHOWN_OF_TRIALS
                await page.act('give_up')
                texts.append(json.dumps(page.frame))
                await page.act('next')
            for word in ('seed', 'cost', 'bfs', 'budget', 'arch', 'P01', 'study_id', 'parts'):
                assert [text for text in texts if word in text] == [], word

    ask(talk)


def test_who_looks_in_from_elsewhere_is_refused(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as first:
            async with client.ws_connect(
                f'{study.base}/live', headers={'Origin': study.base}
            ) as second:
                await second.send_json({'hello': KEYS[1]})
                assert (await second.receive_json())['kind'] == 'taken'
                assert (await second.receive()).data == TAKEN
            await first.act('agree')
            assert first.frame['step'] == 1
        async with page_of(study, client, KEYS[1]) as third:
            assert third.frame['step'] == 1

    ask(talk)


def test_sixteen_browsers_look_and_one_acts(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            for number in range(16):
                async with client.ws_connect(
                    f'{study.base}/live', headers={'Origin': study.base}
                ) as other:
                    await other.send_json({'hello': f'{number:016}'})
                    await other.send_json({'act': 'decline', 'number': 0, 'step': 0})
                    assert (await other.receive_json())['kind'] == 'taken'
            assert (await page.act('agree'))['step'] == 1

    ask(talk)


def test_the_same_page_comes_again_before_it_is_known_to_be_gone(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as first:
            await first.act('agree')
            async with page_of(study, client) as again:
                assert again.frame['step'] == 1
                assert (await first.socket.receive()).data == REPLACED
                # What it sent before and got no answer to, it sends again.
                await again.socket.send_json({'act': 'agree', 'number': 0, 'step': 0})
                assert (await again.hear())['step'] == 1
                await again.act('next')

    ask(talk)
    assert kinds(study).count('agreed') == 1


def test_coming_and_leaving_are_kept(study: Served) -> None:
    async def talk(client: ClientSession) -> None:
        for _ in range(2):
            async with page_of(study, client):
                pass
            while kinds(study)[-1] != 'left':
                await asyncio.sleep(0)

    ask(talk)
    assert kinds(study) == ['opened', 'arrived', 'left', 'arrived', 'left']


@pytest.mark.parametrize(
    'said',
    [
        {},
        {'act': 'agree'},
        {'act': 'agree', 'number': 7, 'step': 0},
        {'act': 'build', 'number': 0, 'step': 0},
        {'act': 'begin', 'number': 0, 'step': 0, 'code': 'P02'},
        {'note': 'pointer', 'step': 0, 'points': 'x'},
        {'note': 'events', 'step': 0},
    ],
)
def test_what_is_not_asked_for_changes_nothing(study: Served, said: Any) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            await page.socket.send_json(said)
            assert (await page.hear())['kind'] == 'refused'
            assert (await page.act('agree'))['step'] == 1

    ask(talk)
    assert [one.participant.code for one in study.desk.standings()] == ['P01']


@pytest.mark.parametrize('text', ['', '[]', '{', 'x' * 20_000, '[' * 9000])
def test_nonsense_ends_the_connection_alone(study: Served, text: str) -> None:
    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            await page.socket.send_str(text)
            assert (await page.socket.receive()).type in (WSMsgType.CLOSE, WSMsgType.CLOSED)
        async with page_of(study, client, KEYS[1]) as page:
            assert page.frame['step'] == 0

    ask(talk)


def test_on_a_full_disk_the_page_and_the_experimenter_are_told(
    study: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(descriptor: int, data: bytes) -> int:
        raise OSError(errno.ENOSPC, 'No space left on device')

    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            with monkeypatch.context() as patch:
                patch.setattr(os, 'write', full)
                assert (await page.act('agree'))['code'] == 'disk'
            state = await state_of(study, client)
            assert 'No space left' in state['trouble']
            assert (await page.act('agree'))['step'] == 1

    ask(talk)


def test_the_time_of_a_trial_runs_out_by_itself(tmp_path: Path) -> None:
    async def talk(client: ClientSession, study: Served) -> None:
        async with page_of(study, client) as page:
            await page.go_to(3)
            await page.act('give_up')
            await page.act('next')
            while not page.frame['trial']['timed_out']:
                await page.hear()
            assert page.frame['trial']['status'] == 'cancelled'
            await page.act('next')
            assert page.frame['stage'] == 'debrief'

    with served(tmp_path, limit_s=1) as study:
        study.desk.begin('P01')
        ask(lambda client: talk(client, study))


def test_a_server_that_was_killed_goes_on(tmp_path: Path) -> None:
    async def first(client: ClientSession, study: Served) -> None:
        async with page_of(study, client) as page:
            await page.go_to(3)
            await page.act('build', region=['....', '....', '#..#', '#..#'])
            study.crash()

    async def second(client: ClientSession, study: Served) -> None:
        async with page_of(study, client) as page:
            assert len(page.frame['trial']['all_blocks']) == 2
            await page.act('build', region=['####', '####', '#..#', '#..#'])
            assert page.frame['trial']['status'] == 'success'

    killed = Served(tmp_path)
    killed.desk.begin('P01')
    ask(lambda client: first(client, killed))
    with served(tmp_path) as again:
        ask(lambda client: second(client, again))


# The experimenter


async def state_of(study: Served, client: ClientSession) -> Any:
    async with client.get(study.experimenter) as answer:
        assert answer.status == 200
    async with client.get(f'{study.base}/experimenter/state') as answer:
        assert answer.status == 200
        return await answer.json()


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
