"""Monte Carlo tree search, compiled.

When a walk first passes a node, room is reserved for all its children side by side, in the order of
generation; children without a visit are not in the tree yet. The sums of rewards are whole numbers
of cells, so the order of summation does not matter. The logarithms are in a table
(:func:`.logarithms.natural`) that is the same on every machine.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import is_empty, load, lowest, store, without_lowest
from blocks_planning.board.kernels.moves import Tables, legal_moves
from blocks_planning.search.kernels.outcomes import CANCELLED, COMPLETE, OUT_OF_MEMORY, STUCK
from blocks_planning.search.kernels.random_placement import move_number
from blocks_planning.search.kernels.randomness import below

_UNKNOWN = -1


class TreeSearch(NamedTuple):
    """Settings and memory of a search; the root is node 0; ``mask`` as in the tables."""

    iterations: int
    exploration: float
    logarithm: np.ndarray  # float64 (iterations + 1,): of each number of visits; of 0 unused
    shadow: np.ndarray  # mask (n,)
    filled: np.ndarray  # int32 (n,) [cells]
    move: np.ndarray  # int32 (n,): that leads there
    visits: np.ndarray  # int32 (n,)
    rewards: np.ndarray  # int64 (n,): filled cells at the ends of its visits, summed [cells]
    children: np.ndarray  # int32 (n,): their number, or -1 if it is not known yet
    first: np.ndarray  # int32 (n,): the first child
    tried: np.ndarray  # int32 (n,): number of children with a visit
    moves: np.ndarray  # mask (blocks,)
    way: np.ndarray  # int64 (cells + 1,): the nodes of an iteration, from the root


def make_search(
    tables: Tables, iterations: int, exploration: float, logarithm: np.ndarray, nodes: int
) -> TreeSearch:
    """A search with room for ``nodes`` nodes, including those without a visit."""
    mask_shape = tables.legal.shape[1:]
    return TreeSearch(
        iterations=iterations,
        exploration=exploration,
        logarithm=logarithm,
        shadow=np.empty((nodes, *mask_shape), np.uint64),
        filled=np.empty(nodes, np.int32),
        move=np.empty(nodes, np.int32),
        visits=np.empty(nodes, np.int32),
        rewards=np.empty(nodes, np.int64),
        children=np.empty(nodes, np.int32),
        first=np.empty(nodes, np.int32),
        tried=np.empty(nodes, np.int32),
        moves=np.zeros((len(tables.area), *mask_shape), np.uint64),
        way=np.zeros(tables.cells + 1, np.int64),
    )


@inlined
def _enter(search, node, shadow, filled):
    """Add a node to the tree."""
    store(search.shadow, node, shadow)
    search.filled[node] = filled
    search.visits[node] = 0
    search.rewards[node] = 0
    search.children[node] = _UNKNOWN
    search.tried[node] = 0


@inlined
def _make_children(search, tables, node, used):
    """Make room for the children of a node, if there is enough.

    Returns:
        Number of nodes that are used afterwards, or would be needed.
    """
    number = legal_moves(tables, load(search.shadow, node), search.moves, 0)
    if used + number > search.filled.size:
        return used + number
    search.children[node] = number
    search.first[node] = used
    for block in range(tables.area.size):
        places = load(search.moves, block)
        while not is_empty(places):
            search.move[used] = block * tables.cells + lowest(places)
            search.visits[used] = 0
            used += 1
            places = without_lowest(places)
    return used


@inlined
def _try_child(search, tables, node, generator):
    """Add a uniformly drawn child that is not in the tree yet; return it."""
    child = search.first[node]
    index = below(generator, search.children[node] - search.tried[node])
    while True:
        if search.visits[child] == 0:
            if index == 0:
                break
            index -= 1
        child += 1
    move = search.move[child]
    shadow = load(search.shadow, node) | load(tables.shadow, move)
    _enter(search, child, shadow, search.filled[node] + tables.area[move // tables.cells])
    search.tried[node] += 1
    return child


@inlined
def _bound(search, tables, node, child):
    """The upper confidence bound of a child: float64."""
    visits = search.visits[child]
    mean = search.rewards[child] / (visits * tables.target)
    return mean + search.exploration * np.sqrt(search.logarithm[search.visits[node]] / visits)


@inlined
def _select_child(search, tables, node, generator):
    """A child of highest upper confidence bound, uniformly among equals; all have visits."""
    first, end = search.first[node], search.first[node] + search.children[node]
    best, ties, chosen = -1.0, 0, first
    for child in range(first, end):
        bound = _bound(search, tables, node, child)
        if bound > best:
            best, ties, chosen = bound, 0, child
        ties += bound == best
    index = below(generator, ties)
    while index > 0:
        chosen += 1
        index -= _bound(search, tables, node, chosen) == best
    return chosen


@inlined
def _roll_out(search, tables, node, generator):
    """Make uniformly drawn legal placements until none is left.

    Returns:
        (filled cells at the end, number of placements)
    """
    shadow, filled, steps = load(search.shadow, node), np.int64(search.filled[node]), 0
    while True:
        children = legal_moves(tables, shadow, search.moves, 0)
        if children == 0:
            return filled, steps
        move = move_number(tables, search.moves, below(generator, children))
        shadow = shadow | load(tables.shadow, move)
        filled += tables.area[move // tables.cells]
        steps += 1


@inlined
def _iterate(search, tables, used, generator):
    """One iteration: select, expand, roll out, and add the reward along the path.

    Returns:
        (number of used nodes, larger than the room if that is too small; states evaluated)
    """
    node, length, evaluated = 0, 1, 0
    search.way[0] = 0
    while True:
        if search.children[node] == _UNKNOWN:
            used = _make_children(search, tables, node, used)
            if used > search.filled.size:
                return used, evaluated
        if search.children[node] == 0:
            break
        is_new = search.tried[node] < search.children[node]
        if is_new:
            node = _try_child(search, tables, node, generator)
        else:
            node = _select_child(search, tables, node, generator)
        search.way[length] = node
        length += 1
        if is_new:
            evaluated = 1
            break
    reward, steps = _roll_out(search, tables, node, generator)
    for index in range(length):
        search.visits[search.way[index]] += 1
        search.rewards[search.way[index]] += reward
    return used, evaluated + steps


@inlined
def _most_visited(search, generator):
    """The move of the root's most visited child, uniformly among equals."""
    first, end = search.first[0], search.first[0] + search.children[0]
    most, ties = 0, 0
    for child in range(first, end):
        if search.visits[child] > most:
            most, ties = search.visits[child], 0
        ties += search.visits[child] == most
    index = below(generator, ties)
    for child in range(first, end):
        index -= search.visits[child] == most
        if index < 0:
            return search.move[child]
    return search.move[first]


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Search and place, until the region is filled or no legal placement is left.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """
    length = 0
    cost = 0
    while filled < tables.target:
        if legal_moves(tables, shadow, search.moves, 0) == 0:
            return STUCK, length, cost
        _enter(search, 0, shadow, filled)
        used = 1
        for _ in range(search.iterations):
            if cancel[0] != 0:
                return CANCELLED, length, cost
            used, evaluated = _iterate(search, tables, used, generator)
            if used > search.filled.size:
                return OUT_OF_MEMORY, length, cost
            cost += evaluated
        move = np.int64(_most_visited(search, generator))
        path[length] = move
        length += 1
        shadow = shadow | load(tables.shadow, move)
        filled += tables.area[move // tables.cells]
    return COMPLETE, length, cost
