"""Breadth-first lookahead: the choice among the best tree nodes, and attempts. Compiled.

The traversal of the tree and the evaluation of its nodes are in :mod:`.lookahead`.
"""

from __future__ import annotations

from blocks_planning.board.kernels.compiling import inlined, kernel
from blocks_planning.board.kernels.masks import is_empty, load, lowest, without_lowest
from blocks_planning.board.kernels.moves import legal_moves
from blocks_planning.search.kernels.decisions import (
    finish,
    forget_decisions,
    known,
    write_head,
)
from blocks_planning.search.kernels.lookahead import (
    BROKEN_OFF,
    COMPLETE_VALUE,
    expand_level,
    look_ahead,
    take_up,
)
from blocks_planning.search.kernels.outcomes import CANCELLED, COMPLETE, STUCK
from blocks_planning.search.kernels.random_placement import move_number
from blocks_planning.search.kernels.randomness import below


@inlined
def _write_choices(search, tables, shadow, place):
    """Write the best tree nodes by level and first placement; return the place after them."""
    decisions = search.decisions
    legal_moves(tables, shadow, search.moves, 0)
    first = 0
    for block in range(tables.area.size):
        places = load(search.moves, block)
        while not is_empty(places):
            decisions.move_of[first] = block * tables.cells + lowest(places)
            first += 1
            places = without_lowest(places)
    total = 0
    for level in range(search.depth):
        for first in range(search.firsts[0]):
            if search.votes[level, first] > 0:
                total += search.votes[level, first]
                decisions.move[place] = decisions.move_of[first]
                decisions.below[place] = total
                place += 1
    return place


@inlined
def _look(search, tables, shadow, filled, cancel):
    """Look ahead from a state.

    Returns:
        (number of the decision, or BROKEN_OFF if cancelled; states evaluated)
    """
    decisions = search.decisions
    evaluated, ending = look_ahead(search, tables, shadow, filled, cancel)
    if ending == BROKEN_OFF:
        return BROKEN_OFF, evaluated
    number, place = write_head(decisions, shadow, filled, evaluated, ending)
    if ending > 0:
        for index in range(ending):
            decisions.move[place] = search.path[index]
            place += 1
    elif evaluated > 0:
        place = _write_choices(search, tables, shadow, place)
    finish(decisions, number, place, search.votes.size + search.depth)
    return number, evaluated


@inlined
def _elect(decisions, number, generator):
    """The first placement, as a move, of a uniformly drawn tree node among the best; -1 if none."""
    place, end = decisions.first[number], decisions.first[number + 1]
    if place == end:
        return -1
    index = below(generator, decisions.below[end - 1])
    while index >= decisions.below[place]:
        place += 1
    return decisions.move[place]


@inlined
def forget(search):
    """Drop what was found in another problem."""
    forget_decisions(search.decisions)


@kernel
def attempt(search, tables, shadow, filled, generator, cancel, path):
    """Look ahead and place, until the region is filled or no legal placement is left.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """
    decisions = search.decisions
    length = 0
    cost = 0
    while filled < tables.target:
        number = known(decisions, shadow, filled)
        if number >= 0:
            evaluated = decisions.evaluated[number]
        else:
            number, evaluated = _look(search, tables, shadow, filled, cancel)
        cost += evaluated
        if number < 0:
            return CANCELLED, length, cost
        ending = decisions.ending[number]
        if ending > 0:
            place = decisions.first[number]
            for index in range(ending):
                path[length + index] = decisions.move[place + index]
            return COMPLETE, length + ending, cost
        move = _elect(decisions, number, generator)
        if move < 0:
            return STUCK, length, cost
        path[length] = move
        length += 1
        shadow = shadow | load(tables.shadow, move)
        filled += tables.area[move // tables.cells]
    return COMPLETE, length, cost


@kernel
def choices_from(search, tables, state, filled, cancel, moves, weights):
    """Look ahead from a state, and write the possible first placements with their weights.

    Args:
        search: of any depth.
        tables: of the region.
        state: the shadow of the state, mask (1,).
        filled: of the state [cells], less than the target.
        cancel: uint8 (1,).
        moves: where the placements are written, int64 (cells * blocks,).
        weights: where the number of best tree nodes behind each one is written, same size.

    Returns:
        (states evaluated, ending, number of placements written). The ending is n > 0 if a complete
        state was expanded, at the end of ``search.path[:n]``, which is then executed whole; 0 if
        not; -1 if cancelled.
    """
    shadow = load(state, 0)
    evaluated, ending = look_ahead(search, tables, shadow, filled, cancel)
    if ending == BROKEN_OFF:
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
        search: of depth n + 1, so that no level is treated as the last.
        tables: with a target that no state reaches, so that the whole tree is traversed.
        state: the shadow of the root, mask (1,).
        cancel: uint8 (1,).
        counts: where they are written.

    Returns:
        Whether the count was finished and not cancelled.
    """
    search.best[0] = COMPLETE_VALUE + 1  # no vote counts
    shadow = load(state, 0)
    total = take_up(search, tables, 0, shadow, 0, 0)
    counts[0] = total
    for level in range(1, counts.size):
        generated, ending = expand_level(search, tables, level, shadow, 0, cancel)
        if ending == BROKEN_OFF:
            return False
        total += generated
        counts[level] = total
    return True
