"""The standard error of our own means, against closed forms and leaving seeds out by hand."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from blocks_planning.analysis.own_error import (
    Totals,
    correlation_of_means,
    error_of_difference,
    error_of_mean,
    totals_of,
)


def table(values: np.ndarray, success: np.ndarray | None = None) -> pd.DataFrame:
    """Trials with a cost for each silhouette and seed, (silhouettes, seeds)."""
    rows = [
        {
            'stimulus': f's{tower}',
            'seed': seed,
            'cost': value,
            'success': True if success is None else bool(success[tower, seed]),
        }
        for (tower, seed), value in np.ndenumerate(values)
    ]
    return pd.DataFrame(rows).astype({'stimulus': 'category'})


def totals(values: np.ndarray, success: np.ndarray | None = None) -> Totals:
    return totals_of(table(values, success), 'cost', range(values.shape[1]))


def made(seed: int = 0, shape: tuple[int, int] = (4, 9)) -> np.ndarray:
    return np.random.default_rng(seed).normal(10, 2, shape)


def test_one_run_for_each_seed_gives_the_usual_error() -> None:
    """With all runs there the mean over silhouettes is a mean over seeds."""
    values = made()
    by_seed = values.mean(axis=0)
    expected = by_seed.std(ddof=1) / np.sqrt(len(by_seed))
    assert error_of_mean(totals(values)) == pytest.approx(expected)


def test_runs_of_a_seed_depend_on_each_other() -> None:
    """Doubling every run within its seed adds nothing."""
    values = made()
    doubled = pd.concat([table(values)] * 2)
    found = totals_of(doubled, 'cost', range(9))
    assert error_of_mean(found) == pytest.approx(error_of_mean(totals(values)))


def test_difference_of_dependent_planners() -> None:
    """What both share of a seed cancels out."""
    first, second = made(), made() - 3
    assert error_of_difference(totals(first), totals(second)) == pytest.approx(0, abs=1e-12)
    other = made(seed=1)
    by_seed = (first - other).mean(axis=0)
    expected = by_seed.std(ddof=1) / 3
    assert error_of_difference(totals(first), totals(other)) == pytest.approx(expected)


def test_failed_runs_are_left_out_one_seed_at_a_time() -> None:
    values, success = made(), np.random.default_rng(5).random((4, 9)) < 0.6
    gaps = np.where(success, values, np.nan)
    means = [np.nanmean(np.nanmean(np.delete(gaps, seed, 1), axis=1)) for seed in range(9)]
    expected = np.sqrt(8 / 9 * ((np.array(means) - np.mean(means)) ** 2).sum())
    assert error_of_mean(totals(values, success)) == pytest.approx(expected)


def test_correlation_of_means() -> None:
    levels = np.arange(5.0)
    curves = np.stack([made(seed) + seed for seed in range(5)])
    r, error = correlation_of_means(levels, [totals(values) for values in curves])
    assert r == pytest.approx(np.corrcoef(levels, curves.mean(axis=(1, 2)))[0, 1])
    without = [
        np.corrcoef(levels, np.delete(curves, seed, 2).mean(axis=(1, 2)))[0, 1]
        for seed in range(9)
    ]
    expected = np.sqrt(8 / 9 * ((np.array(without) - np.mean(without)) ** 2).sum())
    assert error == pytest.approx(expected)


def test_one_seed_tells_nothing() -> None:
    assert np.isnan(error_of_mean(totals(made(shape=(4, 1)))))
