"""Action-level searches beyond the paper's, in the form of its Table 1."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.own_error import own_mean
from blocks_planning.analysis.trials import read_trials
from blocks_planning.extras import extra
from blocks_planning.trials.flat import flat_settings

with extra('experiments'):
    import pandas as pd


def beyond_rows(sweep: Path) -> list[dict[str, Any]]:
    """A row for each search and its settings, in the order of the sweep.

    Args:
        sweep: folder of a finished sweep of single attempts without subgoals.

    Returns:
        ``search``, ``settings`` by name, and estimates with ``mean`` and ``se``: ``success`` and
        ``all_attempts`` (states evaluated) of every attempt, ``states_evaluated`` of those that
        succeeded, and their ``blocks``.

    Raises:
        InvalidInput: if the sweep has no tables.
    """
    trials = read_trials(sweep)
    seeds = sorted(trials['seed'].unique())
    names = [flat.name for flat in flat_settings() if flat.family == 'search']
    groups = trials.groupby(['search', *names], observed=True, dropna=False, sort=False)
    return [
        {
            'search': search,
            'settings': {
                name: _plain(value)
                for name, value in zip(names, settings, strict=True)
                if not pd.isna(value)
            },
            'success': own_mean(part, 'success', seeds),
            'states_evaluated': own_mean(part, 'solution_cost', seeds),
            'blocks': own_mean(part, 'blocks', seeds),
            'all_attempts': _mean_of_all(part),
        }
        for (search, *settings), part in groups
    ]


def _mean_of_all(trials: pd.DataFrame) -> dict[str, Any]:
    """The states evaluated in an attempt, successful or not: its mean over silhouettes."""
    by_tower = trials.groupby('stimulus', observed=True)['action_planning_cost'].mean()
    return {'mean': float(by_tower.mean()), 'se': None}


def _plain(value: Any) -> Any:
    """A setting as JSON has it; a whole number in a column of floats is whole."""
    if isinstance(value, str):
        return value
    return int(value) if float(value).is_integer() else float(value)
