"""Silhouettes from a file in any known form, with their names.

A JSON file is a block list (:mod:`.blocklists`), a grid (:mod:`.grids`), a list of them, or an
object that has them by name. A grid of booleans is read as a map of free space. A CSV file
has one or more grids, separated by blank lines. Text pictures (:mod:`..pictures`) are read too.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.importing.blocklists import cells_of_blocks, is_block_list
from blocks_planning.board.importing.cells import on_board
from blocks_planning.board.importing.documents import parse_json, parse_tables, suffix_of
from blocks_planning.board.importing.grids import (
    BOOLEAN_MAP,
    Layout,
    Place,
    cells_of_grid,
    is_boolean,
    is_grid,
)
from blocks_planning.board.names import suggested
from blocks_planning.board.pictures import parse_silhouettes, read_text
from blocks_planning.errors import StimulusError, shown

SUFFIXES = ('.json', '.csv', '.tsv', '.txt')
MAX_TOWERS = 10_000
_MAX_LEVELS = 4


@dataclass(frozen=True)
class Reading:
    """How files are read; None is the default of the form.

    Attributes:
        lists: what the inner lists of a grid are, 'rows' or 'columns'.
        y: whether y counts 'up' from the ground or 'down' from the top.
        inverted: whether true, 1 and '#' stand for an empty cell.
        trim: whether empty margins are removed.
    """

    lists: str | None = None
    y: str | None = None
    inverted: bool | None = None
    trim: bool = True

    def layout(self, usual: Layout) -> Layout:
        """The layout of a grid, given the default of its form."""
        given = {
            key: value
            for key in ('lists', 'y', 'inverted')
            if (value := getattr(self, key)) is not None
        }
        return replace(usual, **given)


class Imported(NamedTuple):
    """A silhouette from a file.

    Attributes:
        name: from the file, adapted to the rules of :mod:`..names`, or from the name of the file.
        board: its size.
        silhouette: its target cells.
        form: the form in which it was read, for display.
    """

    name: str
    board: Board
    silhouette: Mask
    form: str


def import_file(path: Path, reading: Reading | None = None) -> list[Imported]:
    """The silhouettes of a file, in its order.

    Raises:
        StimulusError: naming file, key or line, and value, if the file can't be read, has an
            unknown suffix, or contains no silhouettes.
    """
    return import_text(read_text(path), path, reading or Reading())


def import_text(text: str, path: Path, reading: Reading) -> list[Imported]:
    """The silhouettes of the text of a file; see :func:`import_file`."""
    suffix = suffix_of(path)
    if suffix not in SUFFIXES:
        raise StimulusError(
            f'{path}: the name must end in one of {", ".join(SUFFIXES)}, got {suffix or "none"}'
        )
    if suffix == '.json':
        found = list(_from_json(parse_json(text, str(path)), path.stem, str(path), reading, 0))
    elif suffix == '.txt':
        pictures = parse_silhouettes(text, str(path))
        found = [Imported(name, *picture, 'text') for name, picture in pictures.items()]
    else:
        found = list(_from_tables(text, path, reading))
    if len(found) > MAX_TOWERS:
        raise StimulusError(f'{path}: has more than {MAX_TOWERS} silhouettes')
    return found


def _from_json(
    value: Any, name: str, place: str, reading: Reading, level: int
) -> Iterator[Imported]:
    """The silhouettes of a value and of the values in it."""
    if is_block_list(value):
        given = value.get('name')
        yield _of_blocks(value, given if isinstance(given, str) else name, place, reading)
    elif is_grid(value):
        layout = reading.layout(BOOLEAN_MAP if is_boolean(value) else Layout())
        yield _of_grid(value, name, Place(place), layout, reading)
    elif isinstance(value, (dict, list)) and value and level < _MAX_LEVELS:
        items = value.items() if isinstance(value, dict) else enumerate(value, start=1)
        for key, item in items:
            own = key if isinstance(key, str) else f'{name}-{key}'
            yield from _from_json(item, own, place + _step(key), reading, level + 1)
    else:
        raise StimulusError(
            f'{place}: expected a grid (a list of lists) or an object with the key blocks, '
            f'got {shown(value)}'
        )


def _step(key: str | int) -> str:
    """The suffix of a place for a key of an object, or for a number from 1 of a list."""
    if isinstance(key, int):
        return f'[{key - 1}]'
    return f'.{key}' if key.isidentifier() else f'[{shown(key)}]'


def _from_tables(text: str, path: Path, reading: Reading) -> Iterator[Imported]:
    tables = parse_tables(text, str(path))
    layout = reading.layout(Layout())
    for number, (line, grid) in enumerate(tables, start=1):
        name = path.stem if len(tables) == 1 else f'{path.stem}-{number}'
        yield _of_grid(grid, name, Place(str(path), line), layout, reading)


def _of_blocks(value: dict[str, Any], name: str, place: str, reading: Reading) -> Imported:
    y = reading.y or 'up'
    cells = cells_of_blocks(value, y, place)
    if not reading.trim:
        if any(min(cell) < 0 for cell in cells):
            raise StimulusError(f'{place}: a block lies below or left of 0; trim the margins')
        extent = (max(x for x, _ in cells) + 1, max(row for _, row in cells) + 1)
        return Imported(_named(name), *on_board(cells, place, extent), f'blocks, y {y}')
    return Imported(_named(name), *on_board(cells, place), f'blocks, y {y}')


def _of_grid(
    grid: list[Any], name: str, place: Place, layout: Layout, reading: Reading
) -> Imported:
    cells, size = cells_of_grid(grid, layout, place)
    board, mask = on_board(cells, str(place), None if reading.trim else size)
    return Imported(_named(name), board, mask, str(layout))


def _named(name: str) -> str:
    return suggested(name) or 'tower'


def with_different_names(towers: list[Imported]) -> list[Imported]:
    """The towers, with a number after every repeated name."""
    taken: set[str] = set()
    named = []
    for tower in towers:
        name, number = tower.name, 1
        while name in taken:
            number += 1
            name = f'{tower.name}-{number}'
        taken.add(name)
        named.append(tower._replace(name=name))
    return named
