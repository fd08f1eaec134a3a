"""All outlines that legal placements reach, and the number of sequences to each. Compiled.

The legal placements depend only on the shadow of a state (see :mod:`.moves`), so states with the
same shadow have the same continuations and are one outline. Outlines are processed by rising number
of cells, so that all sequences to an outline are known before it is expanded.
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
"""There are more outlines than fit into the memory."""
OVERFLOW = -2
"""A number of sequences needs more words."""
CANCELLED = -3
"""The cancel flag was set."""
_CHECK_EVERY = 4096
_NONE = -1


class Walks(NamedTuple):
    """The outlines found, by number; ``mask`` is uint64 (n,) or (n, 4) as in the tables."""

    shadow: np.ndarray  # mask (n,)
    ways: np.ndarray  # uint64 (n, words): sequences that lead here; little-endian
    whole: np.ndarray  # uint64 (n, words): those of them that leave no hole in the region
    following: np.ndarray  # int32 (n,): another outline with equally many cells, or -1
    first: np.ndarray  # int32 (cells + 1,): an outline with that many cells, or -1
    slots: np.ndarray  # int32 (2**k,), at least twice n: a hash table of outlines, -1 where free
    ended: np.ndarray  # uint64 (1, words): sequences after which no legal placement is left
    moves: np.ndarray  # mask (blocks,)
    after: np.ndarray  # mask (children,): the outlines after each placement
    keeps: np.ndarray  # bool (children,): whether it leaves no hole in the region
    near: np.ndarray  # int32 (children,): the outline in the first slot of each, or -1
    read: np.ndarray  # uint64 (1,): a sum over rows that were read ahead; has no meaning


def make_walks(
    size: int, mask_shape: tuple[int, ...], words: int, cells: int, blocks: int
) -> Walks:
    """Memory for up to ``size`` outlines; untouched memory is not allocated by the system.

    The shadow and the numbers of an outline are one row, because they are needed together.
    """
    width = int(np.prod(mask_shape))
    rows = np.empty((size, width + 2 * words), np.uint64)
    most = blocks * cells
    return Walks(
        shadow=rows[:, :width].reshape(size, *mask_shape),
        ways=rows[:, width : width + words],
        whole=rows[:, width + words :],
        following=np.empty(size, np.int32),
        first=np.full(cells + 1, _NONE, np.int32),
        slots=np.full(1 << (2 * size - 1).bit_length(), _NONE, np.int32),
        ended=np.zeros((1, words), np.uint64),
        moves=np.zeros((blocks, *mask_shape), np.uint64),
        after=np.zeros((most, *mask_shape), np.uint64),
        keeps=np.zeros(most, np.bool_),
        near=np.zeros(most, np.int32),
        read=np.zeros(1, np.uint64),
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
def _enter(walks, found, shadow):
    """The number of an outline, and the new count of outlines; FULL if there is no room."""
    last = np.uint64(walks.slots.size - 1)
    slot = digest(shadow) & last
    while walks.slots[slot] >= 0:
        if load(walks.shadow, walks.slots[slot]) == shadow:
            return np.int64(walks.slots[slot]), found
        slot = (slot + np.uint64(1)) & last
    if found == walks.following.size:
        return FULL, found
    walks.slots[slot] = found
    store(walks.shadow, found, shadow)
    for word in range(walks.ways.shape[1]):
        walks.ways[found, word] = np.uint64(0)
        walks.whole[found, word] = np.uint64(0)
    cells = count(shadow)
    walks.following[found] = walks.first[cells]
    walks.first[cells] = found
    return found, found + 1


@inlined
def _list_children(walks, tables, shadow, wanted):
    """Write the outlines that follow, and read the rows where they probably are.

    These lie anywhere in memory. Many reads at once take little longer than one of them, and
    then the rows are in the cache. Each is read at both ends, because it can begin in one line of
    the cache and end in the next.
    """
    covered = count(shadow & wanted)
    last = np.uint64(walks.slots.size - 1)
    child = 0
    for block in range(tables.area.size):
        places = load(walks.moves, block)
        while not is_empty(places):
            move = block * tables.cells + lowest(places)
            places = without_lowest(places)
            after = shadow | load(tables.shadow, move)
            store(walks.after, child, after)
            # Without a hole, all cells of the region in the shadow are filled.
            walks.keeps[child] = count(after & wanted) == covered + tables.area[block]
            walks.near[child] = walks.slots[digest(after) & last]
            child += 1
    for index in range(child):
        near = walks.near[index]
        if near >= 0:
            walks.read[0] += walks.ways[near, 0] + walks.whole[near, walks.whole.shape[1] - 1]


@kernel
def walk(walks, tables, region, cancel):
    """Find all outlines that legal placements reach from the empty board; count their sequences.

    Args:
        walks: new memory.
        tables: of the region.
        region: the cells of the region, and an empty mask, mask (2,).
        cancel: uint8 (1,).

    Returns:
        The number of outlines, or FULL, OVERFLOW or CANCELLED.
    """
    wanted = load(region, 0)
    state, found = _enter(walks, 0, load(region, 1))
    walks.ways[0, 0] = np.uint64(1)
    walks.whole[0, 0] = np.uint64(1)
    looked_at = 0
    for cells in range(tables.cells + 1):
        state = np.int64(walks.first[cells])
        while state >= 0:
            if looked_at % _CHECK_EVERY == 0 and cancel[0] != 0:
                return CANCELLED
            looked_at += 1
            shadow = load(walks.shadow, state)
            children = legal_moves(tables, shadow, walks.moves, 0)
            if children == 0 and _add(walks.ended, 0, walks.ways, state):
                return OVERFLOW
            _list_children(walks, tables, shadow, wanted)
            for child in range(children):
                place, found = _enter(walks, found, load(walks.after, child))
                if place < 0:
                    return FULL
                if _add(walks.ways, place, walks.ways, state):
                    return OVERFLOW
                if walks.keeps[child]:
                    _add(walks.whole, place, walks.whole, state)
            state = np.int64(walks.following[state])
    return found
