"""Run the speed programs, print a table, and write the same as JSON."""

from __future__ import annotations

import importlib
import json
import os
import platform
import sys
from pathlib import Path

import click

from benchmarks.measure import Figure

PROGRAMS = ('search', 'many', 'paper_table1', 'trials', 'start', 'graph', 'page')


@click.command()
@click.argument('programs', nargs=-1, type=click.Choice(PROGRAMS))
@click.option('--quick', is_flag=True, help='Smaller samples, for a look.')
@click.option('--out', default='benchmarks/results.json', type=click.Path(path_type=Path))
def main(programs: tuple[str, ...], quick: bool, out: Path) -> None:
    """Measure speed; by default everything."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / 'test'))  # the slow twins
    figures: list[Figure] = []
    for program in programs or PROGRAMS:
        print(f'\n{program}')
        for figure in importlib.import_module(f'benchmarks.{program}').run(quick):
            figures.append(figure)
            print(f'  {figure}', flush=True)
    machine = {
        'python': platform.python_version(),
        'machine': platform.machine(),
        'cores': os.cpu_count(),
    }
    results = {
        'machine': machine,
        'quick': quick,
        'figures': [figure._asdict() for figure in figures],
    }
    out.write_text(json.dumps(results, indent=1) + '\n', encoding='utf-8')
    print(f'\nwritten to {out}')


main()
