"""The command that fits models of choice to records."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from blocks_planning.cli.progress import bar
from blocks_planning.cli.sweeping import out_option
from blocks_planning.errors import InvalidInput

if TYPE_CHECKING:
    from blocks_planning.fitting.choiceset import ChoiceSet
    from blocks_planning.fitting.models import Model
    from blocks_planning.fitting.points import ChoicePoint

DEFAULT_MODELS = (
    *('rows', 'rows-2', 'rows-3', 'rows-no-cost', 'rows-no-progress'),
    *('rectangles', 'rectangles-no-cost', 'rectangles-no-progress'),
    'random',
)


@click.command(
    epilog='\b\nExamples:\n  blocks-planning fit records.jsonl --out fitted\n'
    '  blocks-planning fit P01.jsonl P02.jsonl --model rows --model rectangles --out fitted'
)
@click.argument('records', nargs=-1, required=True, type=click.Path(path_type=Path))
@out_option
@click.option(
    '--model',
    'names',
    multiple=True,
    metavar='NAME',
    default=DEFAULT_MODELS,
    help='Model: a region family (rows, rectangles), optionally followed by -2 or -3 (subgoals '
    'to look ahead), then by -no-cost or -no-progress; or random. May be given several times.  '
    '[default: all of these, without rectangles further ahead]',
)
@click.option(
    '--intervals/--no-intervals', default=True, help='Compute profile-likelihood intervals.'
)
def fit(records: tuple[Path, ...], out: Path, names: tuple[str, ...], intervals: bool) -> None:
    """Fit models of choice to the chosen regions of records.

    The choices are those of people or planners. The command fits each session of the RECORDS (a
    participant, or the seed of a planner) separately, and all sessions together. It writes
    fits.csv, parameters.csv, choices.csv and figures/fit.svg and .png.
    """
    from blocks_planning.analysis.fitted import fit_figure
    from blocks_planning.analysis.style import save_figure
    from blocks_planning.fitting.comparison import Makers, compare_models
    from blocks_planning.fitting.models import parse_model
    from blocks_planning.fitting.tables import choice_rows, write_table

    models = [parse_model(name) for name in dict.fromkeys(names)]
    points = _read_points(records)
    with bar('Choices') as report:
        sets = Makers().choice_sets(points, models, report)
    with bar('Fits') as report:
        fits, parameters = compare_models(sets, models, intervals, report)
    tables = {'fits': fits, 'parameters': parameters, 'choices': choice_rows(points)}
    for name, rows in tables.items():
        write_table(out, name, rows)
    save_figure(fit_figure(fits, parameters), out / 'figures', 'fit')
    _say(points, models, fits, sets)
    click.echo(f'{out}: fits.csv, parameters.csv, choices.csv and figures/fit.svg written')


def _read_points(paths: tuple[Path, ...]) -> list[ChoicePoint]:
    from blocks_planning.fitting.points import points_of
    from blocks_planning.trials.reading import read_records

    points = points_of(record for path in paths for record in read_records(path))
    if not points:
        listed = ', '.join(map(str, paths))
        raise InvalidInput(
            f'{listed}: no region was chosen in any trial; expected records of strategy human, or '
            'of a planner that chooses regions'
        )
    return points


def _say(
    points: list[ChoicePoint],
    models: list[Model],
    fits: list[dict[str, object]],
    sets: dict[str, ChoiceSet],
) -> None:
    """Print how many choices are not options of a model, and the best model of each session."""
    for model in models:
        choices = sets[model.name]
        if model.regions and choices.foreign + choices.unbuildable:
            click.echo(
                f'{model.name}: of {len(points)} choices {choices.foreign} are not regions of the family, '
                f'{choices.unbuildable} cannot be built; they count as lapses'
            )
    for row in fits:
        if row['delta_bic'] == 0:
            click.echo(
                f'{row["session"]}: {row["model"]} fits best of {len(models)} models (BIC '
                f'{row["bic"]:.1f}, {row["choices"]} choices)'
            )
