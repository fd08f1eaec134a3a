"""Decisions that weigh rectangles: many solves at once, against solves one by one."""

from __future__ import annotations

import resource
from collections.abc import Iterator
from functools import partial

from benchmarks.measure import Figure, seconds
from blocks_planning.board.geometry import Mask
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.many import cores, solve_many
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.rectangles import rectangles

SEARCH = BreadthFirst(3)


def _problems(task: Task, built: Mask) -> list[Problem]:
    return [Problem(task, built, built | cells) for _, cells in rectangles(task, built)]


def run(quick: bool) -> Iterator[Figure]:
    """Tower 9, bfs of depth 3: a first decision, and what follows each of its rectangles."""
    [stimulus] = find_stimuli('cogsci2021/9')
    task = Task(stimulus.board, stimulus.silhouette)
    first = _problems(task, 0)
    solve_many(first[:2], SEARCH, 0)  # compiles it
    for workers in sorted({1, cores()}):
        took = min(
            seconds(partial(solve_many, first, SEARCH, 0, workers=workers)) for _ in range(3)
        )
        yield Figure(f'{len(first)} rectangles, {workers} threads', took, 's', '< 0.5')
    alone = seconds(lambda: [solve(problem, SEARCH, 0) for problem in first])
    yield Figure('the same, one by one', alone, 's')
    solved = zip(first, solve_many(first, SEARCH, 0), strict=True)
    after = [
        p for before, result in solved if result.solved for p in _problems(task, before.region)
    ]
    if not quick:
        took = seconds(partial(solve_many, after, SEARCH, 0))
        yield Figure(f'{len(after)} rectangles after those', took, 's', '< 20')
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
        yield Figure('largest memory', peak, 'MB', '< 2000')
