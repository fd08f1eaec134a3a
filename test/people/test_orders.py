"""Measures of the order of building, on small builds by hand and against a readable twin."""

from __future__ import annotations

import random

import builders
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracles import board as slow
from oracles import orders as oracle

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.people import orders
from blocks_planning.people.families import family_names, find_family

# Two wide blocks on the ground and two on top of them.
WALL = builders.task('####/####')
FLAT = (Placed(2, 1, 0, 0), Placed(2, 1, 2, 0), Placed(2, 1, 2, 1), Placed(2, 1, 0, 1))
TOWERS = (FLAT[0], FLAT[3], FLAT[1], FLAT[2])


def test_upwards_counts_from_the_second_placement_on() -> None:
    assert orders.upwards(WALL, FLAT) == (3, 3)
    assert orders.upwards(WALL, TOWERS) == (2, 3)
    assert orders.upwards(WALL, FLAT[:1]) == (0, 0)
    assert orders.upwards(WALL, ()) == (0, 0)


def test_rightwards_looks_at_steps_on_a_level_only() -> None:
    assert orders.rightwards(WALL, FLAT) == (1, 2)
    assert orders.rightwards(WALL, TOWERS) == (0, 0)
    assert orders.rightwards(WALL, (FLAT[0], FLAT[0])) == (0, 0)


def test_lowest_row_is_that_of_the_first_target_cell_still_empty() -> None:
    assert orders.lowest_row(WALL, FLAT) == (4, 4)
    assert orders.lowest_row(WALL, TOWERS) == (3, 4)


def test_lowest_row_stops_when_the_silhouette_is_complete() -> None:
    assert orders.lowest_row(WALL, (*FLAT, Placed(1, 2, 0, 2))) == (4, 4)


def test_block_outside_is_no_part_of_what_is_built() -> None:
    outside = Placed(2, 1, 3, 0)
    assert orders.inside(WALL, (outside, *FLAT)) == (4, 5)
    assert orders.lowest_row(WALL, (outside, FLAT[0])) == (2, 2)
    assert orders.perfect(WALL, (outside, *FLAT)) == (0, 1)


@pytest.mark.parametrize(
    'placed', [Placed(2, 1, -1, 0), Placed(2, 1, 3, 0), Placed(1, 2, 0, 1), Placed(2, 1, 0, -1)]
)
def test_block_over_the_edge_of_the_board_is_not_inside(placed: Placed) -> None:
    assert orders.inside(WALL, (placed,)) == (0, 1)


def test_perfect_is_the_silhouette_and_no_block_too_many() -> None:
    assert orders.perfect(WALL, FLAT) == (1, 1)
    assert orders.perfect(WALL, FLAT[:3]) == (0, 1)
    assert orders.perfect(WALL, (*FLAT, FLAT[0])) == (0, 1)


@pytest.mark.parametrize(
    ('family', 'placements', 'hits'),
    [
        ('rows', FLAT, 4),
        ('rows', TOWERS, 3),  # after the first block, all that is left is a region
        ('rectangles', FLAT, 4),
        ('rectangles', TOWERS, 4),
        ('rows', FLAT[:3], 2),
        ('rows', (*FLAT[:2], FLAT[0], *FLAT[2:]), 4),  # a block in the way counts for no run
    ],
)
def test_described(family: str, placements: tuple[Placed, ...], hits: int) -> None:
    describer = orders.Describer(find_family(family))
    assert describer.described(WALL, placements) == (hits, len(placements))


def test_one_block_and_the_whole_silhouette_describe_nothing() -> None:
    task = builders.task('####')
    whole = (Placed(2, 1, 0, 0), Placed(2, 1, 2, 0))
    for family in map(find_family, family_names()):
        assert orders.Describer(family).described(task, whole) == (0, 2)


@st.composite
def builds(draw: st.DrawFn) -> tuple[Task, tuple[Placed, ...]]:
    """Up to seven blocks dropped on a small board; the silhouette holds most of them."""
    board = Board(draw(st.integers(2, 5)), draw(st.integers(2, 5)))
    blocks = builders.task('#').library
    states, placements = [0], []
    for _ in range(draw(st.integers(0, 7))):
        possible = list(rules.possible_placements(board, states[-1], blocks))
        if not possible:
            break
        placements.append(draw(st.sampled_from(possible)))
        states.append(states[-1] | rules.cells_of(board, placements[-1]))
    silhouette = states[-1]
    if draw(st.booleans()):
        silhouette &= ~draw(st.integers(0, board.full)) | draw(st.integers(0, board.full))
    return Task(board, silhouette), tuple(placements)


@pytest.mark.parametrize('family', family_names())
@settings(max_examples=60, deadline=None)
@given(builds())
def test_described_is_what_the_twin_says(
    family: str, build: tuple[Task, tuple[Placed, ...]]
) -> None:
    task, placements = build
    board = task.board
    hits, chances = orders.Describer(find_family(family)).described(task, placements)
    assert chances == len(placements)
    assert hits == oracle.described(
        family,
        board.width,
        board.height,
        frozenset(board.cells(task.silhouette)),
        [slow.Placement(*placed) for placed in placements],
    )


@given(builds(), st.integers(0, 99))
def test_shuffled_order_drops_every_block_where_it_was(
    build: tuple[Task, tuple[Placed, ...]], seed: int
) -> None:
    task, placements = build
    built = 0
    drawn = orders.shuffled(placements, random.Random(seed))
    assert sorted(drawn) == sorted(placements)
    for placed in drawn:
        assert rules.drop(task.board, built, placed.placement) == placed
        built |= rules.cells_of(task.board, placed)


def test_shuffled_orders_differ() -> None:
    drawn = {orders.shuffled(FLAT, random.Random(seed)) for seed in range(40)}
    # Two blocks on the ground, each with one on top: six orders.
    assert len(drawn) == 6
