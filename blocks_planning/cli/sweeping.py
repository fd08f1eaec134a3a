"""The command that runs sweeps."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from blocks_planning.cli.progress import bar

if TYPE_CHECKING:
    from blocks_planning.experiments.sweeping import Summary

_PATH = click.Path(path_type=Path, exists=False)
_SHOWN_FAILURES = 5

out_option = click.option(
    '--out', required=True, type=_PATH, help='Folder that results are written to.'
)
workers_option = click.option(
    '--workers',
    type=click.IntRange(1),
    help='Number of processes on this machine.  [default: one per processor]',
)


@click.command(
    epilog='\b\nExamples:\n  blocks-planning sweep paper --out results\n'
    '  blocks-planning sweep my/sweep.yaml --out results --dask tcp://192.168.0.1:8786'
)
@click.argument('spec', metavar='SPEC.yaml')
@out_option
@workers_option
@click.option('--dask', metavar='ADDRESS', help='Use the workers of this Dask scheduler instead.')
def sweep(spec: str, out: Path, workers: int | None, dask: str | None) -> int:
    """Run all trials of a specification and write tables.

    The tables are Parquet files. After an interruption, the same command continues. The exit code
    is 1 if a trial could not be run; its row in the table of trials has the reason.
    """
    from blocks_planning.experiments.reading import find_sweep, read_sweep
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.experiments.sweeping import run_sweep

    wanted = read_sweep(find_sweep(spec))
    with bar('Trials') as report:
        summary = run_sweep(wanted, out, workers or default_workers(), dask, report)
    print_summary(summary, out)
    return int(summary.failed > 0)


def print_summary(summary: Summary, out: Path) -> None:
    """Print the results of a sweep to stdout, and its failures to stderr."""
    listed = ', '.join(f'{count} {status}' for status, count in sorted(summary.statuses.items()))
    click.echo(f'{out}: {summary.trials} trials: {listed}')
    for error, count in list(summary.failures.items())[:_SHOWN_FAILURES]:
        click.echo(f'failed, {count} trials: {error}', err=True)
    if len(summary.failures) > _SHOWN_FAILURES:
        click.echo(f'... and {len(summary.failures) - _SHOWN_FAILURES} more reasons', err=True)
