"""The tree of breadth-first lookahead, and its best nodes. Compiled.

Only one path is stored. The nodes of each level are visited in the order in which a breadth-first
search generates them, by walking down to that level again. This costs little, because each level is
many times larger than the previous one. The last level is only counted, except where one of its
nodes can be the best or tie with it.

Only the first placement of the chosen node matters. So the best tree nodes so far are stored as
``votes``: their number by depth and by first placement, int64 (depth, firsts). A uniform draw over
tree nodes in the order of generation goes through these numbers.

A state without a legal placement (a dead end) can rank below all others. To detect dead ends
on the last level, the search looks one level further, which is not counted.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board.geometry import MAX_SIDE
from blocks_planning.board.kernels.compiling import inlined
from blocks_planning.board.kernels.masks import (
    count,
    is_empty,
    load,
    lowest,
    store,
    without_lowest,
)
from blocks_planning.board.kernels.moves import Tables, has_move, legal_moves
from blocks_planning.search.kernels.decisions import Decisions, make_decisions

COMPLETE_VALUE = 1 << 30
"""The value of a complete state: above every number of filled cells."""
BROKEN_OFF = -2
"""An ending: the cancel flag was set."""
_TAKEN_UP_COMPLETE = -1
_DEAD_END = -1
_NOBODY = -3


class BreadthFirst(NamedTuple):
    """Settings and memory of a search. Level 0 is the root; ``mask`` as in the tables."""

    depth: int
    dead_ends_last: bool  # a state without a legal placement ranks below all others
    shadow: np.ndarray  # mask (depth + 1,): of the node on the path at each level
    moves: np.ndarray  # mask ((depth + 1) * blocks,): remaining moves at each level
    filled: np.ndarray  # int64 (depth + 1,) [cells]
    block: np.ndarray  # int64 (depth + 1,): the block whose moves are being taken
    path: np.ndarray  # int64 (depth + 1,): the move taken at each level
    votes: np.ndarray  # int64 (depth, most children): best tree nodes by depth and first
    best: np.ndarray  # int64 (1,): their value
    firsts: np.ndarray  # int64 (1,): number of first placements
    decisions: Decisions  # of the problem


def make_search(tables: Tables, depth: int, dead_ends_last: bool = True) -> BreadthFirst:
    """A search of some depth."""
    mask_shape = tables.legal.shape[1:]
    blocks, levels = len(tables.area), depth + 1
    return BreadthFirst(
        depth=depth,
        dead_ends_last=dead_ends_last,
        shadow=np.zeros((levels, *mask_shape), np.uint64),
        moves=np.zeros((levels * blocks, *mask_shape), np.uint64),
        filled=np.zeros(levels, np.int64),
        block=np.zeros(levels, np.int64),
        path=np.zeros(levels, np.int64),
        votes=np.zeros((depth, blocks * MAX_SIDE), np.int64),
        best=np.zeros(1, np.int64),
        firsts=np.zeros(1, np.int64),
        decisions=make_decisions(mask_shape, blocks * MAX_SIDE, depth),
    )


@inlined
def _vote(search, value, depth, first, number):
    """Count ``number`` tree nodes of a value, if no node so far is better."""
    if value > search.best[0]:
        search.best[0] = value
        for level in range(search.depth):
            for other in range(search.firsts[0]):
                search.votes[level, other] = 0
    if value == search.best[0]:
        search.votes[depth - 1, first] += number


@inlined
def _vote_for_last_level(search, tables, shadow, filled, first):
    """Evaluate the children of a node of level ``depth - 1``, if one of them can be the best."""
    depth, blocks = search.depth, tables.area.size
    child = 0
    for block in range(blocks):
        places = load(search.moves, (depth - 1) * blocks + block)
        reached = filled + tables.area[block]
        is_complete = reached == tables.target
        children = count(places)
        if children == 0 or not (is_complete or reached >= search.best[0]):
            child += children
            continue
        value = COMPLETE_VALUE if is_complete else reached
        if depth > 1 and (is_complete or not search.dead_ends_last):
            _vote(search, value, depth, first, children)
            continue
        while not is_empty(places):
            if search.dead_ends_last and not is_complete:
                move = block * tables.cells + lowest(places)
                alive = has_move(tables, shadow | load(tables.shadow, move))
                value = reached if alive else _DEAD_END
            _vote(search, value, depth, child if depth == 1 else first, 1)
            child += 1
            places = without_lowest(places)


@inlined
def take_up(search, tables, level, shadow, filled, first):
    """Expand a node: count its children, evaluate it, and evaluate children on the last level.

    Returns:
        The number of children, or -1 if the node is complete.
    """
    if filled == tables.target:
        return _TAKEN_UP_COMPLETE
    children = legal_moves(tables, shadow, search.moves, level * tables.area.size)
    if level == 0:
        search.firsts[0] = children
    else:
        is_last = search.dead_ends_last and children == 0
        _vote(search, _DEAD_END if is_last else filled, level, first, 1)
    if level == search.depth - 1:
        _vote_for_last_level(search, tables, shadow, filled, first)
    return children


@inlined
def expand_level(search, tables, level, shadow, filled, cancel):
    """Expand every node of a level, 1 or more, in the order of generation.

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
            children = take_up(search, tables, level, child, child_filled, first)
            if children < 0:
                return generated, _TAKEN_UP_COMPLETE
            generated += children
            continue
        if cancel[0] != 0:
            return generated, BROKEN_OFF
        top += 1
        store(search.shadow, top, child)
        search.filled[top] = child_filled
        search.block[top] = 0
        legal_moves(tables, child, search.moves, top * blocks)
    return generated, 0


@inlined
def look_ahead(search, tables, shadow, filled, cancel):
    """Search once from a state.

    Returns:
        (states evaluated, ending). The ending is 0 if the votes decide; n > 0 if an
        expanded state was complete, at the end of ``search.path[:n]``; -2 if cancelled.
    """
    search.best[0] = _NOBODY
    cost = take_up(search, tables, 0, shadow, filled, 0)
    for level in range(1, search.depth):
        generated, ending = expand_level(search, tables, level, shadow, filled, cancel)
        cost += generated
        if ending == _TAKEN_UP_COMPLETE:
            return cost, level
        if ending == BROKEN_OFF:
            return cost, BROKEN_OFF
        if generated == 0:
            break
    return cost, 0
