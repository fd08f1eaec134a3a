"""The trials of a sweep as a pandas table, and the parts of it that the paper speaks of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from blocks_planning.analysis.bootstrap import Groups
from blocks_planning.errors import InvalidInput
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

PRESETS = {
    'text': {'divisor': 'smallest', 'execute': 'first'},
    'published': {'divisor': 'mean', 'execute': 'path'},
}
"""A* as the paper's text describes it, and as its published numbers were made."""

PRESET_TEXT = {
    'text': 'A* as the paper describes it: divisor smallest, execute first',
    'published': 'A* as the published numbers were made: divisor mean, execute path',
}
SEARCH_SETTINGS = ('depth', 'iterations', 'divisor', 'execute')
MEASURES = ('success', 'action_planning_cost', 'subgoal_planning_cost', 'blocks', 'subgoals')
"""Success is over all runs, everything else over the successful ones (paper, section "Results")."""

_WORDS = ('experiment', 'stimulus', 'strategy', 'commit', 'search', 'divisor', 'execute', 'status')


def read_trials(folder: Path) -> pd.DataFrame:
    """The table of trials of a finished sweep, with a column ``success`` (bool) added.

    Raises:
        InvalidInput: if the folder has none.
    """
    path = folder / 'trials.parquet'
    if not path.is_file():
        raise InvalidInput(f'{path}: is not there; has the sweep been finished?')
    trials = pd.read_parquet(path)
    for name in _WORDS:
        trials[name] = trials[name].astype('category')
    trials['success'] = (trials['status'] == 'success').to_numpy(bool)
    return trials


def read_decisions(folder: Path) -> pd.DataFrame:
    """The table of decisions of a finished sweep: the columns that figures need."""
    columns = ['trial_id', 'decision', 'rows', 'executed']
    return pd.read_parquet(folder / 'decisions.parquet', columns=columns)


def planners_of(trials: pd.DataFrame, preset: str) -> pd.DataFrame:
    """The trials of the subgoal planners (budget above 0) in a preset."""
    return _in_preset(trials[trials['budget'] > 0], preset)


def single_attempts_of(trials: pd.DataFrame, preset: str) -> pd.DataFrame:
    """The trials of a single attempt without subgoals (budget 0) in a preset."""
    alone = trials[(trials['budget'] == 0) & (trials['strategy'] == 'none')]
    return _in_preset(alone, preset)


def _in_preset(trials: pd.DataFrame, preset: str) -> pd.DataFrame:
    wanted = (trials['search'] != 'astar').to_numpy(bool)
    same = np.ones(len(trials), bool)
    for setting, value in PRESETS[preset].items():
        same &= (trials[setting] == value).to_numpy(bool)
    return trials[wanted | same]


def groups_of(trials: pd.DataFrame, measure: str, unit: str = 'stimulus') -> Groups:
    """The values of a measure in groups, one for each resampling unit of the table, by name.

    Costs are nan for unsuccessful runs, and left out.
    """
    chosen = trials if measure == 'success' else trials[trials['success']]
    values = chosen[measure].to_numpy(float)
    codes = chosen[unit].cat.codes.to_numpy()
    order = np.argsort(codes, kind='stable')
    sizes = np.bincount(codes, minlength=len(trials[unit].cat.categories))
    return np.split(values[order], np.cumsum(sizes)[:-1])
