"""Measures of the shape of a silhouette.

Holes and overhangs make a tower hard to plan: a block over them must be placed before anything can
rest on it, and the cells under it can't be filled any more.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.geometry import Board, Cell, Mask, area


class Shape(NamedTuple):
    """Measures of a silhouette.

    Attributes:
        cells: number of target cells.
        width: columns from the first to the last that has a target cell [cells].
        height: rows from the ground to the highest target cell [cells].
        holes: number of connected groups of empty cells that are enclosed by target cells, with the
            ground and the sides of the board as walls; cells are connected by their edges.
        hole_cells: number of empty cells in holes.
        overhangs: number of horizontal runs of target cells, each with an empty cell directly
            below.
        covered_cells: number of empty cells somewhere below a target cell.
        roughness: sum of the steps between the tops of neighbouring columns [cells].
    """

    cells: int
    width: int
    height: int
    holes: int
    hole_cells: int
    overhangs: int
    covered_cells: int
    roughness: int


def shape_of(board: Board, silhouette: Mask) -> Shape:
    """The measures of a silhouette."""
    tops = _tops(board, silhouette)
    columns = [column for column, top in enumerate(tops) if top]
    holes = _holes(board, silhouette)
    return Shape(
        cells=area(silhouette),
        width=columns[-1] - columns[0] + 1 if columns else 0,
        height=max(tops),
        holes=len(holes),
        hole_cells=sum(map(area, holes)),
        overhangs=_overhangs(board, silhouette),
        covered_cells=area(rules.shadow(board, silhouette) & ~silhouette),
        roughness=sum(abs(a - b) for a, b in pairwise(tops)),
    )


def _tops(board: Board, silhouette: Mask) -> list[int]:
    column_mask = (1 << board.height) - 1
    return [
        (silhouette >> board.bit(column, 0) & column_mask).bit_length()
        for column in range(board.width)
    ]


def _holes(board: Board, silhouette: Mask) -> list[Mask]:
    """The holes: groups of empty cells with no way to the sky above the board."""
    left = board.full & ~silhouette
    groups = []
    while left:
        group = _spread(board, left & -left, left)
        left &= ~group
        groups.append(group)
    sky = sum(1 << board.bit(column, board.height - 1) for column in range(board.width))
    return [group for group in groups if not group & sky]


def _spread(board: Board, start: Mask, inside: Mask) -> Mask:
    """All cells of ``inside`` that are connected with those of ``start``."""
    bottom, top = board.ground, board.ground << (board.height - 1)
    reached = start
    while True:
        around = (reached & ~top) << 1 | (reached & ~bottom) >> 1
        around |= reached << board.height | reached >> board.height
        more = (reached | around) & inside
        if more == reached:
            return reached
        reached = more


def _overhangs(board: Board, silhouette: Mask) -> int:
    unsupported: list[Cell] = [
        (column, row)
        for column, row in board.cells(silhouette)
        if row and not silhouette >> board.bit(column, row - 1) & 1
    ]
    hanging = set(unsupported)
    return sum((column - 1, row) not in hanging for column, row in unsupported)
