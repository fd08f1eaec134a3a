"""Reasons why a number differs from the paper's, as far as our own trials can show them.

Each way of counting of the published analysis that the text does not mention is tried on our
trials. If it makes our number agree, it is a measured reason. The seed of each draw is fixed, so
the reasons are reproducible.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from blocks_planning.analysis.bootstrap import (
    ITERATIONS,
    NOTHING,
    Estimate,
    Groups,
    draw,
    effect_of,
    estimate_of,
    mean_of_present,
    pearson,
)
from blocks_planning.analysis.paper import Claim
from blocks_planning.analysis.trials import groups_of, planners_of, single_attempts_of
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

SEED = 20210726
_COSTS = ('action_planning_cost', 'subgoal_planning_cost', 'states_evaluated')


@dataclass(frozen=True)
class Counting:
    """Another way of counting.

    Attributes:
        words: description, to follow "counted with".
        applies: whether it is applicable to a claim.
        measure: our number, counted in this way; nan if undefined.
    """

    words: str
    applies: Callable[[Claim], bool]
    measure: Callable[[pd.DataFrame, str, Claim], Estimate]


def _measure_of(claim: Claim) -> str:
    last = claim.path[-1]
    return str(last['measure'] if isinstance(last, Mapping) else last)


def _is_difference(claim: Claim) -> bool:
    return claim.path[0] == 'differences'


def _is_correlation(claim: Claim) -> bool:
    return claim.path[0] == 'lambda'


def _parts(trials: pd.DataFrame, preset: str, claim: Claim) -> list[pd.DataFrame]:
    """The trials that a claim is about: of one planner, or of the two of a difference."""
    if claim.path[0] == 'table1':
        chosen: Any = claim.path[1]
        alone = single_attempts_of(trials, preset)
        for setting, value in chosen.items():
            alone = alone[(alone[setting] == value).to_numpy(bool)]
        return [alone]
    planners = planners_of(trials, preset)
    of = claim.path[1]
    if isinstance(of, Mapping):
        planners = planners[planners['search'] == of['search']]
        return [planners[planners['strategy'] == of[side]] for side in ('first', 'second')]
    strategy = 'scoping' if _is_correlation(claim) else claim.path[2]
    return [planners[(planners['search'] == of) & (planners['strategy'] == strategy)]]


def _drawn(trials: pd.DataFrame, column: str, rng: np.random.Generator, once: bool) -> np.ndarray:
    """Mean over silhouettes of one drawn run each, float64 (iterations,).

    ``once``: the run is drawn from all runs, and a failed one drops out; else from successful ones.
    """
    groups: Groups = groups_of(trials, column)
    if once:
        with_gaps = trials.assign(**{column: trials[column].where(trials['success'])})
        groups = all_runs(with_gaps, column)
    return mean_of_present(draw(groups, rng))


def all_runs(trials: pd.DataFrame, column: str) -> Groups:
    """The values of all runs, successful or not, by silhouette."""
    return groups_of(trials.assign(success=True), column)


def _combine(parts: list[np.ndarray]) -> Estimate:
    """A level of one distribution, or an effect of the difference of two."""
    values = parts[0] if len(parts) == 1 else parts[0] - parts[1]
    values = values[np.isfinite(values)]
    if not len(values):
        return NOTHING
    mean = float(values.mean())
    return estimate_of(values, mean) if len(parts) == 1 else effect_of(values, mean)


def _column(claim: Claim) -> str:
    measure = _measure_of(claim)
    return 'solution_cost' if measure == 'states_evaluated' else measure


def _by_own_silhouettes(trials: pd.DataFrame, preset: str, claim: Claim) -> Estimate:
    rng = np.random.default_rng(SEED)
    parts = _parts(trials, preset, claim)
    return _combine([_drawn(part, _column(claim), rng, once=False) for part in parts])


def _of_one_solve(trials: pd.DataFrame, preset: str, claim: Claim) -> Estimate:
    rng = np.random.default_rng(SEED)
    parts = _parts(trials, preset, claim)
    return _combine([_drawn(part, _column(claim), rng, once=True) for part in parts])


def _over_all_runs(trials: pd.DataFrame, preset: str, claim: Claim) -> Estimate:
    rng = np.random.default_rng(SEED)
    parts = _parts(trials, preset, claim)
    return _combine([mean_of_present(draw(all_runs(part, 'blocks'), rng)) for part in parts])


def _with_one_seed(trials: pd.DataFrame, preset: str, claim: Claim) -> Estimate:
    """r of lambda with the runs of one drawn seed per silhouette, the same at every lambda."""
    [scoping] = _parts(trials, preset, claim)
    measure = _measure_of(claim)
    values = scoping[measure].astype(float)
    if measure != 'success':
        values = values.where(scoping['success'])
    table = values.groupby(
        [scoping['stimulus'], scoping['seed'], scoping['lambda']], observed=True
    )
    cube = table.first().unstack('lambda')
    levels = cube.columns.to_numpy(float)
    rng = np.random.default_rng(SEED)
    curves = [part.to_numpy() for _, part in cube.groupby(level='stimulus', observed=True)]
    drawn = np.stack([curve[rng.integers(0, len(curve), ITERATIONS)] for curve in curves], axis=2)
    r = pearson(levels, mean_of_present(drawn))
    r = r[np.isfinite(r)]
    return effect_of(r, float(r.mean())) if len(r) else NOTHING


COUNTINGS = (
    Counting(
        'each planner over the silhouettes that it rebuilt itself, not over those of both, as in the '
        'published analysis',
        _is_difference,
        _by_own_silhouettes,
    ),
    Counting(
        'one solve per silhouette that drops out if it fails, as in the published tables',
        lambda claim: not _is_correlation(claim) and _measure_of(claim) in _COSTS,
        _of_one_solve,
    ),
    Counting(
        'all runs, failed ones with the blocks that they placed, as in the published analysis (the '
        'text says successful ones)',
        lambda claim: _is_difference(claim) and _measure_of(claim) == 'blocks',
        _over_all_runs,
    ),
    Counting(
        'the same drawn seed at every lambda, as the published tables have one solve for all of them',
        _is_correlation,
        _with_one_seed,
    ),
)
