"""Probabilities of success where blocks slip: a backward pass over the states. Compiled.

Each pass goes through the states by falling number of filled cells, so that all successors of a
state are known before it. One pass handles all probabilities of slipping.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import load, store
from blocks_planning.board.kernels.moves import legal_moves
from blocks_planning.search.kernels import breadth_first
from blocks_planning.search.kernels.states import land

_CHECK_EVERY = 256


class Plans(NamedTuple):
    """The choices of a breadth-first search in each state that it can reach.

    The entries of state i are ``moves`` and ``weights`` from ``begin[i]`` to ``end[i]``: first
    placements with weights, or, if ``is_path[i]``, the placements of a complete path.
    """

    wanted: np.ndarray  # uint8 (n,): whether the search can reach the state
    is_path: np.ndarray  # uint8 (n,)
    begin: np.ndarray  # int64 (n,)
    end: np.ndarray  # int64 (n,)
    moves: np.ndarray  # int64 (m,)
    weights: np.ndarray  # int64 (m,)
    state: np.ndarray  # mask (1,): memory
    move: np.ndarray  # int64 (most,): memory
    weight: np.ndarray  # int64 (most,): memory


@inlined
def _worth(values, child, column, slip, k):
    """The probability of success after an order for ``column``, an index of ``child``."""
    here, left, right = child[column], child[column - 1], child[column + 1]
    left = here if left < 0 else left
    right = here if right < 0 else right
    beside = values[left, k] + values[right, k]
    return (1.0 - slip) * values[here, k] + 0.5 * slip * beside


@kernel
def evaluate(space, order, start, slips, best, mean, cancel):
    """Write the probabilities of success of the best policy, and of random legal placements.

    Args:
        space: with every state.
        order: the states by falling number of filled cells, int64 (n,); the complete state, if it
            can be reached, is not among them.
        start: index in the order at which to begin.
        slips: probabilities that a block slips, float64 (s,).
        best: probability of the best policy by state, float64 (n, s); initially 1 for the complete
            state and 0 for all others.
        mean: the same for random placement.
        cancel: uint8 (1,).

    Returns:
        Index in the order after the last processed state; less than n if the flag was set.
    """
    for place in range(start, order.size):
        if place % _CHECK_EVERY == 0 and cancel[0] != 0:
            return place
        index = order[place]
        shadow, filled = load(space.shadow, index), np.int64(space.filled[index])
        legal_moves(space.possible, shadow, space.places, 0)
        ways = 0
        for block in range(space.tables.area.size):
            found = land(space, shadow, filled, block, False)
            ways += found
            if found == 0:
                continue
            for column in range(1, space.child.size - 1):
                if space.legal[column] == 0:
                    continue
                for k in range(slips.size):
                    worth = _worth(best, space.child, column, slips[k], k)
                    best[index, k] = max(best[index, k], worth)
                    mean[index, k] += _worth(mean, space.child, column, slips[k], k)
        for k in range(slips.size):
            mean[index, k] /= max(ways, 1)
    return order.size


@inlined
def _take(space, shadow, filled, move):
    """Find where the block of a move can land; return its column, an index of ``child``."""
    legal_moves(space.possible, shadow, space.places, 0)
    block = move // space.tables.cells
    land(space, shadow, filled, block, False)
    return (move - block * space.tables.cells) // space.height + 1


@inlined
def _mark(plans, number):
    """Mark a state as reachable by the search."""
    if number > 0:
        plans.wanted[number] = 1


@inlined
def _mark_from(space, plans, index, slipping):
    """Mark every state to which the entries of state ``index`` can lead."""
    shadow, filled = load(space.shadow, index), np.int64(space.filled[index])
    for entry in range(plans.begin[index], plans.end[index]):
        move = plans.moves[entry]
        column = _take(space, shadow, filled, move)
        here = space.child[column]
        if slipping:
            _mark(plans, space.child[column - 1])
            _mark(plans, space.child[column + 1])
        if plans.is_path[index] != 0:
            shadow, filled = load(space.shadow, here), np.int64(space.filled[here])
        else:
            _mark(plans, here)


@kernel
def plan_ahead(search, space, order, start, slipping, plans, written, cancel):
    """Look ahead, breadth first, in every state that the search can reach.

    Args:
        search: of any depth.
        space: with every state.
        order: the states by rising number of filled cells, int64 (n,), without the complete one.
        start: index in the order at which to begin.
        slipping: whether blocks can slip.
        plans: where the entries are written; the first state is marked as wanted.
        written: number of entries written so far.
        cancel: uint8 (1,).

    Returns:
        (index in the order after the last processed state, number of entries written); the index is
        less than n if the room for entries was used up or the flag was set.
    """
    for place in range(start, order.size):
        index = order[place]
        if plans.wanted[index] == 0:
            continue
        if cancel[0] != 0 or written + plans.move.size > plans.moves.size:
            return place, written
        store(plans.state, 0, load(space.shadow, index))
        _, ending, number = breadth_first.choices_from(
            search,
            space.tables,
            plans.state,
            np.int64(space.filled[index]),
            cancel,
            plans.move,
            plans.weight,
        )
        if ending < 0:
            return place, written
        plans.begin[index] = written
        if ending > 0:
            plans.is_path[index] = 1
            number = ending
        for entry in range(number):
            plans.moves[written] = search.path[entry] if ending > 0 else plans.move[entry]
            plans.weights[written] = plans.weight[entry]
            written += 1
        plans.end[index] = written
        _mark_from(space, plans, index, slipping)
    return order.size, written


@inlined
def _choose_first(space, plans, index, slips, values):
    """The probabilities of a state in which one first placement is chosen by weight."""
    shadow, filled = load(space.shadow, index), np.int64(space.filled[index])
    total = 0
    for entry in range(plans.begin[index], plans.end[index]):
        total += plans.weights[entry]
    for entry in range(plans.begin[index], plans.end[index]):
        column = _take(space, shadow, filled, plans.moves[entry])
        share = plans.weights[entry] / total
        for k in range(slips.size):
            values[index, k] += share * _worth(values, space.child, column, slips[k], k)


@inlined
def _follow_path(space, plans, index, slips, values, reaching):
    """The probabilities of a state from which a complete path is executed until a block slips."""
    shadow, filled = load(space.shadow, index), np.int64(space.filled[index])
    for k in range(slips.size):
        reaching[k] = 1.0
    for entry in range(plans.begin[index], plans.end[index]):
        column = _take(space, shadow, filled, plans.moves[entry])
        for k in range(slips.size):
            kept = 1.0
            for beside in (space.child[column - 1], space.child[column + 1]):
                if beside >= 0:
                    kept -= 0.5 * slips[k]
                    values[index, k] += reaching[k] * 0.5 * slips[k] * values[beside, k]
            reaching[k] *= kept
        here = space.child[column]
        shadow, filled = load(space.shadow, here), np.int64(space.filled[here])
    for k in range(slips.size):
        values[index, k] += reaching[k]


@kernel
def follow_plans(space, order, start, slips, plans, values, reaching, cancel):
    """Write the probabilities of breadth-first lookahead in every state that it can reach.

    Args:
        space: with every state.
        order: as in :func:`evaluate`.
        start: index in the order at which to begin.
        slips: probabilities that a block slips, float64 (s,).
        plans: from :func:`plan_ahead`.
        values: float64 (n, s), initially 1 for the complete state and 0 for all others.
        reaching: memory, float64 (s,).
        cancel: uint8 (1,).

    Returns:
        Index in the order after the last processed state; less than n if the flag was set.
    """
    for place in range(start, order.size):
        if place % _CHECK_EVERY == 0 and cancel[0] != 0:
            return place
        index = order[place]
        if plans.wanted[index] == 0:
            continue
        if plans.is_path[index] != 0:
            _follow_path(space, plans, index, slips, values, reaching)
        else:
            _choose_first(space, plans, index, slips, values)
    return order.size
