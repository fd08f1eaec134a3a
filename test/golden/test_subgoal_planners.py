"""The subgoal planners on the 16 towers, against another implementation's numbers.

That implementation shares the definitions and no code; its numbers come from 4 seeds. Costs are
means over silhouettes of the means of a silhouette's successful runs [states].
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.searches import AStar, BreadthFirst, Search
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.following import follow
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

SEEDS = 4
ROUNDING = 0.05  # relative, of printed costs
TEXT, PUBLISHED = AStar(), AStar(4096, 'mean', 'path')

CASES: list[tuple[Search, Strategy, float, float, float]] = [
    (BreadthFirst(3), NoSubgoals(), 0.48, 39_500, 0),
    (BreadthFirst(3), Scoping(0.0), 1.00, 32_600, 430_000),
    (BreadthFirst(3), Scoping(0.004), 0.94, 5_750, 810_000),
    (BreadthFirst(3), Scoping(0.008), 0.94, 4_140, 1_070_000),
    (BreadthFirst(3), FullSubgoals(), 1.00, 3_850, 9_400_000),
    (PUBLISHED, NoSubgoals(), 0.59, 33_000, 0),
    (PUBLISHED, FullSubgoals(), 0.97, 7_500, 9_800_000),
    (TEXT, NoSubgoals(), 0.53, 30_600, 0),
    (TEXT, FullSubgoals(), 1.00, 106, 9_100_000),
]


def runs(search: Search, strategy: Strategy) -> Iterator[list[TrialRecord]]:
    for s in find_stimuli('cogsci2021'):
        task = Task(s.board, s.silhouette)
        yield [follow(TrialSpec(s.name, task, strategy, search, seed)) for seed in range(SEEDS)]


def standard_error(rows: list[np.ndarray]) -> float:
    """Of the difference between two means over rows, each from a sample like this one."""
    spread = np.array([row.var(ddof=1) if len(row) > 1 else np.nan for row in rows])
    spread[np.isnan(spread)] = np.nanmean(spread)
    counts = np.array([len(row) for row in rows])
    return float(np.sqrt(2 * (spread / counts).sum()) / len(rows))


@pytest.mark.parametrize(
    ('search', 'strategy', 'success', 'action_cost', 'subgoal_cost'),
    CASES,
    ids=[f'{case[0]}-{case[1]}' for case in CASES],
)
def test_success_and_costs(
    search: Search, strategy: Strategy, success: float, action_cost: float, subgoal_cost: float
) -> None:
    done: list[list[TrialRecord]] = []
    solved = []
    for row in runs(search, strategy):
        done.append([record for record in row if record.status is TrialStatus.SUCCESS])
        solved.append(np.array([record.status is TrialStatus.SUCCESS for record in row], float))
    assert abs(np.mean(solved) - success) <= 3 * standard_error(solved) + 0.005
    some = [row for row in done if row]
    for cost, expected in (('action', action_cost), ('subgoal', subgoal_cost)):
        values: list[Any] = [
            np.array([getattr(record, f'{cost}_planning_cost') for record in row], float)
            for row in some
        ]
        found = np.mean([row.mean() for row in values])
        bound = 3 * standard_error(values) + ROUNDING * expected
        assert abs(found - expected) <= bound, cost
