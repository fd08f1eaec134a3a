"""Many problems of one task, solved one after the other in a single call. Compiled.

The tables of each region are computed here as well: they differ only in the area of the region and
in the places at which each block is inside it.
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
    stop: np.ndarray  # uint8 (1,): if not 0, no further problem is started
    outcome: np.ndarray  # int64 (n,); see :mod:`.outcomes`
    length: np.ndarray  # int64 (n,) [placements]
    path: np.ndarray  # int64 (n, most placements): the moves of the last attempt
    solution_cost: np.ndarray  # int64 (n,): of the last attempt [states]
    planning_cost: np.ndarray  # int64 (n,): of all attempts [states]
    attempts: np.ndarray  # int64 (n,)


@inlined
def _shadow(tables, built, steps):
    """The shadow of a state (its cells and all cells below them), a mask."""
    shadow = built
    for _ in range(steps - 1):
        shadow = shadow | ((shadow & load(tables.board, 1)) >> np.uint64(1))
    return shadow


@inlined
def _tables_of(tables, footprints, region):
    """Write the places at which each block is inside a region; return the tables of the region.

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
        search: the search; its type selects the attempt.
        tables: of the task; the parts that depend on the region are overwritten.
        footprints: the cells of the blocks by move, mask (blocks * cells,).
        batch: the problems, and the arrays for their answers.
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
