"""Computation and output of ``exact-policy --slip``."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import click

from blocks_planning.board.task import Task
from blocks_planning.cli.interrupt import interruptible
from blocks_planning.cli.progress import bar
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.search.slipping import SlipChances, analyse_slips

_MOST_AT_ONCE = 2
"""Number of towers that are analysed at the same time; each takes up to 0.5 GB."""


def print_slips(
    tasks: Sequence[tuple[str, Task]],
    slips: Sequence[float],
    depth: int | None,
    limit: int,
    as_json: bool,
) -> int:
    """Print a row per tower and slip as soon as the tower is done, in the order of towers."""
    search = BreadthFirst() if depth is None else BreadthFirst(depth)

    def analyse(task: Task, cancel: CancelToken) -> list[SlipChances] | None:
        return analyse_slips(Problem(task, 0, task.silhouette), slips, search, limit, cancel)

    def work(cancel: CancelToken) -> bool:
        """Analyse all towers, in threads: kernels run without the GIL. False if cancelled."""
        workers = min(_MOST_AT_ONCE, os.cpu_count() or 1)
        with ThreadPoolExecutor(workers) as pool, bar('Towers') as report:
            waiting = [(name, pool.submit(analyse, task, cancel)) for name, task in tasks]
            try:
                return _print_all(waiting, as_json, report)
            except BaseException:
                cancel.cancel()
                raise

    finished, interrupted = interruptible(work)
    if interrupted or not finished:
        raise KeyboardInterrupt
    return 0


def _print_all(
    waiting: Sequence[tuple[str, Future[list[SlipChances] | None]]],
    as_json: bool,
    report: Callable[[int, int], None],
) -> bool:
    """Print the towers in order, each once it is known; False if cancelled."""
    report(0, len(waiting))
    for done, (name, future) in enumerate(waiting, 1):
        found = future.result()
        if found is None:
            return False
        for chances in found:
            click.echo(_row(name, chances, as_json))
        report(done, len(waiting))
    return True


def _row(name: str, chances: SlipChances, as_json: bool) -> str:
    """One tower at one slip."""
    if as_json:
        return json.dumps({'stimulus': name, **vars(chances)})
    return (
        f'{name}: slip {chances.slip:g}: best possible {chances.optimum:.6g}, '
        f'bfs {chances.bfs:.6g}, random {chances.random:.6g} ({chances.states:,} states)'
    )
