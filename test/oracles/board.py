"""What a tower is: a frozenset of filled (column, row) cells, and how blocks fall onto it.

Column 0 is left, row 0 is the ground, rows count upwards. A block is (width, height).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

Cell = tuple[int, int]
Cells = frozenset[Cell]
Block = tuple[int, int]

EMPTY: Cells = frozenset()


class Placement(NamedTuple):
    """A block that has come to rest; column and row name its lower left cell."""

    width: int
    height: int
    column: int
    row: int


def read_picture(text: str) -> tuple[int, int, Cells]:
    """Width, height and cells of a picture: '#' filled, '.' empty, top row first."""
    lines = text.split()
    height = len(lines)
    cells = set()
    for index, line in enumerate(lines):
        if len(line) != len(lines[0]) or set(line) - set('#.'):
            raise ValueError(f'not a row of {len(lines[0])} cells: {line!r}')
        for column, character in enumerate(line):
            if character == '#':
                cells.add((column, height - 1 - index))
    return len(lines[0]), height, frozenset(cells)


def cells_of(placement: Placement) -> Cells:
    """The cells a placed block covers."""
    columns = range(placement.column, placement.column + placement.width)
    rows = range(placement.row, placement.row + placement.height)
    return frozenset((column, row) for column in columns for row in rows)


def drop(state: Cells, block: Block, column: int) -> Placement:
    """Where a block comes to rest: on the highest filled cell under it, or on the ground.

    It may rest above the top of the board: see `possible_placements`.
    """
    width, height = block
    tops = [r + 1 for c, r in state if column <= c < column + width]
    return Placement(width, height, column, max(tops, default=0))


def is_possible(width: int, height: int, placement: Placement) -> bool:
    """Whether a block at rest lies inside a board of `width` x `height` cells."""
    return (
        placement.column >= 0
        and placement.column + placement.width <= width
        and placement.row + placement.height <= height
    )


def possible_placements(
    width: int, height: int, library: Sequence[Block], state: Cells
) -> list[Placement]:
    """All placements that come to rest inside the board.

    In generation order: block by block in library order, each from the leftmost column to the
    right. All other functions keep this order.
    """
    placements = []
    for block in library:
        for column in range(width):
            placement = drop(state, block, column)
            if is_possible(width, height, placement):
                placements.append(placement)
    return placements


def legal_placements(
    width: int, height: int, library: Sequence[Block], region: Cells, state: Cells
) -> list[Placement]:
    """The possible placements that cover cells of `region` only, in generation order."""
    possible = possible_placements(width, height, library, state)
    return [placement for placement in possible if cells_of(placement) <= region]


def place(state: Cells, placements: Sequence[Placement]) -> Cells:
    """The state after some placements."""
    for placement in placements:
        state = state | cells_of(placement)
    return state


def is_dead(region: Cells, state: Cells) -> bool:
    """Whether a cell of `region` lies empty under a filled cell of its column."""
    return any(c == column and r > row for column, row in region - state for c, r in state)


def rows(silhouette: Cells, k: int) -> Cells:
    """The region made of the lowest k rows of a silhouette."""
    return frozenset((column, row) for column, row in silhouette if row < k)
