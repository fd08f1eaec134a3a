"""Planners under uncertainty: success, regret and costs by world, and a comparison.

Every number is a mean over towers of the means over seeds. Intervals (95 %) are percentiles of a
bootstrap over towers: towers are drawn with replacement, each with all of its seeds, so they
describe the variation between sets of towers. Costs are over all trials, successful or not, and
count every evaluated state, including those of plans that were not executed to the end.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from blocks_planning.analysis.bootstrap import ITERATIONS, Estimate, estimate_of
from blocks_planning.analysis.people import read_people
from blocks_planning.analysis.trials import read_trials
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

SEED = 20210728
MEASURES = (
    *('success', 'collapsed', 'f1', 'orders', 'blocks', 'plans', 'states'),
    *('action_planning_cost', 'subgoal_planning_cost'),
)
NEAR, FAR = 'scoping', 'full replan'
_WORLD = ['slip', 'loss', 'blocks_are']


def read_uncertain(folder: Path) -> pd.DataFrame:
    """The trials of a finished sweep, with a column ``planner`` and the measures as numbers.

    ``plans`` counts the decisions of a trial, ``states`` all that it evaluated [states].
    ``blocks_are`` is 'glued' or 'loose'.

    Raises:
        InvalidInput: if the folder has no finished sweep.
    """
    trials = read_trials(folder)
    columns = ['trial_id', 'considered']
    decisions = pd.read_parquet(folder / 'decisions.parquet', columns=columns)
    by_trial = decisions.groupby('trial_id', observed=True)['considered']
    return trials.assign(
        planner=[_planner(row) for row in trials.to_dict('records')],
        stimulus=trials['stimulus'].astype(str),
        collapsed=(trials['status'] == 'collapsed').to_numpy(float),
        success=trials['success'].astype(float),
        plans=trials['trial_id'].map(by_trial.size()).fillna(0).to_numpy(float),
        states=trials['trial_id'].map(by_trial.sum()).fillna(0).to_numpy(float),
        blocks_are=trials['world_blocks'].astype(str),
    )


def _planner(row: dict[str, Any]) -> str:
    if row['strategy'] == 'scoping':
        return f'scoping {row["lambda"]:g} {row["commit"]}'
    return 'none' if row['strategy'] == 'none' else f'full {row["surprise"]}'


def summarise(trials: pd.DataFrame, optima: list[dict[str, Any]]) -> dict[str, Any]:
    """The content of the report, as data.

    Args:
        trials: of :func:`read_uncertain`.
        optima: of :func:`.optima.optimum_table`.

    Returns:
        ``cells``: each planner in each world, with an estimate of each measure and, where blocks
        are glued, of the ``regret``; ``optima``: by slip; ``advantage``: of scoping over full
        planning by slip, and its change since slip 0; ``loose``: how often towers fall.
    """
    best = pd.DataFrame(optima).astype({'optimum': float})
    best = best.pivot_table(index='stimulus', columns='slip', values='optimum', dropna=False)
    means = trials.groupby([*_WORLD, 'planner', 'stimulus'], observed=True)[list(MEASURES)].mean()
    return {
        'trials': len(trials),
        'seeds': [int(seed) for seed in sorted(trials['seed'].unique())],
        'cells': list(_cells(means, best)),
        'optima': [
            {'slip': float(slip), **over_towers(best[slip].to_numpy()).to_json()} for slip in best
        ],
        'advantage': advantages(means),
        'loose': loose_towers(trials),
    }


def over_towers(values: np.ndarray, iterations: int = ITERATIONS) -> Estimate:
    """The mean of a value per tower, float64 (n,), bootstrapped over towers."""
    rng = np.random.default_rng(SEED)
    drawn = rng.integers(0, len(values), (iterations, len(values)))
    return estimate_of(values[drawn].mean(axis=1), float(values.mean()))


def _cells(means: pd.DataFrame, best: pd.DataFrame) -> Any:
    for place, part in means.groupby([*_WORLD, 'planner'], observed=True):
        slip, loss, blocks, planner = place
        towers = part.index.get_level_values('stimulus')
        found = {name: over_towers(part[name].to_numpy(float)).to_json() for name in MEASURES}
        if blocks == 'glued':
            regret = best.loc[towers, slip].to_numpy() - part['success'].to_numpy(float)
            found['regret'] = over_towers(regret).to_json()
        yield {'slip': slip, 'loss': loss, 'blocks_are': blocks, 'planner': planner, **found}


def advantages(means: pd.DataFrame) -> list[dict[str, Any]]:
    """The advantage of looking one subgoal ahead over planning all subgoals, by planner and slip.

    For each scoping planner: the difference in success, the ratio of states evaluated (full
    planning divided by scoping), and how much both have changed since slip 0, paired by tower.
    """
    glued = means.xs((0.0, 'glued'), level=('loss', 'blocks_are'))
    slips = sorted(glued.index.get_level_values('slip').unique())
    near = sorted(p for p in glued.index.get_level_values('planner').unique() if NEAR in p)
    rows = []
    for planner in near:
        start = _gains(glued, planner, slips[0])
        for slip in slips:
            gains = _gains(glued, planner, slip)
            row: dict[str, Any] = {'planner': planner, 'slip': slip}
            for name in gains:
                row[name] = over_towers(gains[name]).to_json()
                row[f'{name}_change'] = over_towers(gains[name] - start[name]).to_json()
            rows.append(row)
    return rows


def _gains(glued: pd.DataFrame, planner: str, slip: float) -> dict[str, np.ndarray]:
    near, far = (glued.xs((slip, name), level=('slip', 'planner')) for name in (planner, FAR))
    far = far.loc[near.index]
    log_costs = [np.log2(np.maximum(one['states'].to_numpy(float), 1)) for one in (far, near)]
    return {
        'success': near['success'].to_numpy(float) - far['success'].to_numpy(float),
        'log2_cost_ratio': log_costs[0] - log_costs[1],
    }


def loose_towers(trials: pd.DataFrame) -> list[dict[str, Any]]:
    """Success with glued and loose blocks, and falls, of each planner on the towers of people.

    ``people`` is the share of people's attempts that were perfect; they built with simulated
    physics.
    """
    people = read_people()
    known = trials[trials['stimulus'].isin(people.index)]
    known = known[(known['slip'] == 0) & (known['loss'] == 0)]
    means = known.groupby(['stimulus', 'planner', 'blocks_are'])[['success', 'collapsed']].mean()
    rows = []
    for (stimulus, planner), part in means.groupby(['stimulus', 'planner']):
        at = part.droplevel(['stimulus', 'planner'])
        rows.append(
            {
                'stimulus': stimulus,
                'planner': planner,
                'glued': float(at.loc['glued', 'success']),
                'loose': float(at.loc['loose', 'success']),
                'falls': float(at.loc['loose', 'collapsed']),
                'people': float(people.loc[stimulus, 'perfect']),
            }
        )
    return rows
