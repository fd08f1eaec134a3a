"""A* and best-first search, compiled.

The priority f of a node depends on the blocks placed and the cells left, and has few values. So the
queue has one list of nodes (a bucket) per value, numbered in the order of f: a node is taken from a
uniformly drawn place of the lowest non-empty bucket, and the last node of the bucket moves into
that place.

A node in the queue needs 8 bytes: its parent and its move. Its state is computed when it is taken.
"""

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
from blocks_planning.search.kernels.outcomes import CANCELLED, COMPLETE, OUT_OF_MEMORY, STUCK
from blocks_planning.search.kernels.randomness import below

_MOVE_BITS = 16  # a move is below 64 blocks * 256 cells = 2**14
_MOVE = (1 << _MOVE_BITS) - 1
_FIRST_CAPACITY = 32
_START, _SIZE, _CAPACITY = 0, 1, 2


class BestFirst(NamedTuple):
    """Settings and memory of a search; ``mask`` as in the tables."""

    iterations: int
    bucket: np.ndarray  # int64 (most blocks placed + 1, most cells left + 1): by rank of f
    whole_path: bool  # execute the whole path of a search without a complete state
    shadow: np.ndarray  # mask (iterations,): of the nodes taken, in order
    filled: np.ndarray  # int64 (iterations,) [cells]
    origin: np.ndarray  # int64 (iterations,): parent << 16 | move; -1 for the root
    length: np.ndarray  # int64 (iterations,): blocks placed since the search began
    moves: np.ndarray  # mask (blocks,)
    buckets: np.ndarray  # int64 (3, values): start, size and capacity of each list in the arena
    arena: np.ndarray  # int64 (n,): contains the lists


def make_search(
    tables: Tables, iterations: int, bucket: np.ndarray, whole_path: bool, nodes: int
) -> BestFirst:
    """A search with a queue of limited size.

    Memory that is never touched is not allocated by the system, so unused iterations need none.
    """
    mask_shape = tables.legal.shape[1:]
    return BestFirst(
        iterations=iterations,
        bucket=bucket,
        whole_path=whole_path,
        shadow=np.empty((iterations, *mask_shape), np.uint64),
        filled=np.empty(iterations, np.int64),
        origin=np.empty(iterations, np.int64),
        length=np.empty(iterations, np.int64),
        moves=np.zeros((len(tables.area), *mask_shape), np.uint64),
        buckets=np.zeros((3, int(bucket.max()) + 1), np.int64),
        arena=np.empty(nodes, np.int64),
    )


@inlined
def _room(search, value, more, used):
    """Make room for ``more`` nodes in a bucket, if the arena is large enough.

    Returns:
        Number of places of the arena that are used afterwards, or would be needed.
    """
    buckets, arena = search.buckets, search.arena
    start, size = buckets[_START, value], buckets[_SIZE, value]
    capacity = buckets[_CAPACITY, value]
    if size + more <= capacity:
        return used
    capacity = max(4 * capacity, size + more, _FIRST_CAPACITY)
    if used + capacity <= arena.size:
        for index in range(size):
            arena[used + index] = arena[start + index]
        buckets[_START, value] = used
        buckets[_CAPACITY, value] = capacity
    return used + capacity


@inlined
def _draw(search, value, generator):
    """Take a node from a uniformly drawn place of a non-empty bucket."""
    buckets, arena = search.buckets, search.arena
    start, size = buckets[_START, value], buckets[_SIZE, value]
    place = start + below(generator, size)
    node = arena[place]
    arena[place] = arena[start + size - 1]
    buckets[_SIZE, value] = size - 1
    return node


@inlined
def _search_once(search, tables, shadow, filled, generator, cancel):
    """Search once from a state that is not complete.

    Returns:
        (outcome, index of the last node taken, states evaluated). The outcome is STUCK
        if no complete state was taken,
        and OUT_OF_MEMORY if the arena is too small.
    """
    buckets, bucket = search.buckets, search.bucket
    for value in range(buckets.shape[1]):
        buckets[_SIZE, value] = 0
        buckets[_CAPACITY, value] = 0
    lowest_value = bucket[0, tables.target - filled]
    used = _room(search, lowest_value, 1, 0)
    search.arena[buckets[_START, lowest_value]] = -1
    buckets[_SIZE, lowest_value] = 1
    root_shadow, root_filled = shadow, filled
    cost = 0
    for taken in range(search.iterations):
        while lowest_value < buckets.shape[1] and buckets[_SIZE, lowest_value] == 0:
            lowest_value += 1
        if lowest_value == buckets.shape[1]:
            return STUCK, taken - 1, cost
        if cancel[0] != 0:
            return CANCELLED, taken - 1, cost
        origin = _draw(search, lowest_value, generator)
        shadow, filled, length = root_shadow, root_filled, 0
        if origin >= 0:
            parent, move = origin >> _MOVE_BITS, origin & _MOVE
            shadow = load(search.shadow, parent) | load(tables.shadow, move)
            filled = search.filled[parent] + tables.area[move // tables.cells]
            length = search.length[parent] + 1
        store(search.shadow, taken, shadow)
        search.filled[taken] = filled
        search.origin[taken] = origin
        search.length[taken] = length
        if filled == tables.target:
            return COMPLETE, taken, cost
        cost += legal_moves(tables, shadow, search.moves, 0)
        for block in range(tables.area.size):
            places = load(search.moves, block)
            if is_empty(places):
                continue
            left = tables.target - filled - tables.area[block]
            value = bucket[length + 1, left]
            children = count(places)
            used = _room(search, value, children, used)
            if used > search.arena.size:
                return OUT_OF_MEMORY, taken, cost
            end = buckets[_START, value] + buckets[_SIZE, value]
            buckets[_SIZE, value] += children
            lowest_value = min(lowest_value, value)
            child = taken << _MOVE_BITS | block * tables.cells
            while not is_empty(places):
                search.arena[end] = child + lowest(places)
                end += 1
                places = without_lowest(places)
    return STUCK, search.iterations - 1, cost


@inlined
def _write_path(search, node, path, start):
    """Write the moves that lead to a node to ``path[start:]``; return their number."""
    length = search.length[node]
    for index in range(length - 1, -1, -1):
        origin = search.origin[node]
        path[start + index] = origin & _MOVE
        node = origin >> _MOVE_BITS
    return length


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Search and place, until the region is filled or no legal placement is left.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """
    length = 0
    cost = 0
    while filled < tables.target:
        outcome, node, evaluated = _search_once(search, tables, shadow, filled, generator, cancel)
        cost += evaluated
        if outcome != COMPLETE and outcome != STUCK:
            return outcome, length, cost
        steps = _write_path(search, node, path, length)
        if outcome == COMPLETE:
            return COMPLETE, length + steps, cost
        if steps == 0:
            return STUCK, length, cost
        if not search.whole_path:
            steps = 1
        for index in range(length, length + steps):
            shadow = shadow | load(tables.shadow, path[index])
            filled += tables.area[path[index] // tables.cells]
        length += steps
    return COMPLETE, length, cost
