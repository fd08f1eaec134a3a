"""The server of a study is killed while somebody takes part."""

from __future__ import annotations

import asyncio
import os
import random
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from aiohttp import ClientSession, CookieJar
from studies import ARCH, STUDY, TOKEN

from blocks_planning.study.events import EventKind
from blocks_planning.study.export import export_study
from blocks_planning.study.log import read_events
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

KILLS = 2
DEADLINE_S = 60.0
SCRIPT: list[dict[str, Any]] = [
    {'act': 'agree'},
    {'act': 'next'},
    {'act': 'next'},
    {'act': 'withdrawn', 'region': ['####', '....', '....', '....']},
    {'act': 'build', 'region': ['....', '....', '#..#', '#..#']},
    {'act': 'build', 'region': ['####', '####', '....', '....']},
    {'act': 'next'},
    {'act': 'place', 'block': 0, 'column': 0},
    {'act': 'place', 'block': 0, 'column': 3},
    {'act': 'place', 'block': 3, 'column': 0},
    {'act': 'next'},
    {'act': 'next'},
]
"""Everything that the participant does, in order."""


@contextmanager
def serving(folder: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """The command that serves the study, and the address of the experimenter's page."""
    command = [sys.executable, '-m', 'blocks_planning.cli', 'study', str(folder / 'study.yaml')]
    process = subprocess.Popen(
        [*command, '--out', str(folder / 'out')],
        env=os.environ | {'BLOCKS_PLANNING_STUDY_TOKEN': TOKEN},
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    try:
        lines = [process.stdout.readline() for _ in range(2)]
        yield process, lines[1].partition(': ')[2].strip()
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


async def take_part(url: str, done: int, kill: tuple[int, Any]) -> int:
    """Do what is in the script from an act on; tell how many were answered.

    Args:
        url: of the experimenter's page.
        done: acts that were answered before.
        kill: an act, during which the server is killed, and its process.
    """
    base = url.partition('/experimenter')[0]
    jar = CookieJar(unsafe=True)
    async with ClientSession(cookie_jar=jar, headers={'Origin': base}) as client:
        async with client.get(url) as answer:
            assert answer.status == 200
        if not done:
            async with client.post(f'{base}/experimenter/begin', json={'code': 'P01'}) as answer:
                assert answer.status == 200
        async with client.ws_connect(f'{base}/live') as socket:
            await socket.send_json({'hello': 'k' * 16})
            frame = await socket.receive_json()
            for number in range(done, len(SCRIPT)):
                said = {'number': number, 'step': frame['step'], 'thinking_s': 0.5}
                await socket.send_json(said | SCRIPT[number])
                if number == kill[0]:
                    kill[1].send_signal(signal.SIGKILL)
                    return number
                frame = await socket.receive_json()
                assert frame['kind'] == 'frame', frame
                assert frame['acts'] == number + 1
    return len(SCRIPT)


@pytest.mark.long
def test_nothing_is_lost_when_the_server_is_killed(tmp_path: Path) -> None:
    (tmp_path / 'arch.txt').write_text(ARCH)
    (tmp_path / 'study.yaml').write_text(STUDY.format(towers=tmp_path / 'arch.txt'))
    kills = sorted(random.Random(0).sample(range(1, len(SCRIPT)), KILLS))
    done = 0
    for kill in [*kills, -1]:
        with serving(tmp_path) as (process, url):
            run = take_part(url, done, (kill, process))
            done = asyncio.run(asyncio.wait_for(run, DEADLINE_S))
    assert done == len(SCRIPT)
    events = read_events(tmp_path / 'out' / 'participants' / 'P01')
    kinds = [event.kind for event in events]
    assert kinds.count(EventKind.OPENED) == KILLS + 1
    assert kinds.count(EventKind.PROPOSED) == 6
    assert kinds.count(EventKind.ENDED) == 2
    assert EventKind.FINISHED in kinds
    export_study(tmp_path / 'out', tmp_path / 'tables')
    paths = (tmp_path / 'tables' / 'records').iterdir()
    records = [record for path in paths for record in read_records(path)]
    assert [record.status for record in records] == [TrialStatus.SUCCESS] * 2
    assert [list(contradictions(record)) for record in records] == [[], []]
