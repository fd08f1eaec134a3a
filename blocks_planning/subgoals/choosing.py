"""Choosing between candidates: the best, or each with a probability."""

from __future__ import annotations

import math
from collections.abc import Sequence

from blocks_planning.board.geometry import Mask
from blocks_planning.search.exponentials import exponential
from blocks_planning.search.randomness import Generator, mask_words
from blocks_planning.subgoals.decision import Candidate

CHOICES = ('best', 'softmax')
AGGREGATES = ('best', 'softmax')
_FRACTIONS = 1 << 53


def best(candidates: Sequence[Candidate], seed: int, built: Mask) -> int | None:
    """Index of a candidate of highest value, uniformly among equals; None if none has a value.

    The draw depends only on the seed of the trial and the state.
    """
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return None
    highest = max(values)
    ties = [index for index, candidate in enumerate(candidates) if candidate.value == highest]
    if len(ties) == 1:
        return ties[0]
    return ties[Generator([seed, *mask_words(built)]).below(len(ties))]


def first_solved(candidates: Sequence[Candidate]) -> int | None:
    """Index of the first solved candidate; None if there is none."""
    return next((i for i, candidate in enumerate(candidates) if candidate.is_solved), None)


def probabilities(
    candidates: Sequence[Candidate], temperature: float, aggregate: str
) -> list[float]:
    """The probability of each candidate to be chosen.

    A first subgoal has probability exp(G / T) divided by the sum of exp(G / T) over all first
    subgoals. With ``aggregate`` 'best', G is the highest value of the candidates that begin with
    it, and those of that value share the probability. With 'softmax', G = T ln(sum of exp(V / T)),
    and each candidate has the share exp(V / T). In both cases the probability of a first subgoal is
    the sum over the candidates that begin with it.

    Args:
        candidates: of a decision.
        temperature: T [cells], above 0.
        aggregate: a word of ``AGGREGATES``.

    Returns:
        One for each candidate; 0 for one without a value. They add up to 1 unless no candidate
        has a value.
    """
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return [0.0] * len(candidates)
    highest = max(values)
    share = _shares_of_best(candidates) if aggregate == 'best' else [1.0] * len(candidates)
    weights = [
        0.0 if one.value is None else part * exponential((one.value - highest) / temperature)
        for one, part in zip(candidates, share, strict=True)
    ]
    total = math.fsum(weights)
    return [weight / total for weight in weights]


def _shares_of_best(candidates: Sequence[Candidate]) -> list[float]:
    """1 / n for each of the n best candidates with the same first region, 0 for the others."""
    values: dict[object, list[float]] = {}
    for candidate in candidates:
        if candidate.value is not None:
            values.setdefault(candidate.regions[0], []).append(candidate.value)
    highest = {first: max(those) for first, those in values.items()}
    shares = {first: 1.0 / those.count(highest[first]) for first, those in values.items()}
    return [
        shares[one.regions[0]]
        if one.value is not None and one.value == highest[one.regions[0]]
        else 0.0
        for one in candidates
    ]


def drawn(candidates: Sequence[Candidate], seed: int, built: Mask) -> int | None:
    """Index of a candidate, drawn by the probabilities; None if all of them are 0.

    The draw depends only on the seed of the trial, the state and the probabilities.
    """
    left = Generator([seed, *mask_words(built)]).below(_FRACTIONS) / _FRACTIONS
    last = None
    for index, candidate in enumerate(candidates):
        if candidate.probability:
            if left < candidate.probability:
                return index
            left -= candidate.probability
            last = index
    return last  # reached only by rounding
