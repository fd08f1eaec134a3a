"""Slow solving of a region against numbers worked out in the comments."""

from __future__ import annotations

import pytest
from oracles import solving
from oracles.board import EMPTY
from oracles.randomness import attempt_generator
from small_boards import LYING, STANDING, full_board


def test_solve_of_a_filled_region_does_nothing() -> None:
    region = full_board(2, 1)
    solution = solving.solve(2, 1, LYING, region, region, 0, search='bfs', depth=1)
    assert solution == solving.Solution('solved', (), 0, 0, 0)


def test_solve_proves_when_nothing_is_legal() -> None:
    region = full_board(2, 1)
    solution = solving.solve(2, 1, STANDING, region, EMPTY, 0, search='bfs', depth=1)
    assert solution == solving.Solution('unsolvable_proven', (), 0, 0, 0)


FAILED = 'budget_exhausted'


def test_solve_finishes_the_attempt_that_crosses_the_budget() -> None:
    # Three cells, blocks of two: each attempt evaluates 2 and fails. 2, 4, 6 >= 5.
    region = full_board(3, 1)
    solution = solving.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=5)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 6, 3)
    assert len(solution.last_attempt) == 1
    solution = solving.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=4)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 4, 2)
    solution = solving.solve(3, 1, LYING, region, EMPTY, 0, search='bfs', depth=1, budget=0)
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 2, 1)


@pytest.mark.parametrize(('budget', 'attempts'), [(0, 1), (1, 1), (5, 5)])
def test_solve_makes_as_many_free_attempts_as_the_budget_has_states(
    budget: int, attempts: int
) -> None:
    solution = solving.solve(
        3, 1, LYING, full_board(3, 1), EMPTY, 0, search='random', budget=budget
    )
    assert (solution.status, solution.planning_cost, solution.attempts) == (FAILED, 0, attempts)
    assert (solution.placements, solution.solution_cost) == ((), 0)


def test_solve_adds_up_attempts_until_one_succeeds() -> None:
    # astar with 2 iterations on four cells: with column 1 an attempt fails at 3; with 0 or 2 it
    # evaluates 4, then 1, and succeeds.
    region = full_board(4, 1)
    seen = set()
    for seed in range(30):
        failures = 0
        while True:
            draws = attempt_generator(seed, EMPTY, region, 1, failures)
            draws.below(1)
            if draws.below(3) != 1:
                break
            failures += 1
        solution = solving.solve(4, 1, LYING, region, EMPTY, seed, search='astar', iterations=2)
        assert solution.status == 'solved'
        assert solution.attempts == failures + 1
        assert solution.solution_cost == 5
        assert solution.planning_cost == 3 * failures + 5
        seen.add(failures)
    assert {0, 1, 2} <= seen


def test_solve_asks_for_a_region_that_contains_what_is_built() -> None:
    with pytest.raises(ValueError, match='outside the region'):
        solving.solve(2, 1, LYING, EMPTY, frozenset({(0, 0)}), 0, search='bfs', depth=1)
