"""The states from which a region can still be filled, by number. Compiled.

A state is *alive* if no cell of the region lies empty under a filled one and nothing outside the
region is filled. Its shadow determines it. An alive state follows from another one only by a legal
placement, ordered or by slipping; so one set of states is valid for every probability of slipping
and every policy.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import (
    count,
    digest,
    is_empty,
    load,
    lowest,
    store,
    without_lowest,
)
from blocks_planning.board.kernels.moves import Tables, legal_moves

DEAD = 0
"""The number of all states that are not alive."""
IMPOSSIBLE = -1
"""In ``Space.child``: the block cannot land in this column."""
_CHECK_EVERY = 1024


class Space(NamedTuple):
    """The states found so far, and working memory; ``mask`` as in the tables.

    State 0 is :data:`DEAD`; the others have the numbers 1, 2, ... in the order of discovery.
    """

    tables: Tables  # of (task, region)
    possible: Tables  # of (task, whole board): its legal placements are the possible ones
    height: int  # of the board [cells]
    region: np.ndarray  # mask (1,)
    shadow: np.ndarray  # mask (n,)
    filled: np.ndarray  # int32 (n,) [cells]
    slots: np.ndarray  # int32 (2**k,): hash table of numbers, 0 where free, at least 2 n
    used: np.ndarray  # int64 (1,): count of used numbers, including state 0
    places: np.ndarray  # mask (blocks,): landing places in the current state
    child: np.ndarray  # int64 (width + 2,): state after a block, by its column + 1
    legal: np.ndarray  # uint8 (width + 2,): whether that placement is legal


@inlined
def _slot(space, shadow):
    """The slot of a state, or the free slot where it belongs."""
    last = np.uint64(space.slots.size - 1)
    slot = digest(shadow) & last
    while space.slots[slot] > 0 and load(space.shadow, space.slots[slot]) != shadow:
        slot = (slot + np.uint64(1)) & last
    return slot


@inlined
def land(space, shadow, filled, block, adding):
    """Write to ``space.child`` and ``space.legal`` the results of a block in each column.

    ``space.places`` must hold the possible landing places of the state. ``adding``: whether
    new states get a number; otherwise every alive state must have one.

    Returns:
        The number of legal placements of the block.
    """
    for column in range(space.child.size):
        space.child[column] = IMPOSSIBLE
        space.legal[column] = 0
    tables = space.tables
    region, legal = load(space.region, 0), load(tables.legal, block)
    places = load(space.places, block)
    reached = filled + tables.area[block]
    number = 0
    while not is_empty(places):
        bit = lowest(places)
        rest = without_lowest(places)
        column = bit // space.height + 1
        space.child[column] = DEAD
        if not is_empty(places & ~rest & legal):
            number += 1
            space.legal[column] = 1
            after = shadow | load(tables.shadow, block * tables.cells + bit)
            if count(after & region) == reached:
                slot = _slot(space, after)
                if adding and space.slots[slot] == 0:
                    index = space.used[0]
                    space.slots[slot] = index
                    store(space.shadow, index, after)
                    space.filled[index] = reached
                    space.used[0] = index + 1
                space.child[column] = np.int64(space.slots[slot])
        places = rest
    return number


@kernel
def expand(space, first, most, cancel):
    """Find every state that follows from the states ``first`` and later, including new ones.

    Args:
        space: with the states so far.
        first: number of the first state to expand.
        most: number of states to expand before returning.
        cancel: uint8 (1,).

    Returns:
        The first state that was not expanded: the last one plus 1, or less if the room for states,
        or ``most``, was used up, or the flag was set.
    """
    children = space.tables.area.size * (space.child.size - 2)
    end = first + most
    while first < space.used[0] and first < end:
        if space.used[0] + children > space.filled.size:
            break
        if first % _CHECK_EVERY == 0 and cancel[0] != 0:
            break
        shadow, filled = load(space.shadow, first), np.int64(space.filled[first])
        legal_moves(space.possible, shadow, space.places, 0)
        for block in range(space.tables.area.size):
            land(space, shadow, filled, block, True)
        first += 1
    return first


@kernel
def fill_slots(space):
    """Insert every state into an empty hash table."""
    for index in range(1, space.used[0]):
        space.slots[_slot(space, load(space.shadow, index))] = index


@kernel
def number_of(space, state):
    """The number of the state with a shadow, mask (1,); 0 if there is none."""
    return np.int64(space.slots[_slot(space, load(state, 0))])
