"""The one entrance to search: statuses, budgets and refusals."""

from __future__ import annotations

from typing import Any

import pytest

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, InvalidInput, LimitExceeded
from blocks_planning.search import memory
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus
from blocks_planning.search.searches import AStar, BreadthFirst, make_search, search_names
from blocks_planning.search.solve import solve

BOARD = Board(3, 3)
SINGLE = Task(BOARD, BOARD.full, (Block(1, 1),))
EVERY_SEARCH = pytest.mark.parametrize('name', search_names())


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
    monkeypatch.setattr(memory, '_MOST_NODES_AT_FIRST', 300)
    assert solve(problem, search, 1, 0) == expected


def test_a_queue_over_its_limit_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memory, '_MOST_NODES_AT_FIRST', 300)
    monkeypatch.setattr(memory, 'MAX_NODES', 5_000)
    board = Board(9, 9)
    problem = Problem(Task(board, board.full, (Block(1, 2), Block(2, 1))), 0, board.full)
    search = AStar(5_000, 'largest', 'path')
    with pytest.raises(LimitExceeded, match=r'exceeds .* nodes; allow fewer iterations'):
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
        ('beam', {'width': 0}, 'width must be a whole number from 1 to 1000000, got 0'),
        ('mcts', {'iterations': 0}, 'iterations must be a whole number from 1 to .*, got 0'),
        ('mcts', {'exploration': -0.1}, 'exploration must be a finite number from 0 .*got -0.1'),
        ('best_first', {'execute': 'all'}, "execute must be one of first, path, got 'all'"),
    ],
)
def test_bad_settings_are_refused(name: str, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        make_search(name, settings)


def test_a_beam_by_hand() -> None:
    """Four cells in a row and blocks of 3, 2 and 1, with one state kept.

    It generates 2 places of the 3, 3 of the 2 and 4 of the 1: 9 states, and keeps a 3. Then only
    the 1 fits, in one place: 10 states, and complete.
    """
    task = Task(Board(4, 1), 0b1111, (Block(3, 1), Block(2, 1), Block(1, 1)))
    result = solve(Problem(task, 0, 0b1111), make_search('beam', {'width': 1}), 0)
    assert (result.status, result.planning_cost) == (SolveStatus.SOLVED, 10)
    assert sorted(placed.width for placed in result.placements) == [1, 3]


def test_a_beam_that_is_wider_keeps_what_leads_on() -> None:
    """With blocks of 3 and 2 the 3 fills more and leads nowhere; a beam of 3 keeps a 2 as well.

    The two places of a 3 and the three of a 2 are 5 states. After the 3s nothing fits. If the 2
    that is kept lies at an end, one more fits, and else none.
    """
    task = Task(Board(4, 1), 0b1111, (Block(3, 1), Block(2, 1)))
    problem = Problem(task, 0, 0b1111)
    outcomes = {
        (result.solved, result.planning_cost)
        for result in (solve(problem, make_search('beam', {'width': 3}), s, 0) for s in range(40))
    }
    assert outcomes == {(True, 6), (False, 5)}
    assert not any(
        solve(problem, make_search('beam', {'width': 2}), s, 0).solved for s in range(9)
    )
    assert all(solve(problem, make_search('beam', {'width': 5}), s, 0).solved for s in range(9))


def test_a_tree_search_by_hand() -> None:
    """Two cells in a column and blocks of one cell: each walk places all that is left.

    The first search makes 3 walks: into the first child, with one more placement outside the
    tree (2 states); into the child of that (1 state); and past both, which ends there (none). The
    second search finds one child without placements: 1 state. 4 in all.
    """
    task = Task(Board(1, 2), 0b11, (Block(1, 1),))
    result = solve(Problem(task, 0, 0b11), make_search('mcts', {'iterations': 3}), 0)
    assert (result.status, result.planning_cost) == (SolveStatus.SOLVED, 4)


def test_a_tree_search_goes_where_more_gets_filled() -> None:
    """With blocks of 3 and 2 on four cells, one 3 fills 3 of them, two 2 fill all."""
    task = Task(Board(4, 1), 0b1111, (Block(3, 1), Block(2, 1)))
    problem = Problem(task, 0, 0b1111)
    greedy = make_search('mcts', {'iterations': 200, 'exploration': 0.1})
    assert all(solve(problem, greedy, seed, 0).solved for seed in range(10))
    few = make_search('mcts', {'iterations': 1})
    assert not all(solve(problem, few, seed, 0).solved for seed in range(10))


@pytest.mark.parametrize(
    ('name', 'settings', 'limit', 'message'),
    [
        (
            'beam',
            {'width': 5_000},
            'MAX_BEAM_NODES',
            'the beam of the search exceeds 1200 nodes; .* width',
        ),
        (
            'mcts',
            {'iterations': 5_000},
            'MAX_TREE_NODES',
            'the tree of the search exceeds 1200 nodes',
        ),
    ],
)
def test_memory_grows_without_a_trace_up_to_a_limit(
    name: str,
    settings: dict[str, Any],
    limit: str,
    message: str,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    board = Board(6, 6)
    problem = Problem(Task(board, board.full, (Block(1, 2), Block(2, 1))), 0, board.full)
    search = make_search(name, settings)
    expected = solve(problem, search, 1, 0)
    monkeypatch.setattr(memory, '_MOST_NODES_AT_FIRST', 300)
    assert solve(problem, search, 1, 0) == expected
    monkeypatch.setattr(memory, limit, 2_000)
    with pytest.raises(LimitExceeded, match=message):
        search.run(problem, 1, 0, CancelToken())
    assert solve(problem, search, 1, 0).status is SolveStatus.LIMIT_EXCEEDED


@pytest.mark.parametrize(('seed', 'budget'), [(-1, 0), (1 << 64, 0), (0, -1), (0, 1 << 63)])
def test_bad_seeds_and_budgets_are_refused(seed: int, budget: int) -> None:
    with pytest.raises(ConfigurationError, match='must be a whole number from 0'):
        solve(Problem(SINGLE, 0, 0b11), BreadthFirst(), seed, budget)


@EVERY_SEARCH
def test_the_highest_seed_and_budget_are_fine(name: str) -> None:
    problem = Problem(SINGLE, 0, BOARD.full)
    assert solve(problem, make_search(name, {}), (1 << 64) - 1, (1 << 63) - 1).solved
