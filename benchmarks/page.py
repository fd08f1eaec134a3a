"""The page: what showing a graph takes from the trials that run through it.

In turns without the page, with the page, and with somebody looking at it: a program that reads
every frame, as a browser does.
"""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median
from threading import Event, Thread

import yaml
from aiohttp import ClientError, ClientSession, WSMsgType

from benchmarks.graph import DEADLINE_S, _wait_for_records
from benchmarks.measure import Figure
from benchmarks.processes import process
from blocks_planning.ros.runtime.domain import Domain
from blocks_planning.ros.runtime.reserving import ReservedPort

NOBODY, PAGE, LOOKED_AT = 'without the page', 'with the page', 'page, and who looks'


def run(quick: bool) -> Iterator[Figure]:
    """Trials per second; frames per second at who looks."""
    domain = Domain()
    os.environ.update(domain.environment(os.environ))
    rates: dict[str, list[float]] = {NOBODY: [], PAGE: [], LOOKED_AT: []}
    frames = []
    for _ in range(3 if quick else 7):
        for way, found in rates.items():
            rate, seen_per_s = _rate(domain.number, 5 if quick else 25, way)
            found.append(rate)
            if way == LOOKED_AT:
                frames.append(seen_per_s)
    domain.release()
    for way, found in rates.items():
        yield Figure(f'trials per second, scoping, bfs (3), {way}', median(found), '/s')
    for way in (PAGE, LOOKED_AT):
        pairs = zip(rates[way], rates[NOBODY], strict=True)  # that had the same machine
        slower = 100 * (1 - median(rate / alone for rate, alone in pairs))
        yield Figure(f'  slower {way}', slower, '%', '< 10' if way == LOOKED_AT else '')
    yield Figure('frames per second at who looks', median(frames), '/s', '> 5')


def _rate(domain: int, seeds: int, way: str) -> tuple[float, float]:
    """Trials per second between the first and the last record; and frames per second."""
    script = {
        'stimuli': ['cogsci2021'],
        'seeds': seeds,
        'searches': [{'name': 'bfs', 'depth': 3}],
        'strategies': [{'name': 'scoping', 'lambda': 0.002}],
    }
    with tempfile.TemporaryDirectory() as folder, _Looker() as looker:
        path, records = Path(folder, 'script.yaml'), Path(folder, 'trials.jsonl')
        path.write_text(yaml.safe_dump(script), encoding='utf-8')
        command = [sys.executable, '-m', 'blocks_planning.cli', 'run', str(path)]
        command += ['--out', folder, '--domain', str(domain)]
        if way != NOBODY:
            port = ReservedPort('127.0.0.1')
            port.release()
            command += ['--view', '--view-port', str(port.number)]
        if way == LOOKED_AT:
            looker.look_at(port.number)
        with process(command) as running:
            first = _wait_for_records(running, records, 1)
            begun = looker.frames
            last = _wait_for_records(running, records, 16 * seeds)
            seen = looker.frames - begun
            running.wait(DEADLINE_S)
    return (16 * seeds - 1) / (last - first), seen / (last - first)


class _Looker:
    """A viewer of the page: reads frames in a thread and counts them."""

    def __init__(self) -> None:
        self.frames = 0
        self._end = Event()
        self._thread: Thread | None = None

    def __enter__(self) -> _Looker:
        return self

    def __exit__(self, *_: object) -> None:
        self._end.set()
        if self._thread is not None:
            self._thread.join()

    def look_at(self, port: int) -> None:
        self._thread = Thread(target=lambda: asyncio.run(self._look(port)))
        self._thread.start()

    async def _look(self, port: int) -> None:
        url = f'http://127.0.0.1:{port}'
        async with ClientSession(headers={'Origin': url}) as client:
            while not self._end.is_set():
                with contextlib.suppress(ClientError):
                    async with client.ws_connect(f'{url}/live') as live:
                        while not self._end.is_set():
                            message = await live.receive()
                            if message.type is not WSMsgType.TEXT:
                                break
                            self.frames += 1
                await asyncio.sleep(0.1)
