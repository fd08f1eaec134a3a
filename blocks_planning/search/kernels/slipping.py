"""Chances of success where blocks slip: backward over the states, compiled.

Each pass goes through the states by falling number of filled cells, so that whatever follows
from a state is known before it. All probabilities of slipping are handled in one pass.
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
    """What a breadth-first search does in each state that it can come to.

    The entries of state i are ``moves`` and ``weights`` from ``begin[i]`` to ``end[i]``: first
    placements with weights, or, if ``is_path[i]``, the placements of a complete path.
    """

    wanted: np.ndarray  # uint8 (n,): whether the search can come to the state
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
    """The chance of success after an order for ``column``, an index of ``child``."""
    here, left, right = child[column], child[column - 1], child[column + 1]
    left = here if left < 0 else left
    right = here if right < 0 else right
    beside = values[left, k] + values[right, k]
    return (1.0 - slip) * values[here, k] + 0.5 * slip * beside


@kernel
def evaluate(space, order, start, slips, best, mean, cancel):
    """Write the chances of the best policy, and of legal placements at random.

    Args:
        space: with every state.
        order: the states by falling number of filled cells, int64 (n,); the complete state, if it
            can be reached, is not among them.
        start: where in the order to begin.
        slips: probabilities that a block slips, float64 (s,).
        best: chance of the best policy by state, float64 (n, s); that of the complete state is 1
            and all others are 0.
        mean: the same for random placement.
        cancel: uint8 (1,).

    Returns:
        How much of the order was done: all, or less if the flag was up.
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
    """Find where the block of a move can land; return its column as an index of ``child``."""
    legal_moves(space.possible, shadow, space.places, 0)
    block = move // space.tables.cells
    land(space, shadow, filled, block, False)
    return (move - block * space.tables.cells) // space.height + 1


@inlined
def _mark(plans, number):
    """Note that the search can come to a state."""
    if number > 0:
        plans.wanted[number] = 1


@inlined
def _mark_from(space, plans, index, slipping):
    """Note every state that the entries of state ``index`` can lead to."""
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
    """Look ahead, breadth first, in every state that the search can come to.

    Args:
        search: of any depth.
        space: with every state.
        order: the states by rising number of filled cells, int64 (n,), without the complete one.
        start: where in the order to begin.
        slipping: whether blocks can slip.
        plans: the first state is wanted; where the entries are written.
        written: number of entries written so far.
        cancel: uint8 (1,).

    Returns:
        (how much of the order was done, number of entries written); not all is done if the room
        for entries was used up or the flag was up.
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
    """The chances of a state in which one first placement is chosen by weight."""
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
    """The chances of a state from which a complete path is built until a block slips."""
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
    """Write the chances of breadth-first lookahead in every state that it can come to.

    Args:
        space: with every state.
        order: as in :func:`evaluate`.
        start: where in the order to begin.
        slips: probabilities that a block slips, float64 (s,).
        plans: what :func:`plan_ahead` wrote.
        values: float64 (n, s): that of the complete state is 1 and all others are 0.
        reaching: memory, float64 (s,).
        cancel: uint8 (1,).

    Returns:
        How much of the order was done: all, or less if the flag was up.
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
