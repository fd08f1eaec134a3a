"""Many problems of one task, solved one after the other in a single call. Compiled.

What a region needs is made here as well: the tables of a region differ in its area and in the
places from which each block is inside it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import add_bit, count, is_empty, load, store
from blocks_planning.board.kernels.moves import Tables, has_move
from blocks_planning.search.kernels.attempts import run_attempts
from blocks_planning.search.kernels.outcomes import NO_PLACEMENT, SOLVED_ALREADY


class Batch(NamedTuple):
    """Problems and their answers; ``mask`` as in the tables."""

    built: np.ndarray  # mask (n,)
    region: np.ndarray  # mask (n,)
    seed_words: np.ndarray  # uint64 (n, 8): state and region
    steps: int  # height of the board [cells]
    stop: np.ndarray  # uint8 (1,): other than 0 to take up no further problem
    outcome: np.ndarray  # int64 (n,); see :mod:`.outcomes`
    length: np.ndarray  # int64 (n,) [placements]
    path: np.ndarray  # int64 (n, most placements): the moves of the last attempt
    solution_cost: np.ndarray  # int64 (n,): of the last attempt [states]
    planning_cost: np.ndarray  # int64 (n,): of all attempts [states]
    attempts: np.ndarray  # int64 (n,)


@inlined
def _shadow(tables, built, steps):
    """The cells of a state and all below them, a mask."""
    shadow = built
    for _ in range(steps - 1):
        shadow = shadow | ((shadow & load(tables.board, 1)) >> np.uint64(1))
    return shadow


@inlined
def _tables_of(tables, footprints, region):
    """Write where each block is inside a region; return the region's tables.

    ``footprints`` are the cells of the blocks by move, mask (blocks * cells,).
    """
    none = region & ~region
    outside = ~region
    for block in range(tables.area.size):
        store(tables.legal, block, none)
        for bit in range(tables.cells):
            cells = load(footprints, block * tables.cells + bit)
            if not is_empty(cells) and is_empty(cells & outside):
                add_bit(tables.legal, block, bit)
    return Tables(
        tables.cells,
        count(region),
        tables.board,
        tables.width_shift,
        tables.width_step,
        tables.area,
        tables.legal,
        tables.shadow,
    )


@kernel
def solve_batch(search, tables, footprints, batch, conditions):
    """Solve every problem of a batch, unless stopped.

    Args:
        search: which one it is, by its type.
        tables: of the task; what belongs to a region is overwritten.
        footprints: the cells of the blocks by move, mask (blocks * cells,).
        batch: the problems, and where their answers are written.
        conditions: of every attempt.
    """
    for index in range(batch.outcome.size):
        if batch.stop[0] != 0:
            return
        built, region = load(batch.built, index), load(batch.region, index)
        if built == region:
            batch.outcome[index] = SOLVED_ALREADY
            continue
        mine = _tables_of(tables, footprints, region)
        shadow = _shadow(mine, built, batch.steps)
        if not has_move(mine, shadow):
            batch.outcome[index] = NO_PLACEMENT
            continue
        for word in range(batch.seed_words.shape[1]):
            conditions.seed_words[1 + word] = batch.seed_words[index, word]
        outcome, length, cost, total, number = run_attempts(
            search, mine, shadow, count(built), conditions
        )
        batch.outcome[index] = outcome
        batch.length[index] = length
        batch.solution_cost[index] = cost
        batch.planning_cost[index] = total
        batch.attempts[index] = number
        for place in range(length):
            batch.path[index, place] = conditions.path[place]
