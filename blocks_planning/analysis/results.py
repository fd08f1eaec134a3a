"""The numbers of a reproduction: what the paper reports, computed from a table of trials.

Everything is drawn from one generator in a fixed order: same trials and seed, same numbers.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from blocks_planning.analysis.bootstrap import (
    Estimate,
    bootstrap_correlation,
    bootstrap_difference,
    bootstrap_mean,
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
    rng = np.random.default_rng(seed)
    planners = planners_of(trials, preset)
    searches = {name: planners[planners['search'] == name] for name in ('bfs', 'astar')}
    return {
        'planners': {name: _planners(part, rng) for name, part in searches.items()},
        'table1': _table1(single_attempts_of(trials, preset), rng),
        'lambda': {name: _over_lambda(part, rng) for name, part in searches.items()},
        'differences': [
            difference for name, part in searches.items() for difference in _pairs(name, part, rng)
        ],
    }


def _planners(trials: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    return {
        strategy: _estimates(trials[trials['strategy'] == strategy], MEASURES, rng)
        for strategy in STRATEGIES
    }


def _estimates(
    trials: pd.DataFrame, measures: tuple[str, ...], rng: np.random.Generator
) -> dict[str, Any]:
    return {
        measure: bootstrap_mean(groups_of(trials, measure), rng).to_json() for measure in measures
    }


def _table1(trials: pd.DataFrame, rng: np.random.Generator) -> list[dict[str, Any]]:
    """A row for each search: success of one attempt, and the cost of successful ones."""
    rows = []
    for settings, part in trials.groupby(
        ['search', *SEARCH_SETTINGS], observed=True, dropna=False, sort=False
    ):
        named = dict(zip(('search', *SEARCH_SETTINGS), settings, strict=True))
        row = {key: _plain(value) for key, value in named.items() if not pd.isna(value)}
        row |= _estimates(part, ('success', 'solution_cost'), rng)
        row['states_evaluated'] = row.pop('solution_cost')
        rows.append(row)
    return rows


def _plain(value: Any) -> Any:
    return value if isinstance(value, str) else int(value)


def _over_lambda(trials: pd.DataFrame, rng: np.random.Generator) -> dict[str, Any]:
    """Every measure of scoping at each lambda, and its correlation with lambda."""
    scoping = trials[trials['strategy'] == 'scoping']
    levels, parts = [], []
    for level, part in scoping.groupby('lambda'):
        levels.append(float(level))
        parts.append(part)
    found: dict[str, Any] = {'values': levels, 'measures': {}, 'correlation': {}}
    for measure in MEASURES:
        groups = [groups_of(part, measure) for part in parts]
        found['measures'][measure] = [bootstrap_mean(group, rng).to_json() for group in groups]
        r = bootstrap_correlation(np.array(levels), groups, rng)
        found['correlation'][measure] = r.to_json()
    return found


def _pairs(search: str, trials: pd.DataFrame, rng: np.random.Generator) -> list[dict[str, Any]]:
    by_strategy = {name: trials[trials['strategy'] == name] for name in STRATEGIES}
    found = []
    for first, second in DIFFERENCES:
        for measure in MEASURES:
            left, right = (groups_of(by_strategy[name], measure) for name in (first, second))
            estimate: Estimate = bootstrap_difference(left, right, rng)
            found.append(
                {
                    'search': search,
                    'first': first,
                    'second': second,
                    'measure': measure,
                    **estimate.to_json(),
                }
            )
    return found
