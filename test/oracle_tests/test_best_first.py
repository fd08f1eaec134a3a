"""Slow A* and best-first search against numbers worked out in the comments."""

from __future__ import annotations

from typing import Any

import pytest
from oracles.best_first import (
    Queue,
    astar_choice,
    best_first_choice,
    f_largest,
    f_left_only,
    f_mean,
    f_smallest,
)
from oracles.board import EMPTY
from oracles.randomness import Generator
from oracles.tree import Node
from small_boards import LYING, PAPER_LIBRARY, STANDING, full_task


def test_f_is_the_float_of_its_formula() -> None:
    # Areas 2, 2, 4, 8, 8: their mean is 24 / 5.
    assert f_mean(PAPER_LIBRARY, 2, 10) == 2 + 10 / 4.8
    assert f_smallest(PAPER_LIBRARY, 2, 10) == 7
    assert f_largest(PAPER_LIBRARY, 2, 10) == 3.25
    # Five blocks more and 24 cells less make no difference, but to the last bit of the float.
    assert f_mean(PAPER_LIBRARY, 0, 24) == f_mean(PAPER_LIBRARY, 5, 0)
    assert f_mean(PAPER_LIBRARY, 0, 28) != f_mean(PAPER_LIBRARY, 5, 4)
    assert f_left_only(PAPER_LIBRARY, 2, 10) == 10


def test_queue_fills_the_gap_with_the_last_node() -> None:
    key = next(key for key in range(100) if Generator(key).below(4) == 1)
    nodes = [Node(frozenset({(column, 0)}), ()) for column in range(5)]
    queue = Queue()
    queue.add(9, nodes[4])
    for node in nodes[:4]:
        queue.add(3, node)
    assert queue.take(Generator(key)) is nodes[1]
    assert queue.lists[3] == [nodes[0], nodes[3], nodes[2]]
    for left in (3, 2, 1):
        generator = Generator(key)
        expected = queue.lists[3][Generator(key).below(left)]
        assert queue.take(generator) is expected
        assert generator.draws == 1
    assert queue.take(Generator(key)) is nodes[4]
    assert queue.is_empty()


def test_astar_takes_the_lowest_f() -> None:
    # 2 g + left: 4 for each single domino, 2 for the square, which is complete.
    generator = Generator(0)
    choice = astar_choice(full_task(2, 2, PAPER_LIBRARY), EMPTY, generator, iterations=2)
    assert choice.placements == ((2, 2, 0, 0),)
    assert choice.cost == 4
    assert generator.draws == 2


def test_astar_draws_for_the_root_too() -> None:
    # All f are 4. Iteration 2 takes one of three columns; the middle one has no children.
    for key in range(20):
        draws = Generator(key)
        draws.below(1)
        column = draws.below(3)
        choice = astar_choice(full_task(4, 1, LYING), EMPTY, Generator(key), iterations=2)
        assert choice.placements == ((2, 1, column, 0),)
        assert choice.cost == (3 if column == 1 else 4)


def test_astar_ends_with_the_last_node_taken_when_the_queue_runs_empty() -> None:
    # Columns 0 and 1, both dead ends: the one that is taken second is the result.
    for key in range(20):
        draws = Generator(key)
        draws.below(1)
        first = draws.below(2)
        generator = Generator(key)
        choice = astar_choice(full_task(3, 1, LYING), EMPTY, generator, iterations=10)
        assert choice.placements == ((2, 1, 1 - first, 0),)
        assert choice.cost == 2
        assert generator.draws == 3


def test_astar_counts_the_children_of_the_last_node_taken() -> None:
    # A column of three standing blocks: root, 1, 2 are taken, one child each.
    task = full_task(1, 6, STANDING)
    first = astar_choice(task, EMPTY, Generator(0), iterations=3, execute='first')
    whole = astar_choice(task, EMPTY, Generator(0), iterations=3, execute='path')
    assert first.cost == whole.cost == 3
    assert first.placements == ((1, 2, 0, 0),)
    assert whole.placements == ((1, 2, 0, 0), (1, 2, 0, 2))


def test_best_first_leaves_out_what_was_placed() -> None:
    # Two cells, blocks of one, largest block three: astar has f = 3 + 1 for either cell and
    # 6 + 0 for both, so iteration 3 takes the other cell; best-first has 1, 1 and 0.
    task = full_task(2, 1, ((1, 1), (1, 3)))
    for key in range(20):
        astar = astar_choice(task, EMPTY, Generator(key), iterations=3, divisor='largest')
        assert len(astar.placements) == 1
        assert astar.cost == 2 + 1 + 1
        best_first = best_first_choice(task, EMPTY, Generator(key), iterations=3)
        assert len(best_first.placements) == 2
        assert best_first.cost == 2 + 1


def test_divisors_change_the_order() -> None:
    # Four cells in a column, blocks of one, two and eight (which fits nowhere). Children of the
    # root: one (left 3), two (left 2).
    # smallest 1: f = g + left: 4, 3; then two+one 2 + 1 = 3, two+two 2 + 0 = 2: taken, complete.
    # largest 8: f = 8 g + left: 11, 10; then 17, 16: iteration 3 takes one: three children.
    # mean 11 / 3: f = 11 g + 3 left: 20, 17; then 25, 22: iteration 3 takes one as well.
    task = full_task(1, 4, ((1, 1), (1, 2), (1, 8)))
    costs = {
        divisor: astar_choice(task, EMPTY, Generator(0), iterations=3, divisor=divisor).cost
        for divisor in ('smallest', 'mean', 'largest')
    }
    assert costs == {'smallest': 2 + 2, 'mean': 2 + 2 + 2, 'largest': 2 + 2 + 2}


@pytest.mark.parametrize(
    ('settings', 'message'),
    [({'iterations': 1}, 'iterations'), ({'iterations': 2, 'execute': 'all'}, 'execute')],
)
def test_astar_settings_are_checked(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        astar_choice(full_task(2, 2, LYING), EMPTY, Generator(0), **settings)
