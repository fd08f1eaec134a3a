"""Every state that legal placements lead to, and the number of ways to each. Compiled.

States are taken by rising number of filled cells, so that all ways to a state are known before it
is left.
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
from blocks_planning.board.kernels.moves import legal_moves

FULL = -1
"""There are more states than the memory holds."""
OVERFLOW = -2
"""A number of ways needs more words."""
CANCELLED = -3
"""The cancel flag was up."""
_CHECK_EVERY = 4096
_NONE = -1


class Walks(NamedTuple):
    """The states found, by number; ``mask`` is uint64 (n,) or (n, 4) as in the tables."""

    filled: np.ndarray  # mask (n,)
    shadow: np.ndarray  # mask (n,)
    ways: np.ndarray  # uint64 (n, words): little-endian
    following: np.ndarray  # int32 (n,): another state with equally many filled cells, or -1
    first: np.ndarray  # int32 (cells + 1,): a state with that many filled cells, or -1
    slots: np.ndarray  # int32 (2**k,), at least twice n: a hash table of states, -1 where free
    ended: np.ndarray  # uint64 (1, words): ways to states without a legal placement
    moves: np.ndarray  # mask (blocks,)


def make_walks(size: int, mask_shape: tuple[int, ...], words: int, cells: int, blocks: int) -> Walks:
    """Memory for up to ``size`` states; what is not touched takes none."""
    return Walks(
        filled=np.empty((size, *mask_shape), np.uint64),
        shadow=np.empty((size, *mask_shape), np.uint64),
        ways=np.empty((size, words), np.uint64),
        following=np.empty(size, np.int32),
        first=np.full(cells + 1, _NONE, np.int32),
        slots=np.full(1 << (2 * size - 1).bit_length(), _NONE, np.int32),
        ended=np.zeros((1, words), np.uint64),
        moves=np.zeros((blocks, *mask_shape), np.uint64),
    )


@inlined
def _add(numbers, index, more, other):
    """Add number ``other`` of ``more``; return whether it overflows."""
    carry = np.uint64(0)
    for word in range(numbers.shape[1]):
        total = more[other, word] + carry
        carry = np.uint64(total < carry)
        numbers[index, word] += total
        carry += np.uint64(numbers[index, word] < total)
    return carry != np.uint64(0)


@inlined
def _enter(walks, found, filled, shadow, cells):
    """The number of a state, and how many there are now; FULL if it has no room."""
    last = np.uint64(walks.slots.size - 1)
    slot = digest(filled) & last
    while walks.slots[slot] >= 0:
        if load(walks.filled, walks.slots[slot]) == filled:
            return np.int64(walks.slots[slot]), found
        slot = (slot + np.uint64(1)) & last
    if found == walks.following.size:
        return FULL, found
    walks.slots[slot] = found
    store(walks.filled, found, filled)
    store(walks.shadow, found, shadow)
    for word in range(walks.ways.shape[1]):
        walks.ways[found, word] = np.uint64(0)
    walks.following[found] = walks.first[cells]
    walks.first[cells] = found
    return found, found + 1


@kernel
def walk(walks, tables, blocks, start, cancel):
    """Find every state that legal placements reach, and the number of ways to each.

    Args:
        walks: memory, as it was made.
        tables: of the region.
        blocks: cells of the block at each move, mask (blocks * cells,).
        start: the filled cells and the shadow of the first state, mask (2,).
        cancel: uint8 (1,).

    Returns:
        The number of states, or FULL, OVERFLOW or CANCELLED.
    """
    begun = count(load(start, 0))
    state, found = _enter(walks, 0, load(start, 0), load(start, 1), begun)
    walks.ways[0, 0] = np.uint64(1)
    looked_at = 0
    for cells in range(begun, tables.cells + 1):
        state = np.int64(walks.first[cells])
        while state >= 0:
            if looked_at % _CHECK_EVERY == 0 and cancel[0] != 0:
                return CANCELLED
            looked_at += 1
            filled, shadow = load(walks.filled, state), load(walks.shadow, state)
            children = legal_moves(tables, shadow, walks.moves, 0)
            if children == 0 and _add(walks.ended, 0, walks.ways, state):
                return OVERFLOW
            for block in range(tables.area.size):
                places = load(walks.moves, block)
                reached = cells + tables.area[block]
                while not is_empty(places):
                    move = block * tables.cells + lowest(places)
                    places = without_lowest(places)
                    after = filled | load(blocks, move)
                    covered = shadow | load(tables.shadow, move)
                    child, found = _enter(walks, found, after, covered, reached)
                    if child < 0:
                        return FULL
                    if _add(walks.ways, child, walks.ways, state):
                        return OVERFLOW
            state = np.int64(walks.following[state])
    return found
