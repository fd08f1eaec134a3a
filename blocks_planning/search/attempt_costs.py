"""Distributions of the costs of attempts, and of the number of attempts within a budget."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np


class Costs(NamedTuple):
    """Probabilities of costs: int64 (n,) rising [states], float64 (n,)."""

    cost: np.ndarray
    probability: np.ndarray


class Arrivals:
    """Paths into a state, or into an end of the attempt: their costs and probabilities.

    ``expected`` is the probability times the expected cost [states].
    """

    def __init__(self) -> None:
        """Start without paths."""
        self.probability = 0.0
        self.expected = 0.0
        self._parts: list[Costs] = []

    @property
    def size(self) -> int:
        """Number of costs that are kept."""
        return sum(len(part.cost) for part in self._parts)

    def add(self, probability: float, expected: float, costs: Costs) -> None:
        """Add a path."""
        self.probability += probability
        self.expected += expected
        self._parts.append(costs)

    def costs(self) -> Costs:
        """The probabilities of all costs; there must be a path."""
        if len(self._parts) == 1:
            return self._parts[0]
        cost, places = np.unique(
            np.concatenate([part.cost for part in self._parts]), return_inverse=True
        )
        weights = np.concatenate([part.probability for part in self._parts])
        return Costs(cost, np.bincount(places.ravel(), weights, len(cost)))


def expected_attempts(failures: Arrivals, budget: int) -> float:
    """Expected number of attempts that begin: the first, and one after each failure in time.

    It is 1 + P(F1 < b) + P(F2 < b) + ..., where Fk is the cost of k failed attempts, and
    the probability includes that all k fail: the coefficients below b of the power series
    1 / (1 - f), where f has the probabilities of failing at each cost, summed.

    Args:
        failures: attempts that fail; none of them costs 0.
        budget: b [states].
    """
    if budget == 0 or not failures.probability:
        return 1.0
    costs = failures.costs()
    inside = costs.cost < budget
    series = np.zeros(budget)
    series[0] = 1.0
    series[costs.cost[inside]] -= costs.probability[inside]
    return float(_reciprocal(series).sum())


def _reciprocal(series: np.ndarray) -> np.ndarray:
    """1 / series as a power series of the same length, by Newton's method; series[0] is 1."""
    found = np.ones(1)
    while len(found) < len(series):
        size = min(2 * len(found), len(series))
        length = 1 << (2 * size - 1).bit_length()
        given, guess = np.fft.rfft(series[:size], length), np.fft.rfft(found, length)
        found = np.fft.irfft(guess * (2.0 - given * guess), length)[:size]
    return found
