"""Shares with bootstrap intervals over builders, each with all of their builds."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from blocks_planning.analysis.bootstrap import ITERATIONS, LEVEL, NOTHING, Estimate
from blocks_planning.people.orders import Count


class Tally:
    """Counts summed for each builder: ``hits`` and ``chances``, float64 (builders,)."""

    def __init__(self, counts: Iterable[tuple[str, Count]]) -> None:
        """Sum counts that each belong to a builder; builders keep the order of their names."""
        summed: dict[str, list[int]] = {}
        for builder, count in counts:
            entry = summed.setdefault(builder, [0, 0])
            entry[0] += count.hits
            entry[1] += count.chances
        self.builders = sorted(summed)
        table = np.array([summed[name] for name in self.builders], float).reshape(-1, 2)
        self.hits, self.chances = table[:, 0], table[:, 1]

    @property
    def share(self) -> float:
        """All hits of all chances; nan without any."""
        return float(_ratio(self.hits.sum(), self.chances.sum()))


def estimate_share(
    tally: Tally, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """The share of a tally, with its percentile interval over builders."""
    if not tally.chances.sum():
        return NOTHING
    drawn = draw_builders(len(tally.builders), rng, iterations)
    return interval(tally.share, _ratio(drawn @ tally.hits, drawn @ tally.chances))


def estimate_gain(
    own: Tally, by_chance: Tally, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """The share beyond chance: (own - chance) / (1 - chance).

    1 is a share of 1, 0 is the share by chance. Draws of builders are paired.

    Raises:
        ValueError: if the tallies are not of the same builders.
    """
    if own.builders != by_chance.builders:
        raise ValueError('own and by_chance must have the same builders')
    if not own.chances.sum():
        return NOTHING
    drawn = draw_builders(len(own.builders), rng, iterations)
    gains = _gain(
        _ratio(drawn @ own.hits, drawn @ own.chances),
        _ratio(drawn @ by_chance.hits, drawn @ by_chance.chances),
    )
    return interval(float(_gain(own.share, by_chance.share)), gains)


def draw_builders(count: int, rng: np.random.Generator, iterations: int) -> np.ndarray:
    """How often each builder is drawn: int64 (iterations, builders), rows sum to ``count``."""
    drawn: np.ndarray = rng.multinomial(count, np.full(count, 1 / count), iterations)
    return drawn


def interval(value: float, distribution: np.ndarray) -> Estimate:
    """A value with the percentiles of its bootstrap distribution; nan in it is left out."""
    known = distribution[np.isfinite(distribution)]
    if not len(known) or not np.isfinite(value):
        return NOTHING
    tail = 100 * (1 - LEVEL) / 2
    low, high = np.percentile(known, [tail, 100 - tail])
    return Estimate(value, float(low), float(high))


def _ratio(hits: np.ndarray, chances: np.ndarray) -> np.ndarray:
    with np.errstate(invalid='ignore', divide='ignore'):
        ratio: np.ndarray = np.true_divide(hits, chances)
    return ratio


def _gain(own: np.ndarray | float, by_chance: np.ndarray | float) -> np.ndarray:
    with np.errstate(invalid='ignore', divide='ignore'):
        gain: np.ndarray = np.true_divide(np.subtract(own, by_chance), np.subtract(1, by_chance))
    return gain


def to_json(estimates: Mapping[str, Estimate]) -> dict[str, object]:
    """Estimates by name as JSON."""
    return {name: estimate.to_json() for name, estimate in estimates.items()}
