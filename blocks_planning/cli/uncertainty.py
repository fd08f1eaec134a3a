"""The command that runs the experiment in uncertain worlds."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from blocks_planning.cli.progress import bar
from blocks_planning.cli.sweeping import out_option, print_summary, workers_option

_QUICK = 'This is a quick run with few seeds and worlds. It only shows that everything works.'


@click.command(epilog='\b\nExample:\n  blocks-planning uncertain --out uncertain')
@out_option
@click.option('--quick', is_flag=True, help='Use few seeds and worlds; takes seconds.')
@click.option(
    '--first-seed',
    type=click.IntRange(0, 2**63),
    default=0,
    show_default=True,
    help='First seed; another one gives another sample.',
)
@workers_option
def uncertain(out: Path, quick: bool, first_seed: int, workers: int | None) -> int:
    """Measure planners in worlds where blocks slip or fall.

    The command writes report.html and results.json, with the best possible policy for comparison.
    After an interruption, the same command continues. The exit code is 1 if a trial could not be
    run.
    """
    from blocks_planning.analysis.uncertainty_report import write_uncertainty
    from blocks_planning.experiments.optima import optimum_table
    from blocks_planning.experiments.reading import find_sweep, read_sweep
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.experiments.sweeping import run_sweep

    suffix = '_quick' if quick else ''
    worlds, loose = (
        replace(found, seeds=tuple(seed + first_seed for seed in found.seeds))
        for found in (read_sweep(find_sweep(name + suffix)) for name in ('uncertain', 'stable'))
    )
    workers = workers or default_workers()
    with bar('Trials') as report:
        summary = run_sweep(worlds, out / 'sweep', workers, report=report)
    with bar('Trials with searches that know that towers fall') as report:
        of_loose = run_sweep(loose, out / 'stable', workers, report=report)
    optima = optimum_table(worlds, out, workers)
    notes = [_QUICK] if quick else []
    results = write_uncertainty(out / 'sweep', out / 'stable', out, optima, notes)
    print_summary(summary, out / 'sweep')
    print_summary(of_loose, out / 'stable')
    for sentence in results['answers']:
        click.echo(sentence)
    click.echo(f'{out / "report.html"}: written')
    return int(summary.failed + of_loose.failed > 0)
