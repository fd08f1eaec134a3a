"""The bootstrap against scipy and closed forms, on made data."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from blocks_planning.analysis.bootstrap import (
    bootstrap_correlation,
    bootstrap_difference,
    bootstrap_mean,
    draw,
    paper_p,
    pearson,
)
from blocks_planning.analysis.people import spearman

MANY = 20_000


def rng() -> np.random.Generator:
    return np.random.default_rng(7)


def made(count: int = 16, runs: int = 32, seed: int = 1) -> list[np.ndarray]:
    source = np.random.default_rng(seed)
    return [source.normal(10 * unit, 1 + unit, runs) for unit in range(count)]


def test_draws_come_from_their_own_group() -> None:
    groups = [np.array([1.0, 2.0]), np.array([5.0]), np.empty(0)]
    drawn = draw(groups, rng(), 500)
    assert drawn.shape == (500, 3)
    assert set(drawn[:, 0]) == {1.0, 2.0}
    assert set(drawn[:, 1]) == {5.0}
    assert np.isnan(drawn[:, 2]).all()


def test_each_value_is_equally_likely() -> None:
    drawn = draw([np.arange(5.0)], rng(), MANY)[:, 0]
    assert stats.chisquare(np.bincount(drawn.astype(int), minlength=5)).pvalue > 0.001


def test_mean_and_interval_have_their_closed_form() -> None:
    """Of sixteen drawn runs the mean is near to normal, with the variance of the groups' sum."""
    groups = made()
    found = bootstrap_mean(groups, rng(), MANY)
    error = np.sqrt(sum(group.var() for group in groups)) / len(groups)
    expected = np.mean([group.mean() for group in groups])
    assert found.mean == pytest.approx(expected)
    low, high = stats.norm(expected, error).interval(0.95)
    assert found.low == pytest.approx(low, abs=0.1 * error)
    assert found.high == pytest.approx(high, abs=0.1 * error)


def test_share_of_successes_is_binomial() -> None:
    groups = [np.repeat([0.0, 1.0], [3, 1])] * 16
    found = bootstrap_mean(groups, rng(), MANY)
    low, high = stats.binom(16, 0.25).interval(0.95)
    assert found[:3] == (0.25, low / 16, high / 16)


def test_mean_agrees_with_scipy() -> None:
    """With a group per value of scipy's sample, drawing runs is drawing with replacement."""
    sample = np.random.default_rng(3).exponential(2.0, 40)
    found = bootstrap_mean([sample] * len(sample), rng(), MANY)
    theirs = stats.bootstrap(
        (sample,), np.mean, n_resamples=MANY, method='percentile', random_state=5
    ).confidence_interval
    assert found.low == pytest.approx(theirs.low, rel=0.02)
    assert found.high == pytest.approx(theirs.high, rel=0.02)


def test_groups_without_values_take_no_part() -> None:
    some = made(3)
    assert bootstrap_mean([*some, np.empty(0)], rng())[:3] == bootstrap_mean(some, rng())[:3]
    assert np.isnan(bootstrap_mean([np.empty(0)], rng()).mean)


def test_difference_is_paired() -> None:
    """What groups share cancels out; unpaired, it would dominate the interval."""
    first, second = made(), [group + 3 for group in made(seed=1)]
    found = bootstrap_difference(second, first, rng(), MANY)
    error = np.sqrt(2 * sum(group.var() for group in first)) / len(first)
    assert found.mean == pytest.approx(3)
    assert found.high - found.low == pytest.approx(2 * 1.96 * error, rel=0.05)


def test_difference_needs_both_of_a_pair() -> None:
    a, b = np.array([1.0]), np.array([5.0])
    none = np.empty(0)
    assert bootstrap_difference([a, a, none], [b, none, b], rng()) == (-4, -4, -4, 0)


def test_pearson_is_that_of_scipy() -> None:
    source = np.random.default_rng(0)
    x, rows = source.normal(size=12), source.normal(size=(5, 12))
    expected = [stats.pearsonr(x, row).statistic for row in rows]
    assert pearson(x, rows) == pytest.approx(expected)


def test_correlation_of_certain_values_is_certain() -> None:
    levels = np.linspace(0, 1, 10)
    groups = [[np.array([level**2 + unit]) for unit in range(4)] for level in levels]
    found = bootstrap_correlation(levels, groups, rng())
    assert found[:3] == pytest.approx([stats.pearsonr(levels, levels**2).statistic] * 3)
    assert found.p == 0


def test_correlation_has_the_distribution_of_drawn_means() -> None:
    levels = np.linspace(0, 1, 8)
    source = np.random.default_rng(2)
    groups = [[source.normal(level, 1, 20) for _ in range(6)] for level in levels]
    found = bootstrap_correlation(levels, groups, rng(), MANY)
    drawn = np.array([[source.choice(group, 5000) for group in at] for at in groups])
    slow = [np.corrcoef(levels, means)[0, 1] for means in drawn.mean(axis=1).T]
    assert found.mean == pytest.approx(np.mean(slow), abs=0.02)
    assert found.low == pytest.approx(np.percentile(slow, 2.5), abs=0.05)


def test_correlation_is_nan_where_nothing_varies() -> None:
    levels = np.arange(3.0)
    assert np.isnan(bootstrap_correlation(levels, [[np.ones(4)]] * 3, rng()).mean)


def test_draws_in_which_nothing_varies_are_left_out() -> None:
    """Of one silhouette with 0 or 1 at the last level, half of the draws have a correlation."""
    groups = [[np.zeros(1)], [np.zeros(1)], [np.array([0.0, 1.0])]]
    found = bootstrap_correlation(np.arange(3.0), groups, rng())
    assert found[:3] == pytest.approx([stats.pearsonr([0, 1, 2], [0, 0, 1]).statistic] * 3)


@pytest.mark.parametrize(
    ('distribution', 'mean', 'p'),
    [
        # Ten iterations, by hand: the share on the other side of 0, halved.
        ([1, 1, 1, 1, 1, 1, 1, 1, -1, -1], 0.6, 0.1),
        ([-1, -1, -1, -1, -1, -1, -1, -1, 1, 1], -0.6, 0.1),
        # As in the published analysis 0 counts against a negative effect, and not against a
        # positive one.
        ([1, 1, 1, 1, 1, 1, 1, 1, 0, 0], 0.8, 0.0),
        ([-1, -1, -1, -1, -1, -1, -1, -1, 0, 0], -0.8, 0.1),
        ([0] * 10, 0, 0.5),
        ([2] * 10, 2, 0.0),
    ],
)
def test_p_is_that_of_the_published_analysis(
    distribution: list[float], mean: float, p: float
) -> None:
    assert paper_p(np.array(distribution, float), mean) == pytest.approx(p)


def test_levels_have_no_p() -> None:
    assert bootstrap_mean(made(), rng()).to_json()['p'] is None
    shifted = [group + 20 for group in made(seed=2)]
    assert bootstrap_difference(shifted, made(seed=2), rng()).p < 0.05


def test_generator_is_the_only_source_of_chance() -> None:
    assert bootstrap_mean(made(), rng())[:3] == bootstrap_mean(made(), rng())[:3]


def test_spearman_is_that_of_scipy() -> None:
    source = np.random.default_rng(4)
    x, y = source.normal(size=8), source.normal(size=8)
    found = spearman(x, y, rng())
    assert found.mean == pytest.approx(stats.spearmanr(x, y).statistic)
    assert found.low <= found.mean <= found.high
    assert np.isnan(spearman(x, np.ones(8), rng()).mean)
