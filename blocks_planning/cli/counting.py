"""Commands that compute exact properties of a tower: numbers of states, blocks, arrangements."""

from __future__ import annotations

import json
from functools import partial
from typing import TYPE_CHECKING

import click
import numpy as np

from blocks_planning.board.stimuli import Stimulus
from blocks_planning.board.task import Task
from blocks_planning.cli.options import (
    find_all,
    json_option,
    library_option,
    stimuli_argument,
    task_of,
)
from blocks_planning.cli.progress import LIMIT_REACHED, Job, each, time_limit_option
from blocks_planning.search.gauge import Gauge
from blocks_planning.search.result import CancelToken

if TYPE_CHECKING:
    from blocks_planning.search.exact import ExactAnswer


@click.command(epilog='\b\nExample:\n  blocks-planning count cogsci2021 --depth 5 --json')
@stimuli_argument
@click.option('--depth', type=click.IntRange(1, 64), default=4, show_default=True)
@time_limit_option
@library_option
@json_option
def count(
    addresses: tuple[str, ...], depth: int, time_limit_s: float | None, library: str, as_json: bool
) -> int:
    """Count the states that a breadth-first search evaluates.

    For each n from 1 to --depth, the command prints the number of tree nodes at depths 1 to n below
    the empty board. bfs evaluates that many states if it finds no complete state.

    If the time limit is reached, the numbers of the finished depths are printed and the exit code
    is 3. Memory does not grow with the number of states.
    """
    counts = [_Counts(stimulus, library, depth) for stimulus in find_all(addresses)]
    jobs = [Job(each_count.name, each_count.run, each_count) for each_count in counts]
    code = 0
    for outcome, found in zip(each('count', jobs, len(jobs), time_limit_s), counts, strict=True):
        numbers = found.finished
        if outcome.problem:
            code = LIMIT_REACHED
        if as_json:
            problem = {'problem': outcome.problem} if outcome.problem else {}
            click.echo(json.dumps({'stimulus': outcome.name, 'counts': numbers, **problem}))
        else:
            words = [f'{number:,}' for number in numbers]
            click.echo(f'{outcome.name}: ' + '  '.join([*words, *filter(None, [outcome.problem])]))
    return code


class _Counts:
    """The numbers of a tower; its text is the progress."""

    def __init__(self, stimulus: Stimulus, library: str, depth: int) -> None:
        self.name = stimulus.name
        self._task = task_of(stimulus, library)
        self._numbers = np.zeros(depth, np.int64)

    def run(self, cancel: CancelToken) -> list[int] | None:
        """Count, until the token is cancelled."""
        from blocks_planning.search.compiled import count_nodes

        return count_nodes(self._task, len(self._numbers), cancel, self._numbers)

    @property
    def finished(self) -> list[int]:
        """The numbers of the finished depths."""
        numbers: list[int] = self._numbers.tolist()
        return numbers[: int(np.count_nonzero(self._numbers))]

    def __str__(self) -> str:
        return f'depth {len(self.finished) + 1} of {len(self._numbers)}'


@click.command(epilog='\b\nExample:\n  blocks-planning exact cogsci2021/9 --json')
@stimuli_argument
@time_limit_option
@library_option
@json_option
def exact(
    addresses: tuple[str, ...], time_limit_s: float | None, library: str, as_json: bool
) -> int:
    """Find the fewest blocks and count the arrangements.

    If a tower cannot be built from the blocks, the command proves that. The second number of
    arrangements counts those with the fewest blocks. If a tower needs more than 20 million states
    (about 1 GB of memory), or more time than the limit, its row reports that, and the exit code is
    3.
    """
    stimuli = find_all(addresses)
    jobs = [_exact_job(stimulus.name, task_of(stimulus, library)) for stimulus in stimuli]
    code = 0
    for outcome in each('exact', jobs, len(jobs), time_limit_s):
        if outcome.result is None:
            code = LIMIT_REACHED
        if as_json:
            found = {'problem': outcome.problem} if outcome.result is None else None
            click.echo(json.dumps({'stimulus': outcome.name, **(found or vars(outcome.result))}))
        else:
            said = outcome.problem if outcome.result is None else _in_words(outcome.result)
            click.echo(f'{outcome.name}: {said}')
    return code


def _exact_job(name: str, task: Task) -> Job[ExactAnswer | None]:
    gauge = Gauge()
    return Job(name, partial(_analyse, task, gauge), gauge)


def _analyse(task: Task, gauge: Gauge, cancel: CancelToken) -> ExactAnswer | None:
    from blocks_planning.search.exact import analyse

    return analyse(task, cancel, gauge)


def _in_words(answer: ExactAnswer) -> str:
    rows = ' '.join('-' if number is None else str(number) for number in answer.by_rows)
    if answer.fewest_blocks is None:
        return f'impossible; arrangements 0; by number of rows: {rows}'
    return (
        f'fewest blocks {answer.fewest_blocks}; arrangements {answer.arrangements:,}, '
        f'with fewest blocks {answer.optimal_arrangements:,}; by number of rows: {rows}'
    )
