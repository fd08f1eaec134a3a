"""One attempt of each search on the 16 towers, in full size: success, and cost when it succeeds.

The cost is the mean over silhouettes of the mean over a silhouette's successful attempts. A test
holds a smaller sample of the same against the same numbers.
"""

from __future__ import annotations

from collections.abc import Iterator

from benchmarks.measure import Figure
from benchmarks.search import TASKS
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import AStar, BreadthFirst, RandomPlacement, Search
from blocks_planning.search.solve import solve

SEARCHES: list[Search] = [
    RandomPlacement(),
    *[BreadthFirst(depth) for depth in (1, 2, 3, 4)],
    *[AStar(iterations, 'mean', 'path') for iterations in (8, 64, 4096, 65_536)],
    *[AStar(iterations, 'smallest', 'first') for iterations in (8, 64, 4096)],
]


def one_attempt(search: Search, seeds: int) -> tuple[float, float]:
    """(success over all attempts, mean over silhouettes of their mean cost of success [states])."""
    successes = 0
    means = []
    for task in TASKS:
        problem = Problem(task, 0, task.silhouette)
        results = [solve(problem, search, seed, budget=0) for seed in range(seeds)]
        costs = [result.solution_cost for result in results if result.solved]
        successes += len(costs)
        if costs:
            means.append(sum(costs) / len(costs))
    return successes / (seeds * len(TASKS)), sum(means) / max(1, len(means))


def run(quick: bool) -> Iterator[Figure]:
    """Success and cost."""
    seeds = 4 if quick else 64
    for search in SEARCHES:
        success, cost = one_attempt(search, seeds)
        yield Figure(f'{search}, success', success, '')
        yield Figure(f'{search}, cost', cost, 'states')
