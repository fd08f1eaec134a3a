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
@json_option
def solve(addresses: tuple[str, ...], seeds: int, as_json: bool, **options: Any) -> int:
    """Run trials and print a table, or a record per line.

    The exit code is 1 if a tower was not rebuilt perfectly.
    """
    specs = specs_of(addresses, seeds, options)
    records = []
    for record in _with_progress(_run_all(specs), len(specs)):
        records.append(record)
        if as_json:
            click.echo(record.to_line())
    if not as_json:
        from blocks_planning.view.tables import print_summary

        print_summary(records)
    return _exit_code(records)


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


def _run_all(specs: list[TrialSpec]) -> Iterator[TrialRecord]:
    """Run trials in order; an interrupted one is handed out too, as cancelled."""
    from blocks_planning.trials.local import run_trial

    for spec in specs:
        record, interrupted = interruptible(partial(run_trial, spec))
        yield record
        if interrupted:
            raise KeyboardInterrupt


def _with_progress(records: Iterator[TrialRecord], total: int) -> Iterator[TrialRecord]:
    """Show on stderr how far it is, if somebody looks there."""
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True)
    hidden = total == 1 or not console.is_terminal
    return track(records, 'Trials', total=total, console=console, transient=True, disable=hidden)  # type: ignore[return-value]


def _exit_code(records: list[TrialRecord]) -> int:
    return int(any(record.status is not TrialStatus.SUCCESS for record in records))
