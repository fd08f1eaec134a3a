"""Bootstrap as in the paper (section "Results"): each iteration draws one run per silhouette.

Runs are given in groups: one for each resampling unit (a silhouette). An iteration draws one
value from every group, uniformly, and takes the mean over groups. Groups without a value (no
successful run, if only those count) are excluded. The estimate of a mean is that of the
bootstrap distribution itself, the mean over groups of the group means; intervals are percentiles.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

ITERATIONS = 1000
LEVEL = 0.95

Groups = Sequence[np.ndarray]


class Estimate(NamedTuple):
    """A value with its interval; all nan if nothing could be estimated.

    ``p`` is that of an effect, as the paper computes it (see :func:`paper_p`); nan for a level.
    """

    mean: float
    low: float
    high: float
    p: float = float('nan')

    def to_json(self) -> dict[str, Any]:
        """``{"mean": ..., "ci": [low, high], "p": ...}``, with null for nan."""
        mean, low, high, p = (None if np.isnan(value) else float(value) for value in self)
        return {'mean': mean, 'ci': [low, high], 'p': p}


NOTHING = Estimate(float('nan'), float('nan'), float('nan'))


def draw(groups: Groups, rng: np.random.Generator, iterations: int = ITERATIONS) -> np.ndarray:
    """One value of each group per iteration: float64 (iterations, groups), nan for empty ones."""
    counts = np.array([len(group) for group in groups])
    table = np.full((len(groups), max(1, counts.max(initial=1))), np.nan)
    for row, group in zip(table, groups, strict=True):
        row[: len(group)] = group
    places = (rng.random((iterations, len(groups))) * counts).astype(np.int64)
    drawn: np.ndarray = table[np.arange(len(groups)), places]
    return drawn


def paper_p(distribution: np.ndarray, mean: float) -> float:
    """p of an effect as the published analysis computes it.

    For a positive effect the share of iterations below 0, for any other the share of those that are
    not, divided by two in both cases. The two-sided p is four times this.
    """
    below = float((distribution < 0).mean())
    return (below if mean > 0 else 1 - below) / 2


def bootstrap_mean(
    groups: Groups, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """The mean over groups of one drawn value each."""
    groups = [group for group in groups if len(group)]
    if not groups:
        return NOTHING
    mean = float(np.mean([group.mean() for group in groups]))
    return estimate_of(draw(groups, rng, iterations).mean(axis=1), mean)


def bootstrap_difference(
    first: Groups, second: Groups, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """``first`` minus ``second``, paired by group; both need a value of a group for it to count.

    Raises:
        ValueError: if there are not as many groups in both.
    """
    pairs = [(a, b) for a, b in zip(first, second, strict=True) if len(a) and len(b)]
    if not pairs:
        return NOTHING
    left, right = ([pair[side] for pair in pairs] for side in (0, 1))
    mean = float(np.mean([a.mean() - b.mean() for a, b in pairs]))
    drawn = draw(left, rng, iterations) - draw(right, rng, iterations)
    return effect_of(drawn.mean(axis=1), mean)


def bootstrap_correlation(
    levels: np.ndarray,
    groups: Sequence[Groups],
    rng: np.random.Generator,
    iterations: int = ITERATIONS,
) -> Estimate:
    """Pearson's r of ``levels``, float64 (n,), with the mean of one drawn value per group at each.

    Args:
        levels: such as the values of lambda.
        groups: the groups of each level.
        rng: generator of the draws.
        iterations: number of draws.

    The estimate is the mean of r over the iterations, without those in which nothing varies, as in
    the published analysis. It is nan where a level has no value, or nothing ever varies.
    """
    drawn = [draw(at_level, rng, iterations) for at_level in groups]
    means = np.stack([mean_of_present(values) for values in drawn], axis=1)
    r = pearson(levels, means)
    r = r[np.isfinite(r)]
    return effect_of(r, float(r.mean())) if len(r) else NOTHING


def pearson(x: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Pearson's r of x, float64 (n,), with each row of float64 (m, n): float64 (m,)."""
    x = x - x.mean()
    rows = rows - rows.mean(axis=1, keepdims=True)
    with np.errstate(invalid='ignore'):
        r: np.ndarray = (rows @ x) / np.sqrt((x @ x) * (rows * rows).sum(axis=1))
    return r


def mean_of_present(values: np.ndarray) -> np.ndarray:
    """Means over the last axis, without nan; nan if there are only nan values."""
    present = ~np.isnan(values)
    with np.errstate(invalid='ignore'):
        means: np.ndarray = np.where(present, values, 0.0).sum(axis=-1) / present.sum(axis=-1)
    return means


def estimate_of(distribution: np.ndarray, mean: float) -> Estimate:
    """A level with the percentiles of its bootstrap distribution, float64 (iterations,)."""
    tail = 100 * (1 - LEVEL) / 2
    low, high = np.percentile(distribution, [tail, 100 - tail])
    return Estimate(mean, float(low), float(high))


def effect_of(distribution: np.ndarray, mean: float) -> Estimate:
    """An effect with the percentiles of its bootstrap distribution, and its p."""
    return estimate_of(distribution, mean)._replace(p=paper_p(distribution, mean))
