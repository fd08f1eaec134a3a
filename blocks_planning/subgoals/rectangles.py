"""Rectangles as subgoals: the target cells inside a rectangle anywhere on the board.

People who mark the parts of a silhouette mark rectangles far more often than full-width layers
(see docs/people.md). A region of this family contains the target cells inside a rectangle of the
grid; a solve fills them in addition to the built cells.
"""

from __future__ import annotations

from functools import lru_cache
from itertools import product
from typing import NamedTuple, TypeAlias

from blocks_planning.board.geometry import Board, Column, Mask, Row, area
from blocks_planning.board.task import Task

KIND = 'rectangle'
MIN_CELLS = 2
"""Default of the smallest number of target cells in a region [cells]."""

Sides: TypeAlias = tuple[Column, Row, int, int]
"""Column and row of the lower left cell, width and height [cells]."""
RectangleLabel: TypeAlias = tuple[str, Sides]


class _Shape(NamedTuple):
    """A rectangle of a board: its position, its cells, and its four edges."""

    sides: Sides
    cells: Mask
    edges: tuple[Mask, Mask, Mask, Mask]


def rectangles(
    task: Task, built: Mask, min_cells: int = MIN_CELLS, max_cells: int = 0
) -> list[tuple[RectangleLabel, Mask]]:
    """The regions of the family ``rectangles`` in a state, each with its label.

    A rectangle of the grid counts if

    * each of its edge rows and columns has a target cell, so that no two rectangles have the same
      target cells;
    * none of its cells is built;
    * it has ``min_cells`` to ``max_cells`` target cells;
    * one of its target cells rests on the ground or on a built cell. Within a sequence of
      subgoals, ``built`` includes the cells of the earlier ones.

    Args:
        task: the silhouette and its board.
        built: the filled cells when the region is begun.
        min_cells: fewest target cells [cells].
        max_cells: most target cells [cells]; 0: three quarters of the silhouette, rounded down.

    Returns:
        Pairs of ``('rectangle', (column, row, width, height))`` and the target cells inside, by
        rising row, column, height and width. The cells do not include built ones.
    """
    most = max_cells or area(task.silhouette) * 3 // 4
    supported = task.board.ground | built << 1
    return [
        (label, cells)
        for label, inside, cells in _empty_rectangles(task.board, task.silhouette, min_cells, most)
        if not inside & built and cells & supported
    ]


@lru_cache(maxsize=64)
def _empty_rectangles(
    board: Board, silhouette: Mask, least: int, most: int
) -> tuple[tuple[RectangleLabel, Mask, Mask], ...]:
    """Rectangles that meet the conditions without the state: label, cells, target cells."""
    found = []
    for sides, inside, edges in _shapes(board):
        cells = inside & silhouette
        if least <= area(cells) <= most and all(edge & cells for edge in edges):
            found.append(((KIND, sides), inside, cells))
    return tuple(found)


@lru_cache(maxsize=8)
def _shapes(board: Board) -> tuple[_Shape, ...]:
    """Every rectangle of a board; a board of 16 x 16 cells has 18 496 of them."""
    return tuple(
        _shape(board, (column, row, width, height))
        for row, column in product(range(board.height), range(board.width))
        for height in range(1, board.height - row + 1)
        for width in range(1, board.width - column + 1)
    )


def _shape(board: Board, sides: Sides) -> _Shape:
    column, row, width, height = sides
    return _Shape(
        sides,
        board.rectangle(*sides),
        (
            board.rectangle(column, row, width, 1),
            board.rectangle(column, row + height - 1, width, 1),
            board.rectangle(column, row, 1, height),
            board.rectangle(column + width - 1, row, 1, height),
        ),
    )
