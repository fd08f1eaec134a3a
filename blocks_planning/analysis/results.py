"""The numbers of a reproduction, as the paper reports them, computed from a table of trials.

All draws come from one generator in a fixed order: the same trials and seed give the same numbers.
An estimate is ``{"mean": ..., "ci": [low, high], "p": ..., "se": ...}``: mean, interval and p as
the paper computes them, from one drawn run per silhouette, and the standard error of our own mean.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from blocks_planning.analysis.bootstrap import (
    Estimate,
    bootstrap_correlation,
    bootstrap_difference,
    bootstrap_mean,
)
from blocks_planning.analysis.own_error import (
    correlation_of_means,
    error_of_difference,
    error_of_mean,
    totals_of,
)
from blocks_planning.analysis.trials import (
    MEASURES,
    SEARCH_SETTINGS,
    groups_of,
    planners_of,
    single_attempts_of,
)
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

STRATEGIES = ('none', 'scoping', 'full')
DIFFERENCES = (('full', 'none'), ('scoping', 'full'), ('scoping', 'none'))
SEED = 20210604


def summarise(trials: pd.DataFrame, preset: str, seed: int = SEED) -> dict[str, Any]:
    """All numbers of a preset.

    Args:
        trials: see :func:`.trials.read_trials`.
        preset: 'text' or 'published'.
        seed: of the bootstrap.

    Returns:
        ``planners``, ``table1``, ``lambda`` and ``differences`` as in ``results.json``; means
        over lambda are means over all scoping trials. Costs in states evaluated.
    """
    statistics = _Statistics(sorted(trials['seed'].unique()), np.random.default_rng(seed))
    planners = planners_of(trials, preset)
    by_search = {
        name: {strategy: part[part['strategy'] == strategy] for strategy in STRATEGIES}
        for name in ('bfs', 'astar')
        for part in [planners[planners['search'] == name]]
    }
    return {
        'planners': {
            search: {
                strategy: statistics.levels(part, MEASURES) for strategy, part in parts.items()
            }
            for search, parts in by_search.items()
        },
        'table1': statistics.table1(single_attempts_of(trials, preset)),
        'lambda': {
            search: statistics.over_lambda(parts['scoping']) for search, parts in by_search.items()
        },
        'differences': [
            {'search': search, 'first': first, 'second': second, 'measure': measure}
            | statistics.difference(parts[first], parts[second], measure)
            for search, parts in by_search.items()
            for first, second in DIFFERENCES
            for measure in MEASURES
        ],
    }


class _Statistics:
    """Statistics of parts of the table."""

    def __init__(self, seeds: Sequence[int], rng: np.random.Generator) -> None:
        self._seeds = seeds
        self._rng = rng

    def levels(self, trials: pd.DataFrame, measures: tuple[str, ...]) -> dict[str, Any]:
        """The mean of each measure."""
        return {
            measure: _to_json(
                bootstrap_mean(groups_of(trials, measure), self._rng),
                error_of_mean(totals_of(trials, measure, self._seeds)),
            )
            for measure in measures
        }

    def difference(
        self, first: pd.DataFrame, second: pd.DataFrame, measure: str
    ) -> dict[str, Any]:
        """``first`` minus ``second``."""
        return _to_json(
            bootstrap_difference(groups_of(first, measure), groups_of(second, measure), self._rng),
            error_of_difference(
                totals_of(first, measure, self._seeds), totals_of(second, measure, self._seeds)
            ),
        )

    def table1(self, trials: pd.DataFrame) -> list[dict[str, Any]]:
        """A row for each search: success of one attempt, and the cost of successful ones."""
        rows = []
        for settings, part in trials.groupby(
            ['search', *SEARCH_SETTINGS], observed=True, dropna=False, sort=False
        ):
            named = dict(zip(('search', *SEARCH_SETTINGS), settings, strict=True))
            row = {key: _plain(value) for key, value in named.items() if not pd.isna(value)}
            row |= self.levels(part, ('success', 'solution_cost'))
            row['states_evaluated'] = row.pop('solution_cost')
            rows.append(row)
        return rows

    def over_lambda(self, scoping: pd.DataFrame) -> dict[str, Any]:
        """Every measure of scoping at each lambda, and its correlation with lambda."""
        parts = dict(list(scoping.groupby('lambda')))
        levels = np.array(list(parts), float)
        found: dict[str, Any] = {'values': levels.tolist(), 'measures': {}, 'correlation': {}}
        for measure in MEASURES:
            groups = [groups_of(part, measure) for part in parts.values()]
            found['measures'][measure] = [
                bootstrap_mean(group, self._rng).to_json() for group in groups
            ]
            totals = [totals_of(part, measure, self._seeds) for part in parts.values()]
            of_means, error = correlation_of_means(levels, totals)
            found['correlation'][measure] = {
                **_to_json(bootstrap_correlation(levels, groups, self._rng), error),
                'of_means': _or_none(of_means),
            }
        return found


def _to_json(estimate: Estimate, error: float) -> dict[str, Any]:
    return {**estimate.to_json(), 'se': _or_none(error)}


def _or_none(number: float) -> float | None:
    return number if math.isfinite(number) else None


def _plain(value: Any) -> Any:
    return value if isinstance(value, str) else int(value)
