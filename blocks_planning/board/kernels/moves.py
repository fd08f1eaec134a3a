"""Compiled twins of the rules: which placements are legal.

A search only needs the *shadow* of a state: the filled cells and all cells below them. With
``free`` the other cells, a block of width 1 lands on the lowest free cell of a column; one of width
2 on the lowest row that is free in both columns, that is on ``free & (free >> height)``, and so on
for wider ones. A few shifts give all landing places of a width, and one precomputed mask per block
selects the legal ones. A placement adds the precomputed shadow of the block.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Library
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.kernels.compiling import inlined
from blocks_planning.board.kernels.masks import WORD_BITS, count, is_empty, load, pack, store
from blocks_planning.board.task import Task


class Tables(NamedTuple):
    """Tables of (task, region) for kernels. ``mask`` is uint64 (n,) or (n, 4).

    A *move* is a placement with the row where it lands, as one number:
    ``block index * cells + bit of its lower left cell``.
    """

    cells: int  # of the board
    target: int  # cells in the region
    board: np.ndarray  # mask (2,): every cell; every cell above the ground
    width_shift: np.ndarray  # uint64 (steps,): free places of a width from those of a lesser one
    width_step: np.ndarray  # int64 (blocks,): how many steps lead to the block's width
    area: np.ndarray  # int64 (blocks,) [cells]
    legal: np.ndarray  # mask (blocks,): lower left cells from which the block is in the region
    shadow: np.ndarray  # mask (blocks * cells,): of the block at each move; empty off the board


class Footprints(NamedTuple):
    """The common part of the tables of all regions, and the cells of each block at each bit."""

    cells: tuple[tuple[Mask, ...], ...]  # by block and bit; none off the board
    mask: np.ndarray  # mask (blocks * cells,): the same at each move
    board: np.ndarray
    width_shift: np.ndarray
    width_step: np.ndarray
    area: np.ndarray
    shadow: np.ndarray


def make_tables(task: Task, region: Mask) -> Tables:
    """The tables of a task and a region."""
    board = task.board
    outside = board.full & ~region
    footprints = footprints_of(board, task.library)
    legal = [
        sum(1 << bit for bit, cells in enumerate(block) if cells and not cells & outside)
        for block in footprints.cells
    ]
    return Tables(
        cells=board.size,
        target=area(region),
        board=footprints.board,
        width_shift=footprints.width_shift,
        width_step=footprints.width_step,
        area=footprints.area,
        legal=pack(legal, board.size),
        shadow=footprints.shadow,
    )


@lru_cache(maxsize=64)
def footprints_of(board: Board, library: Library) -> Footprints:
    """The footprints of the blocks of a library on a board."""
    shifts, steps = _width_steps(library, board.height)
    cells = [[_cells_at(board, block, bit) for bit in range(board.size)] for block in library]
    shadows = [rules.shadow(board, mask) for block in cells for mask in block]
    return Footprints(
        cells=tuple(map(tuple, cells)),
        mask=pack([mask for block in cells for mask in block], board.size),
        board=pack([board.full, board.full & ~board.ground], board.size),
        width_shift=np.array(shifts, dtype=np.uint64),
        width_step=np.array(steps, dtype=np.int64),
        area=np.array([block.area for block in library], dtype=np.int64),
        shadow=pack(shadows, board.size),
    )


def _cells_at(board: Board, block: Block, bit: int) -> Mask:
    """The cells of a block with its lower left cell at a bit; none if it leaves the board."""
    column, row = board.cell(bit)
    if column + block.width > board.width or row + block.height > board.height:
        return 0
    return board.rectangle(column, row, block.width, block.height)


def _width_steps(library: Library, height: int) -> tuple[list[int], list[int]]:
    """A chain of shifts that visits every width of the library, from 1 upwards.

    From the free places of width v those of width w <= 2 v follow by one shift of w - v columns;
    longer ways, and shifts of 64 bits or more, take steps in between.
    """
    shifts: list[int] = []
    step_of = {1: 0}
    reached = 1
    longest = max(1, (WORD_BITS - 1) // height)
    for width in sorted({block.width for block in library}):
        while reached < width:
            step = min(width - reached, reached, longest)
            shifts.append(step * height)
            reached += step
        step_of[width] = len(shifts)
    return shifts, [step_of[block.width] for block in library]


@inlined
def _places(tables, above, block, free, step):
    """The legal landing places of a block.

    ``above`` is what is not in the shadow, a mask: the free places of width 1. ``free`` are the
    free places of the width that is reached after ``step`` steps of the chain of widths.

    Returns:
        (places, mask; the free places of the block's width, mask; its step)
    """
    wanted = tables.width_step[block]
    if wanted < step:
        free, step = above, 0
    while step < wanted:
        free = free & (free >> tables.width_shift[step])
        step += 1
    landing = free & ~((free << np.uint64(1)) & load(tables.board, 1))
    return landing & load(tables.legal, block), free, step


@inlined
def legal_moves(tables, shadow, moves, first):
    """Write the legal landing places of every block, masks, to ``moves[first:]``; count them.

    Returns:
        The number of legal placements: the children that the state has.
    """
    above = load(tables.board, 0) & ~shadow
    free, step, children = above, 0, 0
    for block in range(tables.area.size):
        places, free, step = _places(tables, above, block, free, step)
        store(moves, first + block, places)
        children += count(places)
    return children


@inlined
def has_move(tables, shadow):
    """Whether a legal placement is left."""
    above = load(tables.board, 0) & ~shadow
    free, step = above, 0
    for block in range(tables.area.size):
        places, free, step = _places(tables, above, block, free, step)
        if not is_empty(places):
            return True
    return False
