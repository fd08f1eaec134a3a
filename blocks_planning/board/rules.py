"""The rules of the board, in readable Python on masks (see :mod:`.geometry`).

The world, the records and all other code except searches use these. Searches use the compiled
twins in :mod:`.kernels`; tests compare both.

Block-tower reconstruction is described in Binder et al. (2021), section "Task".
"""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task


def drop(board: Board, built: Mask, placement: Placement) -> Placed | None:
    """Where a block comes to rest, or None if the placement is not *possible*.

    The block rests on the highest filled cell of the columns it covers, or on the ground. It is
    possible if all of it then lies inside the board.
    """
    (width, height), column = placement
    if column < 0 or column + width > board.width:
        return None
    row = max(
        (built >> board.bit(covered, 0) & ((1 << board.height) - 1)).bit_length()
        for covered in range(column, column + width)
    )
    return Placed(width, height, column, row) if row + height <= board.height else None


def cells_of(board: Board, placed: Placed) -> Mask:
    """The cells that a placed block fills."""
    return board.rectangle(placed.column, placed.row, placed.width, placed.height)


def is_inside(board: Board, placed: Placed) -> bool:
    """Whether a block has valid sides, and lies inside the board."""
    width, height, column, row = placed
    return (
        min(width, height) >= 1
        and min(column, row) >= 0
        and column + width <= board.width
        and row + height <= board.height
    )


def possible_placements(board: Board, built: Mask, library: tuple[Block, ...]) -> Iterator[Placed]:
    """Every possible placement, block by block in library order, each from left to right."""
    for block in library:
        for column in range(board.width):
            placed = drop(board, built, Placement(block, column))
            if placed is not None:
                yield placed


def legal_placements(task: Task, built: Mask, region: Mask) -> Iterator[Placed]:
    """The possible placements that cover cells of ``region`` only, in the same order.

    This order is the order in which every search generates children.
    """
    for placed in possible_placements(task.board, built, task.library):
        if not cells_of(task.board, placed) & ~region:
            yield placed


def shadow(board: Board, built: Mask) -> Mask:
    """The filled cells and every cell below one: the cells that no block can reach any more."""
    column_mask = (1 << board.height) - 1
    result = 0
    for column in range(board.width):
        offset = board.bit(column, 0)
        top = (built >> offset & column_mask).bit_length()
        result |= ((1 << top) - 1) << offset
    return result


def is_dead(board: Board, built: Mask, region: Mask) -> bool:
    """Whether a cell of ``region`` lies empty under a filled cell, so that it stays empty."""
    return bool(region & shadow(board, built) & ~built)


def states_along(board: Board, built: Mask, placements: tuple[Placed, ...]) -> list[Mask]:
    """The states along a sequence of possible placements, including the first state."""
    states = [built]
    for placed in placements:
        states.append(states[-1] | cells_of(board, placed))
    return states
