"""Grids of values: their filled cells, and their orientation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from blocks_planning.board.importing.cells import Cells
from blocks_planning.errors import StimulusError, shown

LISTS = ('rows', 'columns')
UPWARDS = ('up', 'down')
MAX_GRID_SIDE = 1024
"""Longest side of a grid before its empty margins are removed [cells]."""

_FILLED_WORDS = frozenset({'1', '#', 'x', 'true', 't', 'yes'})
_EMPTY_WORDS = frozenset({'0', '.', '', 'false', 'f', 'no', '-', '_'})


@dataclass(frozen=True)
class Layout:
    """The orientation of a grid.

    Attributes:
        lists: what the inner lists are: 'rows' (``grid[y][x]``) or 'columns' (``grid[x][y]``).
        y: whether y counts 'up' from the ground, or 'down' from the top.
        inverted: whether true, 1 and '#' stand for an empty cell.
    """

    lists: str = 'rows'
    y: str = 'down'
    inverted: bool = False

    def __str__(self) -> str:
        shape = 'grid[y][x]' if self.lists == 'rows' else 'grid[x][y]'
        return f'{shape}, y {self.y}, {"true is empty" if self.inverted else "true is filled"}'


BOOLEAN_MAP = Layout('columns', 'up', inverted=True)
"""Maps of free space: ``map[x][y]`` is true if the cell is empty, with y upwards."""


def is_grid(value: Any) -> bool:
    """Whether a value looks like a list of lists of single values."""
    return (
        isinstance(value, list)
        and bool(value)
        and all(isinstance(line, (list, str)) for line in value)
        and not any(isinstance(item, (list, dict)) for line in value for item in line)
    )


def is_boolean(grid: Any) -> bool:
    """Whether every value of a grid is true or false."""
    return all(isinstance(item, bool) for line in grid for item in line)


@dataclass(frozen=True)
class Place:
    """Where a grid comes from, for messages; ``line`` is its first one in a file of lines."""

    origin: str
    line: int | None = None

    def __str__(self) -> str:
        return self.origin if self.line is None else f'{self.origin}, line {self.line}'

    def of(self, outer: int, inner: int | None = None) -> str:
        """The place of a list, or of a value in it."""
        if self.line is None:
            return f'{self.origin}[{outer}]' + ('' if inner is None else f'[{inner}]')
        line = f'{self.origin}, line {self.line + outer}'
        return line if inner is None else f'{line}, value {inner + 1}'


def cells_of_grid(grid: Any, layout: Layout, place: Place) -> tuple[Cells, tuple[int, int]]:
    """The filled cells of a grid, and its width and height.

    Args:
        grid: lists of equal length, or texts, of booleans, whole numbers (0 is empty) or signs
            such as '#' and '.'.
        layout: its orientation.
        place: where it comes from, for messages.

    Raises:
        StimulusError: naming the place of the value, and the value, for lines of different length,
            a value that is neither filled nor empty, or a side over ``MAX_GRID_SIDE``.
    """
    length = len(grid[0])
    if not 1 <= length <= MAX_GRID_SIDE or len(grid) > MAX_GRID_SIDE:
        raise StimulusError(
            f'{place}: a grid has 1 to {MAX_GRID_SIDE} lists of 1 to {MAX_GRID_SIDE} values, got '
            f'{len(grid)} of {length}'
        )
    cells = set()
    for outer, line in enumerate(grid):
        if len(line) != length:
            raise StimulusError(
                f'{place.of(outer)}: expected {length} values as in the first list, got {len(line)}'
            )
        for inner, value in enumerate(line):
            if _is_filled(value, place.of(outer, inner)) != layout.inverted:
                cells.add((inner, outer) if layout.lists == 'rows' else (outer, inner))
    size = (length, len(grid)) if layout.lists == 'rows' else (len(grid), length)
    if layout.y == 'down':
        cells = {(x, size[1] - 1 - y) for x, y in cells}
    return frozenset(cells), size


def _is_filled(value: Any, place: str) -> bool:
    if isinstance(value, (bool, int)):
        return bool(value)
    if isinstance(value, float) and value.is_integer():
        return bool(value)
    if isinstance(value, str):
        word = value.strip().lower()
        if word in _FILLED_WORDS or (word.isdecimal() and int(word) > 0):
            return True
        if word in _EMPTY_WORDS or (word.isdecimal() and int(word) == 0):
            return False
    raise StimulusError(
        f'{place}: expected true or false, a whole number, or a sign such as # or ., '
        f'got {shown(value)}'
    )
