"""Beam search, compiled.

The children of a level are not stored. They are generated twice: first to count them by their
number of filled cells, which gives the threshold for keeping a state, then to keep the best ones.
So only the kept states need memory.
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


class Beam(NamedTuple):
    """Settings and memory of a search: the kept states, level by level; ``mask`` as in tables."""

    width: int
    shadow: np.ndarray  # mask (n,)
    filled: np.ndarray  # int64 (n,) [cells]
    origin: np.ndarray  # int64 (n,): parent << 16 | move; -1 for the root
    moves: np.ndarray  # mask (blocks,)
    children: np.ndarray  # int64 (cells of the board + 1,): of a level, by filled cells


def make_search(tables: Tables, width: int, nodes: int) -> Beam:
    """A search with room for ``nodes`` kept states, on all levels together."""
    mask_shape = tables.legal.shape[1:]
    return Beam(
        width=width,
        shadow=np.empty((nodes, *mask_shape), np.uint64),
        filled=np.empty(nodes, np.int64),
        origin=np.empty(nodes, np.int64),
        moves=np.zeros((len(tables.area), *mask_shape), np.uint64),
        children=np.zeros(tables.cells + 1, np.int64),
    )


@inlined
def _count_children(search, tables, start, end, cancel):
    """Count the children of the states ``start`` to ``end`` by filled cells.

    Returns:
        Their number, or -1 if cancelled.
    """
    for filled in range(search.children.size):
        search.children[filled] = 0
    total = 0
    for node in range(start, end):
        if cancel[0] != 0:
            return -1
        total += legal_moves(tables, load(search.shadow, node), search.moves, 0)
        for block in range(tables.area.size):
            reached = search.filled[node] + tables.area[block]
            search.children[reached] += count(load(search.moves, block))
    return total


@inlined
def _threshold(search, total):
    """The threshold of the best ``width`` of ``total`` children.

    Returns:
        (filled cells of the worst kept children, number of children with that many cells to keep)
    """
    wanted = min(search.width, total)
    filled = search.children.size - 1
    while search.children[filled] < wanted:
        wanted -= search.children[filled]
        filled -= 1
    return filled, wanted


@inlined
def _keep(search, tables, start, end, least, tied, generator, cancel):
    """Keep the children of a level with more than ``least`` cells, and ``tied`` with ``least``.

    The tied ones are drawn in the order of generation, so that every choice of ``tied`` of them is
    equally likely. Nothing is drawn if all are kept.

    Returns:
        The end of the next level, or -1 if cancelled.
    """
    candidates = search.children[least]
    everyone = tied == candidates
    kept = end
    for node in range(start, end):
        if cancel[0] != 0:
            return -1
        shadow, filled = load(search.shadow, node), search.filled[node]
        legal_moves(tables, shadow, search.moves, 0)
        for block in range(tables.area.size):
            reached = filled + tables.area[block]
            if reached < least:
                continue
            places = load(search.moves, block)
            while not is_empty(places):
                move = block * tables.cells + lowest(places)
                places = without_lowest(places)
                if reached == least:
                    is_kept = everyone
                    if tied > 0 and not everyone:
                        is_kept = below(generator, candidates) < tied
                    candidates -= 1
                    if not is_kept:
                        continue
                    tied -= 1
                store(search.shadow, kept, shadow | load(tables.shadow, move))
                search.filled[kept] = reached
                search.origin[kept] = node << _MOVE_BITS | move
                kept += 1
    return kept


@inlined
def _draw_best(search, end, generator):
    """One of the kept states with most filled cells, uniformly."""
    best, ties = 0, 0
    for node in range(end):
        if search.filled[node] > best:
            best, ties = search.filled[node], 0
        ties += search.filled[node] == best
    index = below(generator, ties)
    for node in range(end):
        index -= search.filled[node] == best
        if index < 0:
            return node
    return 0


@inlined
def _write_path(search, node, path):
    """Write the moves that lead to a kept state; return their number."""
    length = 0
    ancestor = node
    while search.origin[ancestor] >= 0:
        ancestor = search.origin[ancestor] >> _MOVE_BITS
        length += 1
    for index in range(length - 1, -1, -1):
        path[index] = search.origin[node] & _MOVE
        node = search.origin[node] >> _MOVE_BITS
    return length


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Search once: the best state is complete, or no legal placement is left in it.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """
    store(search.shadow, 0, shadow)
    search.filled[0] = filled
    search.origin[0] = -1
    start, end, cost = 0, 1, 0
    while True:
        total = _count_children(search, tables, start, end, cancel)
        if total < 0:
            return CANCELLED, 0, cost
        if total == 0:
            break
        cost += total
        if end + min(search.width, total) > search.filled.size:
            return OUT_OF_MEMORY, 0, cost
        least, tied = _threshold(search, total)
        following = _keep(search, tables, start, end, least, tied, generator, cancel)
        if following < 0:
            return CANCELLED, 0, cost
        start, end = end, following
        if search.children[tables.target] > 0:
            break
    best = _draw_best(search, end, generator)
    length = _write_path(search, best, path)
    is_complete = search.filled[best] == tables.target
    return COMPLETE if is_complete else STUCK, length, cost
