"""The server of a study, over real sockets."""

from __future__ import annotations

import asyncio
import errno
import json
import os
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, WSMsgType
from studies import Served, served

from blocks_planning.study.log import read_events
from blocks_planning.view.study.seat import REPLACED, TAKEN

from .conftest import KEYS, Page, ask, page_of, state_of

SHOWN = {
    *('kind', 'title', 'stage', 'text', 'trial', 'acts', 'step', 'steps', 'may_stop', 'stopped'),
}
SHOWN_OF_TRIALS = {
    *('id', 'stimulus', 'width', 'height', 'silhouette', 'library', 'wishes', 'all_blocks'),
    *('sequence', 'proposals', 'answer', 'status', 'timed_out', 'left_s', 'limit_s', 'places'),
}


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
    looks = Counter[int]()

    async def look(client: ClientSession, number: int) -> None:
        """Open the page again and again, and try to act on it."""
        for _ in range(3):
            async with client.get(f'{study.base}/') as answer:
                assert answer.status == 200
            headers = {'Origin': study.base}
            async with client.ws_connect(f'{study.base}/live', headers=headers) as other:
                await other.send_json({'hello': f'{number:016}'})
                await other.send_json({'act': 'decline', 'number': 0, 'step': 0})
                assert (await other.receive_json())['kind'] == 'taken'
            looks[number] += 1

    async def act(page: Page) -> None:
        await page.go_to(3)
        await page.act('build', region=['....', '....', '#..#', '#..#'])
        await page.act('build', region=['####', '####', '#..#', '#..#'])

    async def talk(client: ClientSession) -> None:
        async with page_of(study, client) as page:
            await asyncio.gather(act(page), *(look(client, number) for number in range(16)))
            assert page.frame['trial']['status'] == 'success'

    ask(talk)
    assert looks == dict.fromkeys(range(16), 3)
    assert kinds(study).count('arrived') == 1


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
