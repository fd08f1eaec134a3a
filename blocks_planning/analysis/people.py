"""Comparison of people and planners: difficulty of silhouettes, and number of blocks.

People built with simulated physics and a limit of 60 s, and could place blocks outside the
silhouette. So the order of difficulty can be compared, but not the rates of success.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from blocks_planning.analysis.bootstrap import ITERATIONS, NOTHING, Estimate, pearson
from blocks_planning.analysis.trials import planners_of
from blocks_planning.errors import InvalidInput
from blocks_planning.extras import extra
from blocks_planning.resources import resource_directories

with extra('experiments'):
    import pandas as pd
    from scipy.stats import rankdata

SET = 'cogsci2021'
SEED = 20200729

MODELS = (
    ('bfs', 'none', 'success'),
    ('bfs', 'scoping', 'success'),
    ('bfs', 'scoping', 'action_planning_cost'),
    ('bfs', 'full', 'action_planning_cost'),
    ('astar', 'none', 'success'),
    ('astar', 'scoping', 'success'),
    ('astar', 'scoping', 'action_planning_cost'),
    ('astar', 'full', 'action_planning_cost'),
)


def read_people() -> pd.DataFrame:
    """The aggregates per silhouette; the columns are explained in the file. Index: stimulus.

    Raises:
        InvalidInput: if the file is not installed.
    """
    for directory in resource_directories('stimuli'):
        path = Path(directory, f'{SET}.people.csv')
        if path.is_file():
            people = pd.read_csv(path, comment='#')
            people.index = pd.Index([f'{SET}/{tower}' for tower in people['tower']])
            return people
    raise InvalidInput(f'stimuli/{SET}.people.csv is not installed')


def compare_people(trials: pd.DataFrame, preset: str, seed: int = SEED) -> dict[str, Any]:
    """Compare people with each planner of a preset, by silhouette.

    Returns:
        ``perfect``: share of perfect attempts of all, ``ranking``: silhouettes from easy to hard
        with success and blocks, and ``models``: Spearman's rho of each planner's ease with
        people's perfect reconstruction, bootstrapped over silhouettes. Low cost counts as ease.
    """
    people = read_people()
    planners = planners_of(trials, preset)
    planners = planners[planners['stimulus'].isin(people.index)]
    rng = np.random.default_rng(seed)
    ranking = people.sort_values('perfect', ascending=False)
    runs = dict(list(planners.groupby(['search', 'strategy'], observed=True)))
    return {
        'perfect': float(
            (people['perfect'] * people['attempts']).sum() / people['attempts'].sum()
        ),
        'attempts': int(people['attempts'].sum()),
        'ranking': [
            {
                'stimulus': stimulus,
                'perfect': float(row['perfect']),
                'blocks_perfect': float(row['blocks_perfect']),
                **_planners_at(str(stimulus), runs),
            }
            for stimulus, row in ranking.iterrows()
        ],
        'models': [
            {
                'search': search,
                'strategy': strategy,
                'measure': measure,
                **_agreement(people, runs[search, strategy], measure, rng).to_json(),
            }
            for search, strategy, measure in MODELS
            if (search, strategy) in runs
        ],
    }


def _planners_at(stimulus: str, runs: dict[Any, pd.DataFrame]) -> dict[str, Any]:
    """Success and blocks of every planner on a silhouette."""
    found: dict[str, Any] = {}
    for (search, strategy), part in runs.items():
        here = part[part['stimulus'] == stimulus]
        done = here[here['success']]
        found[f'{search}.{strategy}'] = {
            'success': float(here['success'].mean()),
            'blocks': float(done['blocks'].mean()) if len(done) else None,
        }
    return found


def _agreement(
    people: pd.DataFrame, runs: pd.DataFrame, measure: str, rng: np.random.Generator
) -> Estimate:
    if measure == 'success':
        ease = runs.groupby('stimulus', observed=True)[measure].mean()
    else:
        done = runs[runs['success']]
        ease = -done.groupby('stimulus', observed=True)[measure].mean()
    return spearman(
        people['perfect'].to_numpy(float), ease.reindex(people.index).to_numpy(float), rng
    )


def spearman(
    x: np.ndarray, y: np.ndarray, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """Spearman's rho of x and y, float64 (n,), bootstrapped over the pairs.

    Pairs with nan are left out. The interval is nan if fewer than three pairs remain or nothing
    varies; draws in which nothing varies are left out.
    """
    present = ~(np.isnan(x) | np.isnan(y))
    x, y = x[present], y[present]
    if len(x) < 3 or len(set(x)) < 2 or len(set(y)) < 2:
        return NOTHING
    drawn = rng.integers(0, len(x), (iterations, len(x)))
    ranks_x, ranks_y = rankdata(x[drawn], axis=1), rankdata(y[drawn], axis=1)
    rho = np.array([pearson(a, b[None])[0] for a, b in zip(ranks_x, ranks_y, strict=True)])
    low, high = np.nanpercentile(rho, [2.5, 97.5])
    return Estimate(float(pearson(rankdata(x), rankdata(y)[None])[0]), float(low), float(high))
