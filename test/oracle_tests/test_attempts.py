"""Slow attempts and the random search against numbers worked out in the comments."""

from __future__ import annotations

from oracles.board import EMPTY
from oracles.randomness import Generator, attempt_generator
from oracles.search import attempt, random_choice
from small_boards import LYING, PAPER_LIBRARY, STANDING, full_board, full_task

# Random.


def test_random_draws_once_for_each_placement() -> None:
    task = full_task(2, 2, PAPER_LIBRARY)
    for key in range(20):
        generator = Generator(key)
        choice = random_choice(task, EMPTY, generator)
        assert choice.placements == (task.legal(EMPTY)[Generator(key).below(4)],)
        assert choice.cost == 0
        assert generator.draws == 1


# Attempts.


def test_bfs_attempt_adds_up_its_searches() -> None:
    # Depth 2: 3 + 2 evaluated, columns 0 or 2 executed; then one child, taken up: complete.
    region = full_board(4, 1)
    for seed in range(20):
        result = attempt(4, 1, LYING, region, EMPTY, seed, 0, search='bfs', depth=2)
        column = [0, 2][attempt_generator(seed, EMPTY, region, 1, 0).below(2)]
        assert result.placements == ((2, 1, column, 0), (2, 1, 2 - column, 0))
        assert result.cost == 5 + 1
        assert result.success


def test_astar_attempt_adds_up_its_searches() -> None:
    # execute path: 3 evaluated and two placed, then 1. execute first: 3, then from one block 2.
    region = full_board(1, 6)
    costs = {
        execute: attempt(
            1, 6, STANDING, region, EMPTY, 0, 0, search='astar', iterations=3, execute=execute
        ).cost
        for execute in ('first', 'path')
    }
    assert costs == {'first': 3 + 2, 'path': 3 + 1}


def test_one_generator_serves_a_whole_attempt() -> None:
    # Random on four cells: columns 0 or 2 lead to success (the last placement draws as well),
    # the middle one is stuck.
    region = full_board(4, 1)
    ends = set()
    for seed in range(20):
        result = attempt(4, 1, LYING, region, EMPTY, seed, 7, search='random')
        column = attempt_generator(seed, EMPTY, region, 1, 7).below(3)
        assert result.placements[0] == (2, 1, column, 0)
        assert result.success == (column != 1)
        assert len(result.placements) == (1 if column == 1 else 2)
        ends.add(result.success)
    assert ends == {False, True}


def test_later_draws_of_an_attempt_go_on_with_its_generator() -> None:
    # Random with single cells on a ground of three: three, then two, then one to choose from.
    region = full_board(3, 1)
    for seed in range(20):
        draws = attempt_generator(seed, EMPTY, region, 1, 0)
        free = [0, 1, 2]
        expected = [free.pop(draws.below(len(free))) for _ in range(3)]
        result = attempt(3, 1, ((1, 1),), region, EMPTY, seed, 0, search='random')
        assert [placement.column for placement in result.placements] == expected
