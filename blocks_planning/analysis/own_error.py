"""The standard error of our own means, which have many seeds where the paper draws one run.

All planners of a seed share their solves, so runs of one seed depend on each other, over lambda and
between planners. Only seeds are independent: the error is a jackknife that leaves out one seed
after the other, for all silhouettes together.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.analysis.bootstrap import mean_of_present, pearson
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd


class Totals(NamedTuple):
    """A measure of some trials, summed by silhouette and seed."""

    sums: np.ndarray  # float64 (silhouettes, seeds)
    counts: np.ndarray  # float64 (silhouettes, seeds): runs that count


def totals_of(trials: pd.DataFrame, measure: str, seeds: Sequence[int]) -> Totals:
    """The totals of a measure; success over all trials, anything else over successful ones."""
    chosen = trials if measure == 'success' else trials[trials['success']]
    values = chosen[measure].to_numpy(float)
    rows = chosen['stimulus'].cat.codes.to_numpy(np.int64)
    columns = np.searchsorted(np.asarray(seeds), chosen['seed'].to_numpy(np.int64))
    shape = (len(trials['stimulus'].cat.categories), len(seeds))
    places = rows * shape[1] + columns
    size = shape[0] * shape[1]
    return Totals(
        np.bincount(places, values, size).reshape(shape),
        np.bincount(places, None, size).astype(float).reshape(shape),
    )


def error_of_mean(totals: Totals) -> float:
    """Standard error of the mean over silhouettes of their means; nan with fewer than two seeds."""
    return _jackknife(_means_without_a_seed(_left_out(totals)))


def own_mean(trials: pd.DataFrame, measure: str, seeds: Sequence[int]) -> dict[str, Any]:
    """Our mean over silhouettes and its standard error, as ``mean`` and ``se``; None without any.

    Success is over all trials, anything else over successful ones.
    """
    chosen = trials if measure == 'success' else trials[trials['success']]
    by_tower = chosen.groupby('stimulus', observed=True)[measure].mean()
    error = error_of_mean(totals_of(trials, measure, seeds))
    return {
        'mean': float(by_tower.mean()) if len(by_tower) else None,
        'se': None if pd.isna(error) else error,
    }


def error_of_difference(first: Totals, second: Totals) -> float:
    """Standard error of a difference of means, over silhouettes that have both."""
    differences = _left_out(first) - _left_out(second)
    return _jackknife(_means_without_a_seed(differences))


def correlation_of_means(levels: np.ndarray, totals: Sequence[Totals]) -> tuple[float, float]:
    """Pearson's r of ``levels``, float64 (n,), with our mean at each, and its standard error."""
    curve = np.array([mean_of_present(_by_silhouette(at_level)) for at_level in totals])
    without = np.stack([_means_without_a_seed(_left_out(at)) for at in totals], axis=1)
    return float(pearson(levels, curve[None])[0]), _jackknife(pearson(levels, without))


def _by_silhouette(totals: Totals) -> np.ndarray:
    with np.errstate(invalid='ignore', divide='ignore'):
        means: np.ndarray = totals.sums.sum(axis=1) / totals.counts.sum(axis=1)
    return means


def _left_out(totals: Totals) -> np.ndarray:
    """The mean of each silhouette without each seed, float64 (silhouettes, seeds)."""
    sums = totals.sums.sum(axis=1, keepdims=True) - totals.sums
    counts = totals.counts.sum(axis=1, keepdims=True) - totals.counts
    with np.errstate(invalid='ignore', divide='ignore'):
        means: np.ndarray = np.where(counts > 0, sums, np.nan) / counts
    return means


def _means_without_a_seed(left_out: np.ndarray) -> np.ndarray:
    return mean_of_present(left_out.T)


def _jackknife(values: np.ndarray) -> float:
    """The jackknife's standard error of values that each leave out one of n seeds."""
    n = len(values)
    if n < 2 or not np.isfinite(values).all():
        return float('nan')
    return float(np.sqrt((n - 1) / n * ((values - values.mean()) ** 2).sum()))
