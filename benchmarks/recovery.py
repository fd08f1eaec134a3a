"""Which parameters and models of choice are found again from simulated sessions of 16 towers.

python -m benchmarks.recovery --out recovery
python -m benchmarks.recovery --together 4 --out recovery4    # sets of 4 participants
"""

from __future__ import annotations

import json
from functools import partial
from itertools import chain
from pathlib import Path

import click

from blocks_planning.analysis.recovered import recovery_figure
from blocks_planning.analysis.style import save_figure
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.cli.progress import bar
from blocks_planning.fitting.comparison import Makers
from blocks_planning.fitting.models import parse_model
from blocks_planning.fitting.points import Asking, ChoicePoint
from blocks_planning.fitting.recovery import (
    Session,
    median_errors,
    recover_models,
    recover_parameters,
    win_rates,
)
from blocks_planning.fitting.simulation import Chooser, roll_out
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.search.searches import BreadthFirst

SET = 'cogsci2021'
ESTIMATED = ('rows', 'rows-2', 'rectangles')
MODELS = (
    *('rows', 'rows-2', 'rows-3', 'rows-no-cost', 'rows-no-progress'),
    *('rectangles', 'rectangles-no-cost', 'random'),
)
"""Without rectangles-no-progress, which takes the towers apart into pairs of cells: each session
has hundreds of choices, and 40 sets take an hour."""


def sessions_of(number: int, together: int = 1) -> list[Session]:
    """Sets of sessions in which a simulated participant rebuilds the paper's 16 towers.

    Args:
        number: of sets.
        together: sessions of a set, all with the parameters of the set.
    """
    towers = {one.name: Task(one.board, one.silhouette) for one in find_stimuli(SET)}
    asking = Asking(BreadthFirst(3), 0, DEFAULT_BUDGET)

    def take_part(name: int, chooser: Chooser) -> list[ChoicePoint]:
        runs = (roll_out(f'{name}.{part}', towers, asking, chooser) for part in range(together))
        return list(chain.from_iterable(runs))

    return [partial(take_part, name) for name in range(number)]


@click.command()
@click.option('--out', type=click.Path(path_type=Path), required=True, help='Folder to write in.')
@click.option('--sets', default=40, show_default=True, type=click.IntRange(1))
@click.option('--together', default=1, show_default=True, type=click.IntRange(1))
@click.option('--seed', default=1, show_default=True)
def main(out: Path, sets: int, together: int, seed: int) -> None:
    """Write recovery.json and figures/recovery.svg and .png, and print the numbers."""
    sessions, makers = sessions_of(sets, together), Makers()
    found = {}
    for name in ESTIMATED:
        with bar(f'Parameters of {name}') as report:
            found[name] = recover_parameters(sessions, parse_model(name), makers, seed, report)
        errors = median_errors(found[name])
        click.echo(f'{name}: ' + ', '.join(f'{key} {value:.3f}' for key, value in errors.items()))
    with bar('Models') as report:
        models = recover_models(sessions, list(map(parse_model, MODELS)), makers, seed, report)
    rates = win_rates(models)
    for name, shares in rates.items():
        best = ', '.join(f'{other} {share:.0%}' for other, share in shares.items() if share)
        click.echo(f'{name}: {best}')
    save_figure(recovery_figure(found, rates), out / 'figures', 'recovery')
    text = json.dumps({'parameters': found, 'models': models}, indent=1)
    (out / 'recovery.json').write_text(text + '\n', encoding='utf-8')


if __name__ == '__main__':
    main()
