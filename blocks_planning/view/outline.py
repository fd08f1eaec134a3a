"""The border of a set of cells."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from blocks_planning.board.geometry import Board, Cell, Mask


def outline(board: Board, mask: Mask) -> Iterator[tuple[tuple[int, int], tuple[int, int]]]:
    """The border of a set of cells, as straight lines from (x, y) to (x, y) [cells]."""

    def differ(one: Cell, other: Cell) -> bool:
        return (one in cells) != (other in cells)

    cells = set(board.cells(mask))
    columns, rows = range(board.width + 1), range(board.height + 1)
    for x in columns:
        for low, high in _runs(differ((x - 1, row), (x, row)) for row in rows):
            yield (x, low), (x, high)
    for y in rows:
        for left, right in _runs(differ((column, y - 1), (column, y)) for column in columns):
            yield (left, y), (right, y)


def _runs(marks: Iterable[bool]) -> Iterator[tuple[int, int]]:
    """The begin and the end of each run of true values."""
    for marked, run in groupby(enumerate(marks), key=lambda item: item[1]):
        if marked:
            indices = [index for index, _ in run]
            yield indices[0], indices[-1] + 1
