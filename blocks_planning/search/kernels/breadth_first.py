"""Breadth-first lookahead, compiled.

Nothing is stored but one path: the nodes of each level are visited in the order in which a
breadth-first search generates them by walking down to that level once more, which costs little
as a level is many times larger than the one before. The last level is only counted, except
where one of its nodes can be the choice or tie with it.

Which node wins matters only through its first placement. So the tree nodes that are the best so
far are kept as ``votes``: their number by depth and by first placement, int64 (depth, firsts),
in which the uniform draw over tree nodes in the order of generation is a walk.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.geometry import MAX_SIDE
from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import is_empty, load, lowest, store, without_lowest
from blocks_planning.board.kernels.moves import Tables, has_move, legal_moves
from blocks_planning.search.kernels.outcomes import CANCELLED, COMPLETE, STUCK
from blocks_planning.search.kernels.random_placement import move_number
from blocks_planning.search.kernels.randomness import below

_DEAD_END = -1
_COMPLETE = 1 << 30
_CANCELLED = -2
_NOBODY = -3


class BreadthFirst(NamedTuple):
    """Settings and memory of a search. Level 0 is the root; ``mask`` as in the tables."""

    depth: int
    shadow: np.ndarray  # mask (depth + 1,): of the node on the path at each level
    moves: np.ndarray  # mask ((depth + 1) * blocks,): moves still to be taken at each level
    filled: np.ndarray  # int64 (depth + 1,) [cells]
    block: np.ndarray  # int64 (depth + 1,): the block whose moves are being taken
    path: np.ndarray  # int64 (depth + 1,): the move taken at each level
    votes: np.ndarray  # int64 (depth, most children): best tree nodes by depth and first
    best: np.ndarray  # int64 (1,): their value
    firsts: np.ndarray  # int64 (1,): number of first placements


def make_search(tables: Tables, depth: int) -> BreadthFirst:
    """A search of some depth."""
    mask_shape = tables.legal.shape[1:]
    blocks, levels = len(tables.area), depth + 1
    return BreadthFirst(
        depth=depth,
        shadow=np.zeros((levels, *mask_shape), np.uint64),
        moves=np.zeros((levels * blocks, *mask_shape), np.uint64),
        filled=np.zeros(levels, np.int64),
        block=np.zeros(levels, np.int64),
        path=np.zeros(levels, np.int64),
        votes=np.zeros((depth, blocks * MAX_SIDE), np.int64),
        best=np.zeros(1, np.int64),
        firsts=np.zeros(1, np.int64),
    )


@inlined
def _vote(search, value, depth, first):
    """Count a tree node if none seen so far is better."""
    if value > search.best[0]:
        search.best[0] = value
        for level in range(search.depth):
            for other in range(search.firsts[0]):
                search.votes[level, other] = 0
    if value == search.best[0]:
        search.votes[depth - 1, first] += 1


@inlined
def _vote_for_last_level(search, tables, shadow, filled, first):
    """Judge the children of a node of level ``depth - 1``, as far as one can be the choice."""
    depth, blocks = search.depth, tables.area.size
    child = 0
    for block in range(blocks):
        reached = filled + tables.area[block]
        places = load(search.moves, (depth - 1) * blocks + block)
        can_win = reached == tables.target or reached >= search.best[0]
        while not is_empty(places):
            if can_win:
                value = _COMPLETE
                if reached != tables.target:
                    move = block * tables.cells + lowest(places)
                    alive = has_move(tables, shadow | load(tables.shadow, move))
                    value = reached if alive else _DEAD_END
                _vote(search, value, depth, child if depth == 1 else first)
            child += 1
            places = without_lowest(places)


@inlined
def _take_up(search, tables, level, shadow, filled, first):
    """Expand a node of some level: count its children, judge it, judge the last level.

    Returns:
        The number of children, or -1 if the node is complete.
    """
    if filled == tables.target:
        return -1
    children = legal_moves(tables, shadow, search.moves, level * tables.area.size)
    if level == 0:
        search.firsts[0] = children
    else:
        _vote(search, filled if children > 0 else _DEAD_END, level, first)
    if level == search.depth - 1:
        _vote_for_last_level(search, tables, shadow, filled, first)
    return children


@inlined
def _expand_level(search, tables, level, shadow, filled, cancel):
    """Take up every node of a level, 1 or more, in the order of generation.

    Returns:
        (children generated, 0), and -1 in the second place if a node was complete and the search
        stopped there: its path is then in ``search.path[:level]``; or -2 if cancelled.
    """
    blocks = tables.area.size
    generated = 0
    first = -1
    top = 0
    store(search.shadow, 0, shadow)
    search.filled[0] = filled
    search.block[0] = 0
    legal_moves(tables, shadow, search.moves, 0)
    while top >= 0:
        block = search.block[top]
        if block == blocks:
            top -= 1
            continue
        row = top * blocks + block
        places = load(search.moves, row)
        if is_empty(places):
            search.block[top] = block + 1
            continue
        store(search.moves, row, without_lowest(places))
        move = block * tables.cells + lowest(places)
        search.path[top] = move
        if top == 0:
            first += 1
        child = load(search.shadow, top) | load(tables.shadow, move)
        child_filled = search.filled[top] + tables.area[block]
        if top + 1 == level:
            children = _take_up(search, tables, level, child, child_filled, first)
            if children < 0:
                return generated, -1
            generated += children
            continue
        if cancel[0] != 0:
            return generated, _CANCELLED
        top += 1
        store(search.shadow, top, child)
        search.filled[top] = child_filled
        search.block[top] = 0
        legal_moves(tables, child, search.moves, top * blocks)
    return generated, 0


@inlined
def _look_ahead(search, tables, shadow, filled, cancel):
    """Search once from a state.

    Returns:
        (states evaluated, ending). The ending is 0 if the votes have to decide; n > 0 if a state
        taken up was complete, at the end of ``search.path[:n]``; -2 if cancelled.
    """
    search.best[0] = _NOBODY
    cost = _take_up(search, tables, 0, shadow, filled, 0)
    for level in range(1, search.depth):
        generated, ending = _expand_level(search, tables, level, shadow, filled, cancel)
        cost += generated
        if ending == -1:
            return cost, level
        if ending == _CANCELLED:
            return cost, _CANCELLED
        if generated == 0:
            break
    return cost, 0


@inlined
def _elect(search, tables, shadow, generator):
    """The first placement, as a move, of a uniformly drawn tree node among the best."""
    total = 0
    for level in range(search.depth):
        for first in range(search.firsts[0]):
            total += search.votes[level, first]
    index = below(generator, total)
    for level in range(search.depth):
        for first in range(search.firsts[0]):
            index -= search.votes[level, first]
            if index < 0:
                legal_moves(tables, shadow, search.moves, 0)
                return move_number(tables, search.moves, first)
    return -1


@inlined
def decide(search, tables, shadow, filled, generator, cancel):
    """Look ahead from a state, and choose.

    Returns:
        (states evaluated, ending, move). The ending is as in ``_look_ahead``; the move is chosen
        if that is 0 and there is any, else it is -1.
    """
    evaluated, ending = _look_ahead(search, tables, shadow, filled, cancel)
    move = -1
    if ending == 0 and evaluated > 0:
        move = _elect(search, tables, shadow, generator)
    return evaluated, ending, move


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Look ahead and place, until the region is filled or nothing legal is left.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """
    length = 0
    cost = 0
    while filled < tables.target:
        evaluated, ending, move = decide(search, tables, shadow, filled, generator, cancel)
        cost += evaluated
        if ending == _CANCELLED:
            return CANCELLED, length, cost
        if ending > 0:
            for index in range(ending):
                path[length + index] = search.path[index]
            return COMPLETE, length + ending, cost
        if move < 0:
            return STUCK, length, cost
        path[length] = move
        length += 1
        shadow = shadow | load(tables.shadow, move)
        filled += tables.area[move // tables.cells]
    return COMPLETE, length, cost


@kernel
def choices_from(search, tables, state, filled, cancel, moves, weights):
    """Look ahead from a state, and write which first placements can be chosen, how likely.

    Args:
        search: of any depth.
        tables: of the region.
        state: the shadow of the state, mask (1,).
        filled: of the state [cells], less than the target.
        cancel: uint8 (1,).
        moves: where the placements are written, int64 (cells * blocks,).
        weights: where the number of best tree nodes behind each is written, of the same size.

    Returns:
        (states evaluated, ending, number of placements written). The ending is n > 0 if a
        complete state was taken up, at the end of ``search.path[:n]``, which is then built whole;
        0 if not; -1 if cancelled.
    """
    shadow = load(state, 0)
    evaluated, ending = _look_ahead(search, tables, shadow, filled, cancel)
    if ending == _CANCELLED:
        return evaluated, -1, 0
    if ending > 0:
        return evaluated, ending, 0
    legal_moves(tables, shadow, search.moves, 0)
    written = 0
    for first in range(search.firsts[0]):
        weight = 0
        for level in range(search.depth):
            weight += search.votes[level, first]
        if weight > 0:
            moves[written] = move_number(tables, search.moves, first)
            weights[written] = weight
            written += 1
    return evaluated, 0, written


@kernel
def count_from(search, tables, state, cancel, counts):
    """Write the number of tree nodes at depths 1 to n, summed, to ``counts``, int64 (n,).

    Args:
        search: of depth n + 1, so that no level is judged as the last.
        tables: with a target that no state reaches, so that the tree is walked to its end.
        state: the shadow of the root, mask (1,).
        cancel: uint8 (1,).
        counts: where they are written.

    Returns:
        Whether it was finished, and not cancelled.
    """
    search.best[0] = _COMPLETE + 1  # nobody's vote counts
    shadow = load(state, 0)
    total = _take_up(search, tables, 0, shadow, 0, 0)
    counts[0] = total
    for level in range(1, counts.size):
        generated, ending = _expand_level(search, tables, level, shadow, 0, cancel)
        if ending == _CANCELLED:
            return False
        total += generated
        counts[level] = total
    return True
