"""Planners under uncertainty: success, regret and costs by world, and a comparison.

Every number is a mean over towers of the means over seeds. Intervals (95 %) are percentiles of a
bootstrap over towers and seeds: both are drawn with replacement, independently. A seed stands for
the same slips and losses in every tower (:mod:`blocks_planning.worlds.world`), so towers alone would
describe only part of the variation. Costs are over all trials, successful or not, and
count every evaluated state, including those of plans that were not executed to the end.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.analysis.bootstrap import ITERATIONS, Estimate, estimate_of
from blocks_planning.analysis.people import read_people
from blocks_planning.analysis.trials import read_measured
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
    trials = read_measured(folder)
    return trials.assign(
        planner=[_planner(row) for row in trials.to_dict('records')],
        collapsed=(trials['status'] == 'collapsed').to_numpy(float),
        plans=trials['decisions'],
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
    seeds = [int(seed) for seed in sorted(trials['seed'].unique())]
    resampling = Resampling.of(len(best), len(seeds))
    return {
        'trials': len(trials),
        'seeds': seeds,
        'cells': list(_cells(trials, best, resampling)),
        'optima': [
            {
                'slip': float(slip),
                **resampling.over_towers(_same_in_every_seed(best[slip].to_numpy())).to_json(),
            }
            for slip in best
        ],
        'advantage': advantages(trials, resampling),
        'loose': loose_towers(trials),
    }


@dataclass(frozen=True)
class Resampling:
    """A bootstrap over towers and seeds, the same one for every number.

    Attributes:
        towers: share of each tower in each iteration, float64 (iterations, towers).
        seeds: share of each seed in each iteration, float64 (iterations, seeds).
    """

    towers: np.ndarray
    seeds: np.ndarray

    @classmethod
    def of(cls, towers: int, seeds: int, iterations: int = ITERATIONS) -> Resampling:
        """Draw that many towers and seeds with replacement."""
        rng = np.random.default_rng(SEED)
        return cls(
            *(rng.multinomial(n, np.full(n, 1 / n), iterations) / n for n in (towers, seeds))
        )

    def by_tower(self, table: np.ndarray) -> ByTower:
        """The means over seeds of a value per tower and seed, float64 (towers, seeds)."""
        return ByTower(table.mean(axis=1), self.seeds @ table.T)

    def over_towers(self, values: ByTower) -> Estimate:
        """The mean over towers, with its interval."""
        drawn = (values.drawn * self.towers).sum(axis=1)
        return estimate_of(drawn, float(values.mean.mean()))


class ByTower(NamedTuple):
    """A value per tower, float64 (towers,), and the same in each iteration of the bootstrap,
    float64 (iterations, towers).
    """

    mean: np.ndarray
    drawn: np.ndarray

    def minus(self, other: ByTower) -> ByTower:
        """The differences, paired by tower and iteration."""
        return ByTower(self.mean - other.mean, self.drawn - other.drawn)

    def log2(self) -> ByTower:
        """The binary logarithms; values below 1 count as 1."""
        return ByTower(*(np.log2(np.maximum(one, 1)) for one in self))


def _same_in_every_seed(values: np.ndarray) -> ByTower:
    return ByTower(values, values[None, :])


def table_of(trials: pd.DataFrame, measure: str) -> np.ndarray:
    """A measure by tower and seed, both in order, float64 (towers, seeds)."""
    table = trials.pivot_table(index='stimulus', columns='seed', values=measure, dropna=False)
    values: np.ndarray = table.to_numpy(float)
    return values


def _cells(trials: pd.DataFrame, best: pd.DataFrame, resampling: Resampling) -> Any:
    for place, part in trials.groupby([*_WORLD, 'planner'], observed=True):
        slip, loss, blocks, planner = place
        values = {name: resampling.by_tower(table_of(part, name)) for name in MEASURES}
        if blocks == 'glued':
            optimum = _same_in_every_seed(best[slip].to_numpy(float))
            values['regret'] = optimum.minus(values['success'])
        found = {name: resampling.over_towers(one).to_json() for name, one in values.items()}
        yield {'slip': slip, 'loss': loss, 'blocks_are': blocks, 'planner': planner, **found}


def advantages(trials: pd.DataFrame, resampling: Resampling) -> list[dict[str, Any]]:
    """The advantage of looking one subgoal ahead over planning all subgoals, by planner and slip.

    For each scoping planner: the difference in success, the ratio of states evaluated (full
    planning divided by scoping), and how much both have changed since slip 0, paired by tower and
    seed.
    """
    glued = trials[(trials['loss'] == 0) & (trials['blocks_are'] == 'glued')]
    slips = sorted(glued['slip'].unique())
    near = sorted(planner for planner in glued['planner'].unique() if NEAR in planner)
    rows = []
    for planner in near:
        start = _gains(glued, planner, slips[0], resampling)
        for slip in slips:
            gains = _gains(glued, planner, slip, resampling)
            row: dict[str, Any] = {'planner': planner, 'slip': slip}
            for name, gain in gains.items():
                row[name] = resampling.over_towers(gain).to_json()
                row[f'{name}_change'] = resampling.over_towers(gain.minus(start[name])).to_json()
            rows.append(row)
    return rows


def _gains(
    glued: pd.DataFrame, planner: str, slip: float, resampling: Resampling
) -> dict[str, ByTower]:
    at = glued[glued['slip'] == slip]
    near, far = (
        {
            name: resampling.by_tower(table_of(at[at['planner'] == one], name))
            for name in ('success', 'states')
        }
        for one in (planner, FAR)
    )
    return {
        'success': near['success'].minus(far['success']),
        'log2_cost_ratio': far['states'].log2().minus(near['states'].log2()),
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
