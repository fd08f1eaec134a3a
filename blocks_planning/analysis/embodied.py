"""Planners with a body: success, surprises and costs by robot, and what goes wrong.

Every number is a mean over towers of the means over seeds. Intervals (95 %) come from a bootstrap
over towers and seeds, as in :mod:`.uncertainty`.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from typing import Any, TypeAlias

import numpy as np

from blocks_planning.analysis.uncertainty import ByTower, Resampling

Row: TypeAlias = dict[str, Any]
NEAR, FAR = 'scoping subgoal', 'full replan'
"""The planners that are compared."""
MEASURES: dict[str, Callable[[Row], float]] = {
    'success': lambda row: float(row['success']),
    'f1': lambda row: float(row['f1']),
    'blocks': lambda row: float(row['blocks']),
    'acts': lambda row: float(row['acts']),
    'surprises': lambda row: float(row['surprises']),
    'states': lambda row: float(row['states']),
    'seconds_per_act': lambda row: float(row['simulated_s']) / max(1, row['acts']),
}
"""What is measured in each trial; ``seconds_per_act`` is simulated time [s]."""


def summarise(rows: list[Row]) -> dict[str, Any]:
    """The content of the report, as data.

    Args:
        rows: of the trials; see :func:`.robot.study.run_case` for their keys.

    Returns:
        ``cells``: each planner with each robot, with an estimate of each measure, the ends of its
        trials, outcomes of its acts, reasons of failures, and how often a trial with a
        surprise was a success; ``advantages``: of :data:`NEAR` over :data:`FAR` by robot, in
        success and in the binary logarithm of the states evaluated.
    """
    robots = list(dict.fromkeys(row['robot'] for row in rows))
    planners = list(dict.fromkeys(row['planner'] for row in rows))
    by_cell = {
        (robot, planner): [
            row for row in rows if (row['robot'], row['planner']) == (robot, planner)
        ]
        for robot in robots
        for planner in planners
    }
    towers = len({row['stimulus'] for row in rows})
    seeds = sorted({row['seed'] for row in rows})
    resampling = Resampling.of(towers, len(seeds))
    return {
        'trials': len(rows),
        'towers': towers,
        'seeds': seeds,
        'contradictions': sum(len(row['contradictions']) for row in rows),
        'cells': [_cell(*place, part, resampling) for place, part in by_cell.items()],
        'advantages': [
            _advantage(robot, by_cell[robot, NEAR], by_cell[robot, FAR], resampling)
            for robot in robots
            if {NEAR, FAR} <= set(planners)
        ],
    }


def _cell(robot: str, planner: str, rows: list[Row], resampling: Resampling) -> dict[str, Any]:
    surprised = [row for row in rows if row['surprises']]
    values = {name: _by_tower(rows, measure, resampling) for name, measure in MEASURES.items()}
    return {
        'robot': robot,
        'planner': planner,
        **{name: resampling.over_towers(one).to_json() for name, one in values.items()},
        'ends': _total({row['status']: 1} for row in rows),
        'outcomes': _total(row['codes'] for row in rows),
        'failures': _total(row['failures'] for row in rows),
        'surprised': len(surprised),
        'recovered': sum(row['success'] for row in surprised),
    }


def _advantage(
    robot: str, near: list[Row], far: list[Row], resampling: Resampling
) -> dict[str, Any]:
    """Scoping minus full planning in success, and full divided by scoping in costs."""
    success, states = (
        [_by_tower(rows, MEASURES[name], resampling) for rows in (near, far)]
        for name in ('success', 'states')
    )
    gains = {
        'success': success[0].minus(success[1]),
        'log2_cost_ratio': states[1].log2().minus(states[0].log2()),
    }
    found = {name: resampling.over_towers(gain).to_json() for name, gain in gains.items()}
    return {'robot': robot, **found}


def _by_tower(rows: list[Row], measure: Callable[[Row], float], resampling: Resampling) -> ByTower:
    """A measure; rows must have every seed of each tower."""
    table: dict[str, dict[int, float]] = {}
    for row in rows:
        table.setdefault(row['stimulus'], {})[row['seed']] = measure(row)
    values = [[by_seed[seed] for seed in sorted(by_seed)] for by_seed in table.values()]
    return resampling.by_tower(np.array(values))


def _total(counts: Iterable[dict[str, int]]) -> dict[str, int]:
    total: Counter[str] = Counter()
    for one in counts:
        total.update(one)
    return dict(sorted(total.items()))


def answers(results: dict[str, Any]) -> list[str]:
    """A sentence for each robot: what scoping gains over full planning."""
    return [
        f'{one["robot"]}: scoping rebuilds {_points(one["success"])} points more towers than full '
        f'planning that replans, and evaluates {_times(one["log2_cost_ratio"])} times fewer states.'
        for one in results['advantages']
    ]


def _points(estimate: dict[str, Any]) -> str:
    mean, (low, high) = estimate['mean'], estimate['ci']
    return f'{100 * mean:.0f} ({100 * low:.0f} to {100 * high:.0f})'


def _times(estimate: dict[str, Any]) -> str:
    mean, (low, high) = estimate['mean'], estimate['ci']
    return f'{2**mean:.1f} ({2**low:.1f} to {2**high:.1f})'
