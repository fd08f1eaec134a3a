"""Action-level search: states evaluated per second, against the readable twins in one run."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

import numpy as np
from oracles.best_first import astar_choice
from oracles.breadth_first import bfs_choice
from oracles.randomness import attempt_generator
from oracles.tree import Task as PlainTask

from benchmarks.measure import Figure, best_rate, seconds
from blocks_planning.board.kernels.masks import pack
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import tables_of
from blocks_planning.search.exact import analyse
from blocks_planning.search.kernels import breadth_first, lookahead
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import AStar, Beam, Search, TreeSearch
from blocks_planning.search.solve import solve

TASKS = [Task(s.board, s.silhouette) for s in find_stimuli('cogsci2021')]
TWIN_TOWERS = (5, 6)  # those with the smallest trees: the twin takes its time
DEPTH = 4


def _bfs_decisions(tasks: list[Task]) -> int:
    states = 0
    for task in tasks:
        tables = tables_of(task, task.silhouette)
        search = lookahead.make_search(tables, DEPTH)
        moves, weights = np.zeros((2, task.board.width * len(task.library)), np.int64)
        empty, cancel = pack([0], tables.cells), np.zeros(1, np.uint8)
        evaluated, _, _ = breadth_first.choices_from(
            search, tables, empty, 0, cancel, moves, weights
        )
        states += evaluated
    return states


def _twin(task: Task) -> PlainTask:
    board = task.board
    library = tuple((block.width, block.height) for block in task.library)
    return PlainTask(board.width, board.height, library, frozenset(board.cells(task.silhouette)))


def _twin_bfs_decisions(tasks: list[Task]) -> int:
    states = 0
    for task in tasks:
        generator = attempt_generator(0, frozenset(), _twin(task).region, task.board.height, 0)
        states += bfs_choice(_twin(task), frozenset(), generator, depth=DEPTH).cost
    return states


def _astar(iterations: int, seeds: int) -> int:
    search = AStar(iterations, 'mean', 'path')
    problems = [Problem(task, 0, task.silhouette) for task in TASKS]
    return sum(
        solve(problem, search, seed, budget=0).planning_cost
        for problem in problems
        for seed in range(seeds)
    )


def _twin_astar(iterations: int) -> int:
    states = 0
    for task in (TASKS[number - 1] for number in TWIN_TOWERS):
        generator = attempt_generator(0, frozenset(), _twin(task).region, task.board.height, 0)
        states += astar_choice(
            _twin(task),
            frozenset(),
            generator,
            iterations=iterations,
            divisor='mean',
            execute='path',
        ).cost
    return states


def _attempts(search: Search) -> int:
    problems = [Problem(task, 0, task.silhouette) for task in TASKS]
    return sum(solve(problem, search, 0, budget=0).planning_cost for problem in problems)


def run(quick: bool) -> Iterator[Figure]:
    """Rates on one core."""
    few = [TASKS[number - 1] for number in TWIN_TOWERS]
    rate = best_rate(lambda: _bfs_decisions(TASKS), 3 if quick else 20)
    same = best_rate(lambda: _bfs_decisions(few), 20)
    twin_rate = best_rate(lambda: _twin_bfs_decisions(few), 1)
    yield Figure('bfs decisions, depth 4, 16 towers', rate / 1e6, 'million states/s', '>= 200')
    yield Figure('the same, towers 5 and 6', same / 1e6, 'million states/s')
    yield Figure('readable twin, towers 5 and 6', twin_rate, 'states/s')
    yield Figure('ratio on the same towers', same / twin_rate, 'x', '>= 20,000')
    astar = best_rate(lambda: _astar(4096, 1 if quick else 4), 3)
    yield Figure('astar 4096, mean, path, 16 towers', astar / 1e6, 'million states/s', '>= 5')
    large = best_rate(lambda: _astar(65_536, 1), 1 if quick else 2)
    yield Figure('astar 65 536, mean, path, 16 towers', large / 1e6, 'million states/s', '>= 5')
    twin_astar = best_rate(lambda: _twin_astar(512), 1)
    yield Figure('astar, ratio to the readable twin (512 iterations)', astar / twin_astar, 'x')
    for search in (Beam(1000), TreeSearch(1000)):
        rate = best_rate(partial(_attempts, search), 1 if quick else 3)
        yield Figure(f'{search.name} with 1000, 16 towers', rate / 1e6, 'million states/s')
    analyse(TASKS[0])
    exact = seconds(lambda: [analyse(task) for task in TASKS])
    yield Figure('exact, 16 towers with all row prefixes', exact, 's', '< 0.2')
