"""Table 1 without sampling: exact values of single attempts over several towers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from blocks_planning import settings
from blocks_planning.errors import LimitExceeded
from blocks_planning.experiments.spec import SweepSpec
from blocks_planning.extras import extra
from blocks_planning.search.policy import analyse_policy
from blocks_planning.search.result import DEFAULT_BUDGET, Problem
from blocks_planning.search.searches import BreadthFirst, RandomPlacement, Search
from blocks_planning.trials.script import Tower


def exact_table(sweep: SweepSpec, workers: int, budget: int = DEFAULT_BUDGET) -> list[Any]:
    """The exact values of every bfs and random search of a sweep in single-attempt trials.

    Returns:
        A dict per search: its name and settings; ``success`` of one attempt, mean over towers;
        ``states_evaluated`` of a successful attempt, mean over the towers where one can succeed;
        ``within_budget``: success of attempts until ``budget`` [states], mean over towers. The
        numbers are None if a tower exceeds the limit of states.
    """
    with extra('experiments'):
        from joblib import Parallel, delayed

    searches = [
        search
        for experiment in sweep.experiments
        if experiment.budget == 0
        for search in experiment.searches
        if isinstance(search, (BreadthFirst, RandomPlacement))
    ]
    tasks = [(search, tower) for search in searches for tower in sweep.towers]
    values = Parallel(n_jobs=workers)(
        delayed(_values)(search, tower, budget) for search, tower in tasks
    )
    count = len(sweep.towers)
    return [
        _row(search, values[index * count : (index + 1) * count], budget)
        for index, search in enumerate(searches)
    ]


def _values(search: Search, tower: Tower, budget: int) -> tuple[float, float, float]:
    """Success, cost of success (nan if there is none), success within the budget; or all nan."""
    try:
        found = analyse_policy(Problem(tower.task, 0, tower.task.silhouette), search, budget)
    except LimitExceeded:
        found = None
    if found is None:
        return (np.nan,) * 3
    cost = np.nan if found.cost_of_success is None else found.cost_of_success
    return found.success, cost, found.within_budget


def _row(
    search: Search, values: Sequence[tuple[float, float, float]], budget: int
) -> dict[str, Any]:
    success, cost, within = np.array(values).T
    known = bool(np.isfinite(success).all())
    some = known and bool(np.isfinite(cost).any())
    return {
        'search': search.name,
        **settings.settings_of(search),
        'success': float(success.mean()) if known else None,
        'states_evaluated': float(np.nanmean(cost)) if some else None,
        'within_budget': float(within.mean()) if known else None,
        'budget': budget,
    }
