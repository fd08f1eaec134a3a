"""The command that converts files of other programs to text pictures."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import click

from blocks_planning.board.geometry import area
from blocks_planning.board.importing.grids import LISTS, UPWARDS
from blocks_planning.board.importing.towers import (
    Imported,
    Reading,
    import_file,
    with_different_names,
)
from blocks_planning.board.pictures import format_silhouette
from blocks_planning.errors import ConfigurationError, shown

_PATH = click.Path(path_type=Path, exists=False)
_EXAMPLES = """\b
Examples:
  blocks-planning stimuli import towers.json
  blocks-planning stimuli import a.json b.csv --out towers.txt
  blocks-planning stimuli import maps.json --lists rows --y down --true filled --out towers.txt
"""


@click.command('import', epilog=_EXAMPLES)
@click.argument('paths', metavar='FILE...', type=_PATH, nargs=-1, required=True)
@click.option(
    '--out', type=_PATH, help='The .txt file to write; without it the towers are only shown.'
)
@click.option('--replace', is_flag=True, help='Overwrite the file if it exists.')
@click.option(
    '--lists',
    type=click.Choice(LISTS),
    help='Whether the inner lists of a grid are rows or columns.',
)
@click.option(
    '--y',
    'upwards',
    type=click.Choice(UPWARDS),
    help='Whether y, or the order of rows, counts up from the ground or down from the top.',
)
@click.option(
    '--true',
    'meaning',
    type=click.Choice(['filled', 'empty']),
    help="Meaning of true, 1 and '#' in a grid.",
)
@click.option('--trim/--no-trim', default=True, show_default=True, help='Remove empty margins.')
def import_towers(
    paths: tuple[Path, ...],
    out: Path | None,
    replace: bool,
    lists: str | None,
    upwards: str | None,
    meaning: str | None,
    trim: bool,
) -> None:
    """Convert towers from JSON, CSV or text to text pictures.

    A JSON file contains block lists, {"blocks": [{"x": 0, "y": 0, "width": 2, "height": 1}]} with y
    upwards, or grids, [[0, 1], [1, 1]] with the top row first, or lists or objects of them. A grid
    of booleans is a map: map[x][y] is true where the cell is empty, with y upwards. A CSV file
    contains grids, with blank lines between them. The command shows every tower as it read it: if a
    tower is on its side or upside down, set --lists or --y.
    """
    inverted = None if meaning is None else meaning == 'empty'
    reading = Reading(lists, upwards, inverted, trim)
    read = [(path, tower) for path in paths for tower in import_file(path, reading)]
    towers = with_different_names([tower for _, tower in read])
    for (path, _), tower in zip(read, towers, strict=True):
        click.echo(_preview(path, tower))
    if out is None:
        click.echo(f'{len(towers)} towers read; nothing is written without --out FILE')
        return
    _write(out, replace, towers, [path for path, _ in read])
    click.echo(f'{out}: {len(towers)} towers written')


def _preview(path: Path, tower: Imported) -> str:
    """A tower with the ground below it."""
    board = tower.board
    head = (
        f'# tower {tower.name}, from {path} ({tower.form}): {board.width} x {board.height} cells, '
        f'{area(tower.silhouette)} filled'
    )
    picture = board.draw(tower.silhouette)
    return f'{head}\n{picture}\n{"=" * board.width} ground\n'


def _write(out: Path, replace: bool, towers: Sequence[Imported], paths: Sequence[Path]) -> None:
    parts = (
        format_silhouette(
            tower.name, tower.board, tower.silhouette, [f'from {shown(path.name)} ({tower.form})']
        )
        for tower, path in zip(towers, paths, strict=True)
    )
    write_towers(out, replace, '\n'.join(parts))


def write_towers(out: Path, replace: bool, text: str) -> None:
    """Write a file of text pictures.

    Raises:
        ConfigurationError: if it cannot be written, or exists and may not be replaced.
    """
    try:
        with out.open('w' if replace else 'x', encoding='utf-8') as file:
            file.write(text)
    except FileExistsError:
        raise ConfigurationError(
            f'--out {out}: the file exists; add --replace to overwrite it'
        ) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, 'strerror', None) or error
        raise ConfigurationError(f'--out {out}: cannot be written: {reason}') from None
