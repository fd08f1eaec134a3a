"""The command that runs the study of robots that err."""

from __future__ import annotations

from pathlib import Path

import click

from blocks_planning.cli.progress import bar
from blocks_planning.cli.sweeping import out_option, workers_option

_QUICK = 'This is a quick run with one tower and two robots. It only shows that everything works.'


@click.command(epilog='\b\nExample:\n  blocks-planning robot-study --out robot-study')
@out_option
@click.option('--quick', is_flag=True, help='Build one tower with two robots; takes seconds.')
@click.option(
    '--seeds', type=click.IntRange(1), default=1, show_default=True, help='Seeds of each trial.'
)
@workers_option
def robot_study(out: Path, quick: bool, seeds: int, workers: int | None) -> int:
    """Measure planners with simulated robots that err more or less.

    The command writes report.html and results.json, and needs the extra robot. After an
    interruption, the same command continues. The exit code is 1 if a record is inconsistent.
    """
    from dataclasses import replace

    from blocks_planning.analysis.embodied_report import write_embodied
    from blocks_planning.experiments.running import default_workers
    from blocks_planning.robot.study import QUICK, Study, run_study

    study = replace(QUICK if quick else Study(), seeds=tuple(range(seeds)))
    with bar('Trials') as report:
        rows = run_study(study, out, workers or default_workers(), report)
    results = write_embodied(rows, out, [_QUICK] if quick else [])
    for sentence in results['answers']:
        click.echo(sentence)
    click.echo(f'{out / "report.html"}: written')
    return int(results['contradictions'] > 0)
