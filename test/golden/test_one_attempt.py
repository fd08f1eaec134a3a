"""One attempt of each search on the 16 towers, against another implementation's numbers.

That implementation shares the definitions and no code; its numbers come from 64 seeds. The cost
is the mean over silhouettes of the mean cost of a silhouette's successful attempts.
"""

from __future__ import annotations

import numpy as np
import pytest

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import AStar, BreadthFirst, Search
from blocks_planning.search.solve import solve

SEEDS = 64
ROUNDING = 0.005

CASES: list[tuple[Search, float, float]] = [
    (BreadthFirst(1), 0.07, 86),
    (BreadthFirst(2), 0.15, 1490),
    (BreadthFirst(3), 0.22, 24_600),
    (AStar(8, 'mean', 'path'), 0.11, 125),
    (AStar(64, 'mean', 'path'), 0.10, 441),
    (AStar(4096, 'mean', 'path'), 0.29, 10_560),
    (AStar(8, 'smallest', 'first'), 0.12, 211),
    (AStar(64, 'smallest', 'first'), 0.21, 168),
    (AStar(4096, 'smallest', 'first'), 0.28, 3_170),
]


def one_attempt(search: Search) -> tuple[np.ndarray, np.ndarray]:
    """Success, and cost [states] (nan without success), (16, SEEDS)."""
    results = [
        [
            solve(Problem(Task(s.board, s.silhouette), 0, s.silhouette), search, seed, budget=0)
            for seed in range(SEEDS)
        ]
        for s in find_stimuli('cogsci2021')
    ]
    solved = np.array([[result.solved for result in row] for row in results])
    costs = np.array([[result.solution_cost for result in row] for row in results], float)
    return solved, np.where(solved, costs, np.nan)


@pytest.mark.parametrize(('search', 'success', 'cost'), CASES, ids=[str(c[0]) for c in CASES])
def test_success_and_cost(search: Search, success: float, cost: float) -> None:
    solved, costs = one_attempt(search)
    # Two samples of the same size: the standard error of their difference.
    error = np.sqrt(2 * (solved.var(axis=1, ddof=1) / SEEDS).sum()) / len(solved)
    assert abs(solved.mean() - success) <= 3 * error + ROUNDING
    rows = costs[solved.any(axis=1)]
    means = np.nanmean(rows, axis=1)
    counts = (~np.isnan(rows)).sum(axis=1)
    # A tower that succeeded once says nothing of its spread: take that of the others.
    spread = np.nanstd(rows[counts > 1], axis=1, ddof=1).mean()
    error = np.sqrt(2 * (spread**2 / counts).sum()) / len(rows)
    # Towers that are solved once in a while may be in one sample and not in the other.
    rare = means[counts <= 3].sum() / len(rows)
    assert abs(means.mean() - cost) <= 3 * error + rare
