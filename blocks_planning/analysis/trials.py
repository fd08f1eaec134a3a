"""The trials of a sweep as a pandas table, and the parts of it that the paper reports."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from blocks_planning.analysis.bootstrap import Groups
from blocks_planning.analysis.paper_file import the_paper
from blocks_planning.errors import InvalidInput
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

PRESETS = tuple(the_paper().presets)
"""The names of the presets: the published numbers, and the text of the paper literally."""

SEARCH_SETTINGS = ('depth', 'dead_ends', 'iterations', 'divisor', 'execute')
SETTINGS = ('commit', *SEARCH_SETTINGS)
MEASURES = ('success', 'action_planning_cost', 'subgoal_planning_cost', 'blocks', 'subgoals')
"""Success is over all runs, everything else over the successful ones (paper, section "Results")."""

COMPARED = (
    *('stimulus', 'search', 'strategy', 'seed', 'budget', 'lambda', *SETTINGS),
    *(*MEASURES, 'solution_cost'),
)
"""The columns of the table of trials that a comparison with the paper needs."""

_WORDS = ('experiment', 'stimulus', 'strategy', 'search', 'status')
_WORD_SETTINGS = ('commit', 'dead_ends', 'divisor', 'execute')


def read_trials(folder: Path) -> pd.DataFrame:
    """The table of trials of a finished sweep, with a column ``success`` (bool) added.

    Raises:
        InvalidInput: if the folder has none.
    """
    path = folder / 'trials.parquet'
    if not path.is_file():
        raise InvalidInput(f'{path}: does not exist; has the sweep been finished?')
    trials = pd.read_parquet(path)
    for name in (*_WORDS, *_WORD_SETTINGS):
        trials[name] = trials[name].astype('category')
    trials['success'] = (trials['status'] == 'success').to_numpy(bool)
    return trials


def read_measured(folder: Path) -> pd.DataFrame:
    """The table of trials with measures as float64: ``success``, ``decisions`` and ``states``.

    ``decisions`` is their number in a trial, ``states`` all that the trial evaluated [states].

    Raises:
        InvalidInput: if the folder has no finished sweep.
    """
    trials = read_trials(folder)
    columns = ['trial_id', 'considered']
    decisions = pd.read_parquet(folder / 'decisions.parquet', columns=columns)
    by_trial = decisions.groupby('trial_id', observed=True)['considered']
    return trials.assign(
        stimulus=trials['stimulus'].astype(str),
        success=trials['success'].astype(float),
        decisions=trials['trial_id'].map(by_trial.size()).fillna(0).to_numpy(float),
        states=trials['trial_id'].map(by_trial.sum()).fillna(0).to_numpy(float),
    )


def read_decisions(folder: Path) -> pd.DataFrame:
    """The table of decisions of a finished sweep: the columns that figures need."""
    columns = ['trial_id', 'decision', 'tops', 'executed']
    return pd.read_parquet(folder / 'decisions.parquet', columns=columns)


def settings_of(preset: str) -> dict[str, str]:
    """The settings that a preset fixes, for every search and strategy that has them."""
    return {switch['setting']: switch[preset] for switch in the_paper().switches}


def planners_of(trials: pd.DataFrame, preset: str) -> pd.DataFrame:
    """The trials of the subgoal planners (budget above 0) in a preset."""
    return with_settings(trials[trials['budget'] > 0], settings_of(preset))


def single_attempts_of(trials: pd.DataFrame, preset: str) -> pd.DataFrame:
    """The trials of a single attempt without subgoals (budget 0) in a preset."""
    alone = trials[(trials['budget'] == 0) & (trials['strategy'] == 'none')]
    return with_settings(alone, settings_of(preset))


def with_settings(trials: pd.DataFrame, settings: Mapping[str, str]) -> pd.DataFrame:
    """The trials with these settings; those that a search or strategy does not have are ignored."""
    same = np.ones(len(trials), bool)
    for setting, value in settings.items():
        column = trials[setting]
        same &= (column.isna() | (column == value)).to_numpy(bool)
    return trials[same]


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
