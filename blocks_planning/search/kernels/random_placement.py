"""One attempt of placing at random."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import (
    count,
    is_empty,
    load,
    lowest,
    store,
    without_lowest,
)
from blocks_planning.board.kernels.moves import Tables, legal_moves
from blocks_planning.search.kernels.outcomes import COMPLETE, STUCK
from blocks_planning.search.kernels.randomness import below


class RandomPlacement(NamedTuple):
    """Memory of a search; ``mask`` as in the tables."""

    moves: np.ndarray  # mask (blocks,)


def make_search(tables: Tables) -> RandomPlacement:
    """A search."""
    return RandomPlacement(np.zeros_like(tables.legal))


@inlined
def move_number(tables, moves, index):
    """The legal move with a number in the order of generation, from 0."""
    for block in range(tables.area.size):
        places = load(moves, block)
        children = count(places)
        if index < children:
            for _ in range(index):
                places = without_lowest(places)
            return block * tables.cells + lowest(places)
        index -= children
    return -1


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Make uniformly drawn legal placements, until the region is filled or none is left.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated: 0)
    """
    length = 0
    while filled < tables.target:
        children = legal_moves(tables, shadow, search.moves, 0)
        if children == 0:
            return STUCK, length, 0
        move = move_number(tables, search.moves, below(generator, children))
        path[length] = move
        length += 1
        shadow = shadow | load(tables.shadow, move)
        filled += tables.area[move // tables.cells]
    return COMPLETE, length, 0


@kernel
def spread(search, tables, region, states, filled, chances, after, areas, after_chances):
    """Make every legal placement in every state of a layer, and write the resulting states.

    States from which the region can't be filled any more, because an empty cell of it is in the
    shadow, are omitted.

    Args:
        search: memory.
        tables: of the region.
        region: its cells, mask (1,).
        states: shadows of states with equally many filled cells, mask (n,).
        filled: their number of filled cells, less than the target.
        chances: their probabilities, float64 (n,).
        after: where the shadows that follow are written, mask (m,), with room for all.
        areas: where the area of the block that leads there is written, int64 (m,) [cells].
        after_chances: where the probability of that placement is written, float64 (m,).

    Returns:
        Number of results written.
    """
    written = 0
    wanted = load(region, 0)
    for index in range(chances.size):
        shadow = load(states, index)
        children = legal_moves(tables, shadow, search.moves, 0)
        for block in range(tables.area.size):
            places = load(search.moves, block)
            reached = filled + tables.area[block]
            while not is_empty(places):
                move = block * tables.cells + lowest(places)
                places = without_lowest(places)
                child = shadow | load(tables.shadow, move)
                if count(child & wanted) == reached:
                    store(after, written, child)
                    areas[written] = tables.area[block]
                    after_chances[written] = chances[index] / children
                    written += 1
    return written
