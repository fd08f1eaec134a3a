"""A study with a scripted participant: server killed, page closed, disk full, at any act."""

from __future__ import annotations

import asyncio
import os
import random
import resource
import signal
import subprocess
import sys
from collections import Counter
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import asynccontextmanager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from aiohttp import ClientSession, CookieJar
from studies import ARCH, STUDY, TOKEN

from blocks_planning.study.events import EventKind
from blocks_planning.study.export import export_study
from blocks_planning.study.log import read_events
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun

DEADLINE_S = 120.0
KINDS = ('killed', 'killed before', 'closed', 'full')
"""The server is killed while it handles an act, or before one; the page is closed before the answer
comes; the disk is full."""
SCRIPT: list[dict[str, Any]] = [
    {'act': 'agree'},
    {'act': 'next'},
    {'act': 'next'},
    {'act': 'withdrawn', 'region': ['####', '....', '....', '....']},
    {'act': 'build', 'region': ['....', '....', '#..#', '#..#']},
    {'act': 'build', 'region': ['####', '####', '....', '....']},
    {'act': 'next'},
    {'act': 'mark', 'region': ['....', '....', '#..#', '#..#']},
    {'act': 'unmark'},
    {'act': 'mark', 'region': ['#...', '#...', '#...', '#...']},
    {'act': 'mark', 'region': ['####', '####', '####', '####']},
    {'act': 'next'},
    {'act': 'place', 'block': 0, 'column': 0},
    {'act': 'place', 'block': 0, 'column': 3},
    {'act': 'place', 'block': 3, 'column': 0},
    {'act': 'next'},
    {'act': 'next'},
]
"""Everything that a participant does, in order."""
ONCE = {
    EventKind.AGREED: 1,
    EventKind.PROPOSED: 6,
    EventKind.MARKED: 3,
    EventKind.UNMARKED: 1,
    EventKind.ENDED: 2,
    EventKind.FINISHED: 1,
}
"""How often each of these must have been kept."""
Plan = dict[int, str]
"""What happens at an act, by the act's number."""


@dataclass
class Taken:
    """Who takes part: code, acts that were answered, and the faults that are still to come."""

    code: str
    plan: Plan
    done: int = 0
    keys: Iterator[int] = field(default_factory=lambda: iter(range(10**6)))


class Killed(Exception):
    """The server was killed."""


def make_plans(seed: int, participants: int) -> list[Plan]:
    """A fault at every second act, each kind in turn, in an order of its own for each participant."""
    chance = random.Random(seed)
    plans = []
    for _ in range(participants):
        acts = chance.sample(range(1, len(SCRIPT)), len(SCRIPT) // 2)
        plans.append({act: KINDS[turn % len(KINDS)] for turn, act in enumerate(acts)})
    return plans


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


def run_study(
    folder: Path, plans: list[Plan], say: Callable[[str], None] = lambda _: None
) -> list[str]:
    """Let participants go through a study while faults happen; return what was lost."""
    (folder / 'arch.txt').write_text(ARCH)
    text = STUDY.format(towers=folder / 'arch.txt')
    (folder / 'study.yaml').write_text(
        text.replace('mode: building', 'mode: building, mark_parts: true')
    )
    people = [Taken(f'P{number:03}', dict(plan)) for number, plan in enumerate(plans, start=1)]
    for someone in people:
        while someone.done < len(SCRIPT):
            with serving(folder) as (process, url):
                run = take_part(url, someone, process, folder)
                asyncio.run(asyncio.wait_for(run, DEADLINE_S))
        say(f'study: {someone.code} is through, {len(plans[0])} faults each')
    return list(lost(folder, plans))


async def take_part(
    url: str, someone: Taken, process: subprocess.Popen[str], folder: Path
) -> None:
    """Do what is in the script, from the first act that was not answered, until a kill."""
    base = url.partition('/experimenter')[0]
    jar = CookieJar(unsafe=True)
    async with ClientSession(cookie_jar=jar, headers={'Origin': base}) as client:
        async with client.get(url) as answer:
            assert answer.status == 200
        if not someone.done:
            code = {'code': someone.code}
            async with client.post(f'{base}/experimenter/begin', json=code) as answer:
                assert answer.status == 200
        try:
            while someone.done < len(SCRIPT):
                async with page_of(client, base, next(someone.keys)) as (socket, frame):
                    await act_on(socket, frame, someone, process, folder)
        except Killed:
            return


@asynccontextmanager
async def page_of(client: ClientSession, base: str, key: int) -> AsyncIterator[tuple[Any, Any]]:
    """A page that was just opened, and its first frame; the server may not have missed the last."""
    while True:
        async with client.ws_connect(f'{base}/live') as socket:
            await socket.send_json({'hello': f'{key:016}'})
            frame = await socket.receive_json()
            if frame['kind'] == 'frame':
                yield socket, frame
                return


async def act_on(
    socket: Any,
    frame: dict[str, Any],
    someone: Taken,
    process: subprocess.Popen[str],
    folder: Path,
) -> None:
    """Do one act after the other until the page is closed, or all are done."""
    while someone.done < len(SCRIPT):
        number, fault = someone.done, someone.plan.pop(someone.done, '')
        said = {'number': number, 'step': frame['step'], 'thinking_s': 0.5, **SCRIPT[number]}
        if frame['acts'] == number + 1:  # it was kept, but the answer did not come
            someone.done += 1
            continue
        if fault == 'full':
            with full_disk(process.pid, folder / 'out' / 'participants' / someone.code):
                await socket.send_json(said)
                assert (await socket.receive_json())['code'] == 'disk'
        if fault == 'killed before':
            process.send_signal(signal.SIGKILL)
            raise Killed
        await socket.send_json(said)
        if fault == 'killed':
            process.send_signal(signal.SIGKILL)
            raise Killed
        if fault == 'closed':
            return
        while frame['acts'] == number:  # a page that has just gone may cause a frame for this one
            frame = await socket.receive_json()
            assert frame['kind'] == 'frame', frame
        assert frame['acts'] == number + 1, frame
        someone.done += 1


@contextmanager
def full_disk(pid: int, folder: Path) -> Iterator[None]:
    """A process can't write more than a few bytes of another event."""
    soft, hard = resource.prlimit(pid, resource.RLIMIT_FSIZE)
    size = (folder / 'events.jsonl').stat().st_size
    resource.prlimit(pid, resource.RLIMIT_FSIZE, (size + 7, hard))
    try:
        yield
    finally:
        resource.prlimit(pid, resource.RLIMIT_FSIZE, (soft, hard))


def lost(folder: Path, plans: list[Plan]) -> Iterator[str]:
    """What is not as the participants left it."""
    for number, plan in enumerate(plans, start=1):
        code = f'P{number:03}'
        kinds = Counter(
            event.kind for event in read_events(folder / 'out' / 'participants' / code)
        )
        found = {kind: kinds[kind] for kind in ONCE}
        if found != ONCE:
            yield f'{code}: {found} with {plan}'
        kills = sum(fault.startswith('killed') for fault in plan.values())
        if kinds[EventKind.OPENED] != kills + 1:
            yield f'{code}: opened {kinds[EventKind.OPENED]} times after {kills} kills'
    exported = export_study(folder / 'out', folder / 'tables')
    if exported.files['parts.csv'] != 2 * len(plans):
        yield f'{exported.files["parts.csv"]} parts in the table'
    paths = sorted((folder / 'tables' / 'records').iterdir())
    records = [record for path in paths for record in read_records(path)]
    if [record.status for record in records] != [TrialStatus.SUCCESS] * 2 * len(plans):
        yield f'records: {Counter(record.status for record in records)}'
    for record in records:
        yield from contradictions(record)
        yield from differs_from_rerun(record)
