"""Where blocks land in a world that slips and loses them: the distribution, and draws from it."""

from __future__ import annotations

import random
from fractions import Fraction

import pytest
from oracles.board import Placement as PlainPlacement
from oracles.randomness import Generator as PlainGenerator
from oracles.randomness import key_from_words
from oracles.slipping import outcomes
from oracles.tree import Task as PlainTask
from problems import random_problem

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.board.slipping import DRAW_STEPS, Landing, landings, pick
from blocks_planning.errors import ConfigurationError, InvalidInput
from blocks_planning.search.landing import draw_landing

SQUARE = Block(2, 2)


def test_lands_left_right_and_as_ordered_on_what_is_there() -> None:
    board = Board(5, 4)
    built = board.mask([(0, 0)])
    assert landings(board, built, Placement(SQUARE, 1), slip=0.5, loss=0.25) == (
        Landing(0.25, None),
        Landing(0.1875, Placed(2, 2, 0, 1)),
        Landing(0.1875, Placed(2, 2, 2, 0)),
        Landing(0.375, Placed(2, 2, 1, 0)),
    )


@pytest.mark.parametrize('column', [0, 3])
def test_lands_as_ordered_where_the_board_ends(column: int) -> None:
    found = landings(Board(5, 4), 0, Placement(SQUARE, column), slip=0.5)
    beside = 1 if column == 0 else 2
    assert found == (
        Landing(0.25, Placed(2, 2, beside, 0)),
        Landing(0.75, Placed(2, 2, column, 0)),
    )


def test_lands_as_ordered_where_it_would_be_too_high() -> None:
    board = Board(5, 4)
    built = board.rectangle(0, 0, 1, 3)
    found = landings(board, built, Placement(SQUARE, 1), slip=0.5)
    assert [landing.placed and landing.placed.column for landing in found] == [2, 1]
    assert [landing.probability for landing in found] == [0.25, 0.75]


def test_obeys_without_slip_and_loss() -> None:
    found = landings(Board(5, 4), 0, Placement(SQUARE, 1), slip=0)
    assert found == (Landing(1.0, Placed(2, 2, 1, 0)),)


def test_loses_everything() -> None:
    found = landings(Board(5, 4), 0, Placement(SQUARE, 1), slip=0.3, loss=1)
    assert found == (Landing(1.0, None),)


def test_agrees_with_its_twin() -> None:
    source = random.Random(3)
    for _ in range(200):
        problem = random_problem(source)
        task, board = problem.task, problem.task.board
        possible = list(rules.possible_placements(board, problem.built, task.library))
        if not possible:
            continue
        order = source.choice(possible)
        slip, loss = Fraction(source.randrange(9), 8), Fraction(source.randrange(5), 4)
        state = frozenset(board.cells(problem.built))
        plain = PlainTask(board.width, board.height, (), frozenset())
        expected = outcomes(plain, state, PlainPlacement(*order), slip, loss)
        found = landings(board, problem.built, order.placement, float(slip), float(loss))
        assert {landing.placed: landing.probability for landing in found} == {
            None if place is None else Placed(*place): float(chance)
            for place, chance in expected.items()
        }


def test_draws_every_outcome_over_exactly_its_share_of_the_steps() -> None:
    outcomes = landings(Board(5, 4), 0, Placement(SQUARE, 1), slip=0.5, loss=0.125)
    reached = 0
    for landing in outcomes:
        first = reached
        reached += int(landing.probability * DRAW_STEPS)
        for drawn in (first, reached - 1):
            assert pick(outcomes, lambda _, drawn=drawn: drawn) is landing  # type: ignore[misc]
    assert reached == DRAW_STEPS


def test_draws_have_the_probabilities_of_the_distribution() -> None:
    """Chi-square over many seeds, and over many sequences of one seed."""
    board, order = Board(5, 4), Placement(SQUARE, 1)
    expected = landings(board, 0, order, slip=0.3, loss=0.2)
    number = 4000
    for asked in (((seed, 1) for seed in range(number)), ((5, n) for n in range(number))):
        drawn = [draw_landing(board, 0, order, 0.3, 0.2, *words) for words in asked]
        counts = [drawn.count(landing) for landing in expected]
        assert sum(counts) == number
        square = sum(
            (count - number * landing.probability) ** 2 / (number * landing.probability)
            for count, landing in zip(counts, expected, strict=True)
        )
        assert square < 16.3  # of 3 degrees of freedom; 99.9 %


def test_draw_is_made_of_seed_and_sequence() -> None:
    """Draws must never change, as records hold them."""
    board, order = Board(5, 4), Placement(SQUARE, 1)
    for seed, sequence in ((7, 1), (7, 2), (7, 3), (8, 1), (2**64 - 1, 4), (0, 200)):
        generator = PlainGenerator(key_from_words([seed, sequence, 0x646C726F77]))
        share = generator.below(2**53) / 2**53
        column = None if share < 0.25 else 0 if share < 0.4375 else 2 if share < 0.625 else 1
        found = draw_landing(board, 0, order, 0.5, 0.25, seed, sequence).placed
        assert (None if found is None else found.column) == column


def test_order_that_is_not_possible() -> None:
    with pytest.raises(InvalidInput, match=r'order 2x2 at column 4 is not possible.*5 x 4 cells'):
        landings(Board(5, 4), 0, Placement(SQUARE, 4), slip=0.1)


@pytest.mark.parametrize('value', [-0.1, 1.1, float('nan'), True, '0.1'])
def test_probability_out_of_range(value: float) -> None:
    order = Placement(SQUARE, 1)
    with pytest.raises(ConfigurationError, match='slip must be a number from 0 to 1, got'):
        landings(Board(5, 4), 0, order, slip=value)
    with pytest.raises(ConfigurationError, match='loss must be a number from 0 to 1, got'):
        landings(Board(5, 4), 0, order, slip=0.1, loss=value)
