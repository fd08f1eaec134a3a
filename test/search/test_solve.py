"""The one entrance to search: statuses, budgets and refusals."""

from __future__ import annotations

from typing import Any

import pytest

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, InvalidInput, LimitExceeded
from blocks_planning.search import compiled
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus
from blocks_planning.search.searches import SEARCHES, AStar, BreadthFirst, make_search
from blocks_planning.search.solve import solve

BOARD = Board(3, 3)
SINGLE = Task(BOARD, BOARD.full, (Block(1, 1),))
EVERY_SEARCH = pytest.mark.parametrize('name', SEARCHES)


@EVERY_SEARCH
def test_what_is_filled_already_costs_nothing(name: str) -> None:
    problem = Problem(SINGLE, 0b11, 0b11)
    assert solve(problem, make_search(name, {}), 0) == SolveResult(SolveStatus.SOLVED)


@EVERY_SEARCH
def test_nothing_legal_is_proof_at_no_cost(name: str) -> None:
    tall = Task(BOARD, BOARD.full, (Block(1, 4),))
    result = solve(Problem(tall, 0, BOARD.full), make_search(name, {}), 0)
    assert result == SolveResult(SolveStatus.UNSOLVABLE_PROVEN)


@EVERY_SEARCH
def test_an_odd_number_of_cells_cannot_be_filled_by_dominoes(name: str) -> None:
    dominoes = Task(BOARD, BOARD.full, (Block(1, 2), Block(2, 1)))
    result = solve(Problem(dominoes, 0, BOARD.full), make_search(name, {}), 0, budget=50)
    proven = name == 'exact'
    expected = SolveStatus.UNSOLVABLE_PROVEN if proven else SolveStatus.BUDGET_EXHAUSTED
    assert result.status is expected
    assert result.placements == ()
    assert result.solution_cost == 0


@EVERY_SEARCH
def test_single_cells_fill_any_board_at_the_first_attempt(name: str) -> None:
    result = solve(Problem(SINGLE, 0, BOARD.full), make_search(name, {}), 3)
    assert (result.status, result.attempts) == (SolveStatus.SOLVED, 1)
    assert len(result.placements) == 9
    assert result.planning_cost == result.solution_cost


def test_a_cost_by_hand() -> None:
    """On 2 x 1 cells with single blocks, looking two placements ahead.

    The first search evaluates 2 states, then 1 for each of them. The two complete states are on
    its last level, so only a first placement is executed. The second search evaluates 1 state,
    which is taken up and complete: 5 in all.
    """
    task = Task(Board(2, 1), 0b11, (Block(1, 1),))
    assert solve(Problem(task, 0, 0b11), BreadthFirst(2), 0).planning_cost == 5


@pytest.mark.parametrize(('dead_ends', 'solved'), [('worst', True), ('ignored', False)])
def test_dead_ends_by_hand(dead_ends: str, solved: bool) -> None:
    """A row of 4 cells with blocks of 3 and 2: after the 3 nothing fits, and it fills more."""
    task = Task(Board(4, 1), 0b1111, (Block(3, 1), Block(2, 1)))
    for seed in range(5):
        result = solve(Problem(task, 0, 0b1111), BreadthFirst(1, dead_ends), seed, budget=0)
        assert result.solved is solved


def test_random_placement_ends_although_it_costs_nothing() -> None:
    dominoes = Task(BOARD, BOARD.full, (Block(1, 2), Block(2, 1)))
    result = solve(Problem(dominoes, 0, BOARD.full), make_search('random', {}), 0, budget=50)
    assert (result.attempts, result.planning_cost) == (50, 0)


def test_a_budget_of_zero_is_one_attempt() -> None:
    dominoes = Task(BOARD, BOARD.full, (Block(1, 2), Block(2, 1)))
    for name in ('random', 'bfs', 'astar'):
        assert solve(Problem(dominoes, 0, BOARD.full), make_search(name, {}), 0, 0).attempts == 1


@pytest.mark.parametrize('iterations', [5_000, 200_000])
def test_the_queue_grows_without_a_trace(iterations: int, monkeypatch: pytest.MonkeyPatch) -> None:
    board = Board(9, 9)
    problem = Problem(Task(board, board.full, (Block(1, 2), Block(2, 1))), 0, board.full)
    search = AStar(iterations, 'largest', 'path')
    expected = solve(problem, search, 1, 0)
    monkeypatch.setattr(compiled, '_MOST_NODES_AT_FIRST', 300)
    assert solve(problem, search, 1, 0) == expected


def test_a_queue_over_its_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(compiled, '_MOST_NODES_AT_FIRST', 300)
    monkeypatch.setattr(compiled, 'MAX_NODES', 5_000)
    board = Board(9, 9)
    problem = Problem(Task(board, board.full, (Block(1, 2), Block(2, 1))), 0, board.full)
    search = AStar(5_000, 'largest', 'path')
    with pytest.raises(LimitExceeded, match=r'outgrows .* nodes; allow fewer iterations'):
        search.run(problem, 1, 0, CancelToken())
    assert solve(problem, search, 1, 0).status is SolveStatus.LIMIT_EXCEEDED


@pytest.mark.parametrize(
    ('built', 'region'), [(0b100, 0b11), (-1, 0b11), (0, 1 << 9), (0, -1)], ids=str
)
def test_a_region_off_the_board_or_off_what_is_built_is_refused(built: int, region: int) -> None:
    with pytest.raises(InvalidInput, match='region'):
        Problem(SINGLE, built, region)


@pytest.mark.parametrize(
    ('name', 'settings', 'message'),
    [
        ('dfs', {}, "search must be one of bfs, .*, got 'dfs'"),
        ('bfs', {'depth': 0}, 'depth must be a whole number from 1 to 64, got 0'),
        ('bfs', {'depth': True}, 'depth .* got True'),
        ('bfs', {'depth': 2.0}, 'depth .* got 2.0'),
        (
            'bfs',
            {'iterations': 8},
            "search bfs has no setting 'iterations'; it has depth, dead_ends",
        ),
        ('bfs', {'dead_ends': 'last'}, "dead_ends must be one of worst, ignored, got 'last'"),
        ('random', {'depth': 1}, "search random has no setting 'depth'; it has none"),
        ('astar', {'iterations': 1}, 'iterations must be a whole number from 2 to .*, got 1'),
        ('astar', {'divisor': 'median'}, "divisor must be one of .*, got 'median'"),
        ('best_first', {'execute': 'all'}, "execute must be one of first, path, got 'all'"),
    ],
)
def test_bad_settings_are_refused(name: str, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        make_search(name, settings)


@pytest.mark.parametrize(('seed', 'budget'), [(-1, 0), (1 << 64, 0), (0, -1), (0, 1 << 63)])
def test_bad_seeds_and_budgets_are_refused(seed: int, budget: int) -> None:
    with pytest.raises(ConfigurationError, match='must be a whole number from 0'):
        solve(Problem(SINGLE, 0, 0b11), BreadthFirst(), seed, budget)


@EVERY_SEARCH
def test_the_highest_seed_and_budget_are_fine(name: str) -> None:
    problem = Problem(SINGLE, 0, BOARD.full)
    assert solve(problem, make_search(name, {}), (1 << 64) - 1, (1 << 63) - 1).solved
