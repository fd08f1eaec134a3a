"""Weighing candidates: their value, the best of them, and the settings that say so."""

from __future__ import annotations

import sys
from collections.abc import Sequence

from blocks_planning.board.geometry import Mask
from blocks_planning.search.randomness import Generator, mask_words
from blocks_planning.subgoals.decision import Candidate


def value_of(cells: int, planning_cost: int, lam: float) -> float:
    """V = r - lambda * c (paper, equation of the scoping planner) [cells]."""
    return max(cells - lam * planning_cost, -sys.float_info.max)  # a record has no infinity


def best(candidates: Sequence[Candidate], seed: int, built: Mask) -> int | None:
    """Index of a candidate of highest value, uniformly among equals; None if none has a value.

    The draw depends on nothing but the trial's seed and the state.
    """
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return None
    highest = max(values)
    ties = [index for index, candidate in enumerate(candidates) if candidate.value == highest]
    return ties[Generator([seed, *mask_words(built)]).below(len(ties))]
