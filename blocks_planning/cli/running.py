"""Commands that run trials."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import click

from blocks_planning.cli.interrupt import interruptible
from blocks_planning.cli.options import (
    json_option,
    planner_options,
    refuse_nan,
    specs_of,
    stimuli_argument,
)
from blocks_planning.cli.progress import (
    LIMIT_REACHED,
    Job,
    Progress,
    each,
    time_limit_option,
)
from blocks_planning.errors import BlocksPlanningError
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.limits import ended_at_a_limit
from blocks_planning.trials.messages import Message, PlaceBlock, SearchAnswer
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

_SOLVE_EXAMPLES = """\b
Examples:
  blocks-planning solve cogsci2021/9
  blocks-planning solve cogsci2021 --seeds 32 --lambda 0.004
  blocks-planning solve cogsci2021 --strategy none --search astar --divisor mean
  blocks-planning solve my/towers.txt --library 1x1,2x1 --json > records.jsonl
"""
_WATCH_EXAMPLES = """\b
Examples:
  blocks-planning watch cogsci2021/9
  blocks-planning watch cogsci2021/9 --strategy full --pause 0.1
"""


@click.command(epilog=_SOLVE_EXAMPLES)
@stimuli_argument
@planner_options
@click.option(
    '--seeds',
    type=click.IntRange(1, 1_000_000),
    default=1,
    show_default=True,
    help='Number of trials per stimulus, with seeds from --seed upwards.',
)
@time_limit_option
@json_option
def solve(
    addresses: tuple[str, ...],
    seeds: int,
    time_limit_s: float | None,
    as_json: bool,
    **options: Any,
) -> int:
    """Run trials and print a table or their records.

    With --json, each line is the record of a trial. The exit code is 1 if a tower was not rebuilt
    perfectly, and 3 if the time limit ended a trial or a search exceeded its memory (1 GB).
    """
    specs = specs_of(addresses, seeds, options)
    records = []
    limited = False
    for record, problem in _run_all(specs, time_limit_s):
        records.append(record)
        limited = limited or bool(problem)
        if as_json:
            click.echo(record.to_line())
        if problem:
            place = f'{record.spec.stimulus}, seed {record.spec.seed}'
            click.echo(f'{place}: {record.status.value}: {problem}', err=True)
    if not as_json:
        from blocks_planning.view.tables import print_summary

        print_summary(records)
    return LIMIT_REACHED if limited else _exit_code(records)


@click.command(epilog=_WATCH_EXAMPLES)
@stimuli_argument
@planner_options
@click.option(
    '--pause',
    type=click.FloatRange(0, 60),
    callback=refuse_nan,
    default=0.25,
    show_default=True,
    help='Seconds between placements.',
)
def watch(addresses: tuple[str, ...], pause: float, **options: Any) -> int:
    """Play trials in the terminal, block by block."""
    from rich.console import Console

    from blocks_planning.view.terminal import watch_trial

    console = Console()
    records = []
    for spec in specs_of(addresses, 1, options):
        record, interrupted = interruptible(partial(watch_trial, spec, console, pause_s=pause))
        if interrupted:
            raise KeyboardInterrupt
        records.append(record)
    return _exit_code(records)


def _run_all(
    specs: list[TrialSpec], time_limit_s: float | None
) -> Iterator[tuple[TrialRecord, str]]:
    """Run trials in order; each with the limit that it reached, or ''.

    An interrupted trial is yielded too, as cancelled. Long trials are reported on stderr as they
    end, because the table is printed only at the end.
    """
    progress = Progress()
    jobs = (_job_of(spec) for spec in specs)
    for outcome in each('solve', jobs, len(specs), time_limit_s, progress):
        record = outcome.result
        if record is None:  # a trial always gives a record
            raise BlocksPlanningError(f'{outcome.name}: {outcome.problem}')
        if len(specs) > 1 and outcome.took_s > progress.patience_s:
            seconds = f'{outcome.took_s:,.1f} s'
            progress.say(
                f'{outcome.name}: {record.status.value}, {record.blocks} blocks, {seconds}'
            )
        yield record, outcome.problem or _memory_limit_of(record)


def _job_of(spec: TrialSpec) -> Job[TrialRecord]:
    watched = _Watched(spec)
    return Job(f'{spec.stimulus}, seed {spec.seed}', watched.run, watched)


class _Watched:
    """A trial whose text is its progress."""

    def __init__(self, spec: TrialSpec) -> None:
        self._spec = spec
        self._blocks = self._states = 0

    def run(self, cancel: CancelToken) -> TrialRecord:
        """Run it, until the token is cancelled."""
        from blocks_planning.trials.local import run_trial

        return run_trial(self._spec, cancel, self._observe)

    def _observe(self, message: Message) -> None:
        if isinstance(message, SearchAnswer):
            self._states += message.result.planning_cost
        elif isinstance(message, PlaceBlock):
            self._blocks += 1

    def __str__(self) -> str:
        return f'{self._blocks} blocks placed, {self._states:,} states'


def _memory_limit_of(record: TrialRecord) -> str:
    """The message for a trial that ended because a search exceeded its memory, or ''."""
    if not ended_at_a_limit(record):
        return ''
    return f'a region is too large for the memory of {record.spec.search.name}'


def _exit_code(records: list[TrialRecord]) -> int:
    return int(any(record.status is not TrialStatus.SUCCESS for record in records))
