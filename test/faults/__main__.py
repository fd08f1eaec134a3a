"""Run a plan of faults, and say what came of it; the exit code is 1 if anything was lost."""

from __future__ import annotations

import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

import click


@click.command()
@click.option('--kills', default=200, show_default=True, type=click.IntRange(1))
@click.option('--trials', default=60, show_default=True, type=click.IntRange(1), help='At least.')
@click.option(
    '--participants',
    default=5,
    show_default=True,
    type=click.IntRange(0),
    help='Participants of a study, who meet a fault at every second act.',
)
@click.option('--seed', default=0, show_default=True)
@click.option('--pace', default=0.05, show_default=True, help='How long a placement takes [s].')
@click.option('--out', type=click.Path(path_type=Path), help='Folder to keep everything in.')
@click.option(
    '--json', 'json_path', type=click.Path(path_type=Path), help='Write the report there.'
)
def main(
    kills: int,
    trials: int,
    participants: int,
    seed: int,
    pace: float,
    out: Path | None,
    json_path: Path | None,
) -> None:
    """Kill, stop and double nodes while trials run through the graph, and a study while it runs."""
    from faults.harness import Harness
    from faults.study import make_plans, run_study

    def say(text: str) -> None:
        click.echo(text, err=True)

    folder = out or Path(tempfile.mkdtemp(prefix='faults-'))
    lost: list[str] = []
    if participants:
        (folder / 'study').mkdir(parents=True)
        lost = run_study(folder.resolve() / 'study', make_plans(seed, participants), say)
    harness = Harness(folder.resolve(), seed, kills, trials, pace)
    try:
        report = harness.run(say=say)
    finally:
        harness.close()
    report.complaints += lost
    click.echo('\n'.join(report.lines()))
    if json_path is not None:
        json_path.write_text(json.dumps(report.to_json(), indent=1) + '\n', encoding='utf-8')
    if out is None and report.is_good:
        shutil.rmtree(folder)
    elif not report.is_good:
        click.echo(f'Everything is in {folder}')
    sys.stdout.flush()
    os._exit(0 if report.is_good else 1)  # rclpy is up


main()
