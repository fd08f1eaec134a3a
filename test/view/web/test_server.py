"""The server of the page, over real sockets: what is served and what is said."""

from __future__ import annotations

import asyncio
import re
import socket
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, WSMsgType
from heard_trials import Heard
from served import DEADLINE_S, Served, ask, next_frame, post

from blocks_planning.errors import ConfigurationError
from blocks_planning.subgoals.drawn import MalformedProposal, Refused
from blocks_planning.view.web import live
from blocks_planning.view.web import server as module
from blocks_planning.view.web.frame import Seen, frame_json
from blocks_planning.view.web.guards import HEADERS
from blocks_planning.view.web.server import PageServer
from blocks_planning.view.web.session import Session

STATIC = Path(module.__file__).with_name('static')


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
    """A page that does not read for a while then gets the latest frame, not every missed one."""
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
