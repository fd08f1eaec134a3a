"""The memory of the compiled searches, allocated for each thread.

A search that stores nodes first gets room for a few. If they are not enough, the function is called
again with ``growth`` raised by one; each step gives four times as many nodes. Memory that is never
touched is not taken from the machine.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from blocks_planning.board.kernels.moves import Tables
from blocks_planning.errors import LimitExceeded
from blocks_planning.search import logarithms
from blocks_planning.search.kernels import (
    beam,
    best_first,
    lookahead,
    random_placement,
    tree_search,
)

_NODES_PER_ITERATION = 64
_MOST_NODES_AT_FIRST = 1 << 20
_GROWTH = 4
MAX_NODES = 1 << 27
"""Largest number of nodes in the queue of a best-first search, 8 bytes each."""
MAX_BEAM_NODES = 1 << 24
"""Largest number of states kept by a beam search, all levels together, up to 48 bytes each."""
MAX_TREE_NODES = 1 << 24
"""Largest number of nodes of a Monte Carlo tree, up to 64 bytes each."""


def at_random(tables: Tables) -> Any:
    """The memory of random placement."""
    return random_placement.make_search(tables)


def breadth_first(tables: Tables, depth: int, dead_ends_last: bool) -> Any:
    """The memory of breadth-first lookahead."""
    return lookahead.make_search(tables, depth, dead_ends_last)


def queue(
    tables: Tables,
    most_left: int,
    growth: int,
    iterations: int,
    g_weight: int,
    divisor: float,
    whole_path: bool,
) -> Any:
    """The memory of A* and best-first search: f = g_weight * blocks placed + cells left / divisor.

    Args:
        tables: of the task.
        most_left: upper bound of the number of cells to fill.
        growth: number of times that the queue was too small.
        iterations: number of nodes taken in one search.
        g_weight: 1 or 0.
        divisor: [cells].
        whole_path: whether the whole path of a search is executed.

    Raises:
        LimitExceeded: if the queue would be too large.
    """
    most_blocks = most_left // int(tables.area.min()) + 1
    nodes = _room(
        min(_NODES_PER_ITERATION * iterations, _MOST_NODES_AT_FIRST),
        growth,
        MAX_NODES,
        'the queue of the search',
        'allow fewer iterations',
    )
    buckets = _buckets(most_blocks, most_left, g_weight, divisor)
    return best_first.make_search(tables, iterations, buckets, whole_path, nodes)


def kept_states(tables: Tables, most_left: int, growth: int, width: int) -> Any:
    """The memory of beam search; the arguments are those of :func:`queue`.

    Raises:
        LimitExceeded: if too many states would be kept.
    """
    levels = most_left // int(tables.area.min()) + 2
    nodes = _room(
        min(width * levels, _MOST_NODES_AT_FIRST),
        growth,
        MAX_BEAM_NODES,
        'the beam of the search',
        'allow a smaller width',
    )
    return beam.make_search(tables, width, nodes)


def tree(tables: Tables, growth: int, iterations: int, exploration: float) -> Any:
    """The memory of Monte Carlo tree search; the arguments are those of :func:`queue`.

    Raises:
        LimitExceeded: if the tree would be too large.
    """
    nodes = _room(
        min(_NODES_PER_ITERATION * iterations, _MOST_NODES_AT_FIRST),
        growth,
        MAX_TREE_NODES,
        'the tree of the search',
        'allow fewer iterations',
    )
    return tree_search.make_search(
        tables, iterations, exploration, logarithms.natural(iterations), nodes
    )


def _room(first: int, growth: int, most: int, what: str, remedy: str) -> int:
    """Number of nodes after ``growth`` steps."""
    nodes = first * int(_GROWTH**growth)
    if growth > 0 and nodes > most:
        raise LimitExceeded(f'{what} exceeds {nodes // _GROWTH} nodes; {remedy}')
    return nodes


@lru_cache(maxsize=4096)
def _buckets(most_blocks: int, most_left: int, g_weight: int, divisor: float) -> np.ndarray:
    """The rank of f, from 0, by blocks placed and cells left: int64 (blocks + 1, left + 1).

    f is the float64 that the formula gives. Values that are equal as fractions can differ in
    the last bit, and then they are not equal.
    """
    placed, left = np.indices((most_blocks + 1, most_left + 1))
    f = g_weight * placed + left / divisor
    _, rank = np.unique(f, return_inverse=True)
    return rank.reshape(f.shape).astype(np.int64)
