"""Cells of a plane, and their conversion to a board."""

from __future__ import annotations

from typing import TypeAlias

from blocks_planning.board.geometry import MAX_SIDE, Board, Mask
from blocks_planning.errors import StimulusError

Cells: TypeAlias = frozenset[tuple[int, int]]
"""(x, y) with y upwards; the numbers may be negative or large."""


def on_board(
    cells: Cells, place: str, extent: tuple[int, int] | None = None
) -> tuple[Board, Mask]:
    """The board and mask of some cells.

    Args:
        cells: at least one.
        place: where they come from, for messages.
        extent: width and height of the board, whose lower left cell is (0, 0); by default the
            smallest that contains all cells.

    Raises:
        StimulusError: if there is no cell, the board has a side over 16, or a cell is off it.
    """
    if not cells:
        raise StimulusError(f'{place}: has no target cell')
    left = min(x for x, _ in cells)
    bottom = min(y for _, y in cells)
    width = max(x for x, _ in cells) - left + 1
    height = max(y for _, y in cells) - bottom + 1
    if extent is not None:
        left, bottom, (width, height) = 0, 0, extent
    if max(width, height) > MAX_SIDE:
        margins = 'with' if extent else 'without'
        raise StimulusError(
            f'{place}: the sides of a silhouette are at most {MAX_SIDE} cells, got '
            f'{width} x {height} {margins} its empty margins'
        )
    board = Board(width, height)
    return board, board.mask((x - left, y - bottom) for x, y in cells)
