"""Computation and output of ``exact-policy --slip``."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

import click

from blocks_planning.board.task import Task
from blocks_planning.cli.interrupt import interruptible
from blocks_planning.cli.progress import LIMIT_REACHED, bar
from blocks_planning.errors import LimitExceeded
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
    """Print a row per tower and slip as soon as the tower is done, in the order of towers.

    The row of a tower with too many states says so. Returns the exit code.
    """
    search = BreadthFirst() if depth is None else BreadthFirst(depth)

    def analyse(task: Task, cancel: CancelToken) -> list[SlipChances] | None:
        return analyse_slips(Problem(task, 0, task.silhouette), slips, search, limit, cancel)

    def work(cancel: CancelToken) -> int:
        """Analyse all towers, in threads: kernels run without the GIL. Returns the exit code."""
        workers = min(_MOST_AT_ONCE, os.cpu_count() or 1)
        with ThreadPoolExecutor(workers) as pool, bar('Towers') as report:
            waiting = [(name, pool.submit(analyse, task, cancel)) for name, task in tasks]
            try:
                return _print_all(waiting, as_json, report)
            except BaseException:
                cancel.cancel()
                raise

    code, interrupted = interruptible(work)
    if interrupted:
        raise KeyboardInterrupt
    return code


def _print_all(
    waiting: Sequence[tuple[str, Future[list[SlipChances] | None]]],
    as_json: bool,
    report: Callable[[int, int], None],
) -> int:
    """Print the towers in order, each once it is known, up to one that was cancelled."""
    code = 0
    report(0, len(waiting))
    for done, (name, future) in enumerate(waiting, 1):
        try:
            found = future.result()
        except LimitExceeded as error:
            code = LIMIT_REACHED
            click.echo(_row(name, {'problem': str(error)}, str(error), as_json))
        else:
            if found is None:
                return code
            for chances in found:
                click.echo(_row(name, vars(chances), _in_words(chances), as_json))
        report(done, len(waiting))
    return code


def _row(name: str, values: dict[str, object], words: str, as_json: bool) -> str:
    return json.dumps({'stimulus': name, **values}) if as_json else f'{name}: {words}'


def _in_words(chances: SlipChances) -> str:
    """One tower at one slip."""
    return (
        f'slip {chances.slip:g}: best possible {chances.optimum:.6g}, '
        f'bfs {chances.bfs:.6g}, random {chances.random:.6g} ({chances.states:,} states)'
    )
