"""Attempt after attempt, until one succeeds or the budget is reached. Compiled.

All searches share this loop: the type of the search, which contains its settings and its memory,
selects the attempt that is compiled into it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba.extending import overload

from blocks_planning.board.kernels.compiling import inlined
from blocks_planning.search.kernels import (
    beam,
    best_first,
    breadth_first,
    lookahead,
    random_placement,
    tree_search,
)
from blocks_planning.search.kernels.outcomes import CANCELLED, STUCK
from blocks_planning.search.kernels.randomness import key_of, seed

_ATTEMPTS = {
    random_placement.RandomPlacement: random_placement.attempt,
    lookahead.BreadthFirst: breadth_first.attempt,
    best_first.BestFirst: best_first.attempt,
    beam.Beam: beam.attempt,
    tree_search.TreeSearch: tree_search.attempt,
}
_FORGET = {lookahead.BreadthFirst: breadth_first.forget}
"""How searches that keep something of a problem drop it before another one."""


class Conditions(NamedTuple):
    """The conditions of attempts, and their memory."""

    seed_words: np.ndarray  # uint64 (9,): trial seed, state, region
    budget: int  # [states]
    generator: np.ndarray  # uint64 (1,): memory
    cancel: np.ndarray  # uint8 (1,): other than 0 to cancel
    path: np.ndarray  # int64 (cells,): where the moves of the last attempt are written


def attempt(search, tables, shadow, filled, generator, cancel, path):
    """One attempt of any search.

    Returns:
        (outcome, number of moves written to ``path``, states evaluated)
    """


@overload(attempt)
def _attempt(search, tables, shadow, filled, generator, cancel, path):
    chosen = _ATTEMPTS[search.instance_class]

    def run(search, tables, shadow, filled, generator, cancel, path):
        return chosen(search, tables, shadow, filled, generator, cancel, path)

    return run


def begin(search):
    """Prepare any search for another problem."""


@overload(begin)
def _begin(search):
    if search.instance_class not in _FORGET:

        def nothing(search):
            """Such a search keeps nothing."""

        return nothing
    forget = _FORGET[search.instance_class]

    def run(search):
        forget(search)

    return run


@inlined
def run_attempts(search, tables, shadow, filled, conditions):
    """Make attempts until one is complete or cancelled, or the budget is reached.

    There is at least one attempt, and at most as many as the budget has states, so that attempts
    without cost end too.

    Args:
        search: the search; its type selects the attempt.
        tables: of the region.
        shadow: of the state, a mask.
        filled: of the state [cells].
        conditions: see :class:`Conditions`.

    Returns:
        (outcome of the last attempt, its number of moves, its states evaluated, states evaluated
        in all attempts, number of attempts)
    """
    begin(search)
    key = key_of(conditions.seed_words)
    total = 0
    number = 0
    while True:
        if conditions.cancel[0] != 0:
            return CANCELLED, 0, 0, total, number
        seed(conditions.generator, key, number)
        outcome, length, cost = attempt(
            search,
            tables,
            shadow,
            filled,
            conditions.generator,
            conditions.cancel,
            conditions.path,
        )
        total += cost
        number += 1
        if outcome != STUCK or total >= conditions.budget or number >= conditions.budget:
            return outcome, length, cost, total, number
