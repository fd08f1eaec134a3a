"""The compiled searches against their slow twins, attempt by attempt and draw by draw."""

from __future__ import annotations

import random
from typing import Any

import pytest
from oracles import search as oracle_search
from oracles import solving
from oracles.breadth_first import count_tree
from oracles.tree import Task as PlainTask
from problems import random_problem

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_nodes
from blocks_planning.search.result import CancelToken
from blocks_planning.search.searches import SEARCHES, make_search, search_names
from blocks_planning.search.solve import solve
from blocks_planning.settings import all_settings

TWINS = oracle_search.SEARCHES
SETTINGS: dict[str, list[dict[str, Any]]] = {
    'random': [{}],
    'bfs': [
        {'depth': depth, 'dead_ends': dead_ends}
        for depth in (1, 2, 3, 4)
        for dead_ends in ('worst', 'ignored')
    ],
    'astar': [
        {'iterations': iterations, 'divisor': divisor, 'execute': execute}
        for iterations in (2, 9, 64)
        for divisor in ('smallest', 'mean', 'largest')
        for execute in ('first', 'path')
    ],
    'best_first': [
        {'iterations': iterations, 'execute': execute}
        for iterations in (2, 30)
        for execute in ('first', 'path')
    ],
    'beam': [{'width': width} for width in (1, 2, 3, 10, 50)],
    'mcts': [
        {'iterations': iterations, 'exploration': exploration}
        for iterations in (1, 5, 60)
        for exploration in (0.0, 0.5, 3.0)
    ],
}
"""The settings with which each search is held to its twin."""
OTHERWISE = {'exact', 'stable_bfs', 'stable_random'}
"""Searches that are held to other twins: test_exact.py, test_stable.py."""
CASES = [
    (name, settings)
    for name in search_names()
    if name not in OTHERWISE
    for settings in SETTINGS.get(name, [])
]
IDS = ['-'.join(map(str, [name, *settings.values()])) for name, settings in CASES]


@pytest.mark.parametrize('name', search_names())
def test_every_search_has_a_twin_and_settings_to_be_held_to_it(name: str) -> None:
    if name in OTHERWISE:
        return
    assert name in TWINS
    for setting in all_settings(SEARCHES[name]):
        tried = {settings[setting.name] for settings in SETTINGS[name]}
        assert tried >= set(setting.choices), f'{setting.name} is not tried with every word'
        assert len(tried) > 1, f'{setting.name} is tried with one value only'


@pytest.mark.parametrize(('name', 'settings'), CASES, ids=IDS)
def test_a_solve_is_that_of_the_slow_twin(name: str, settings: dict[str, Any]) -> None:
    source = random.Random(name + str(settings))
    for _ in range(12):
        problem = random_problem(source)
        board = problem.task.board
        seed, budget = source.getrandbits(64), source.choice([0, 30, 300])
        expected = solving.solve(
            board.width,
            board.height,
            [(block.width, block.height) for block in problem.task.library],
            frozenset(board.cells(problem.region)),
            frozenset(board.cells(problem.built)),
            seed,
            search=name,
            budget=budget,
            **settings,
        )
        result = solve(problem, make_search(name, settings), seed, budget)
        assert result.status.value == expected.status
        assert [tuple(p) for p in result.placements] == [tuple(p) for p in expected.placements]
        assert result.solution_cost == expected.solution_cost
        assert result.planning_cost == expected.planning_cost
        assert result.attempts == expected.attempts


def test_counts_are_those_of_the_slow_twin() -> None:
    source = random.Random(5)
    for _ in range(30):
        task = random_problem(source).task
        library = tuple((block.width, block.height) for block in task.library)
        region = frozenset(task.board.cells(task.silhouette))
        twin = PlainTask(task.board.width, task.board.height, library, region)
        expected = [count_tree(twin, frozenset(), depth) for depth in (1, 2, 3)]
        assert count_nodes(task, 3, CancelToken()) == expected


def test_counts_by_hand() -> None:
    """A full 3 x 3 board and one block of 1 x 1: three columns, each with three places.

    Depth 1: 3. Depth 2: 3 * 3 = 9. Depth 3: 27. Depth 4: of the 27, the 3 that filled one column
    have 2 children, the other 24 have 3: 78. Summed: 3, 12, 39, 117.
    """
    board = Board(3, 3)
    task = Task(board, board.full, (Block(1, 1),))
    assert count_nodes(task, 4, CancelToken()) == [3, 12, 39, 117]


def test_counting_goes_on_past_complete_states() -> None:
    """A 2 x 1 board and 1 x 1 blocks: 2 children, then 1 each, and then nothing."""
    task = Task(Board(2, 1), 0b11, (Block(1, 1),))
    assert count_nodes(task, 5, CancelToken()) == [2, 4, 4, 4, 4]
