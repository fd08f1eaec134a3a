"""Slow exact counts against numbers worked out in the comments, and against each other."""

from __future__ import annotations

import random

import pytest
from oracles import exact
from oracles.board import EMPTY, Block, Cell, read_picture, rows
from small_boards import DOMINOES, LYING, PAPER_LIBRARY, TOWER_1, TOWER_6, full_board, random_board


@pytest.mark.parametrize(
    ('picture', 'library', 'fewest', 'arrangements'),
    [
        # The square; two standing; two lying.
        ('## ##', PAPER_LIBRARY, 1, 3),
        # A row of n cells with blocks of one and two: Fibonacci 1, 2, 3, 5, 8.
        ('#', ((1, 1), (2, 1)), 1, 1),
        ('##', ((1, 1), (2, 1)), 1, 2),
        ('###', ((1, 1), (2, 1)), 2, 3),
        ('####', ((1, 1), (2, 1)), 2, 5),
        ('#####', ((1, 1), (2, 1)), 3, 8),
        # The same as a column.
        ('# # # # #', ((1, 1), (1, 2)), 3, 8),
        # Dominoes do not fill an odd number of cells.
        ('###', LYING, None, 0),
        ('### ### ###', DOMINOES, None, 0),
        ('### ### ###', PAPER_LIBRARY, None, 0),
        # Two rows of n with dominoes and squares: a(n) = a(n-1) + 2 a(n-2): 1, 3, 5, 11; and
        # for n = 4 the one block of 4 x 2.
        ('### ###', PAPER_LIBRARY, 2, 5),
        ('#### ####', PAPER_LIBRARY, 1, 12),
        # 3 x 3 with cells and dominoes: the centre alone leaves a ring of eight, with
        # 47 (Lucas) matchings; the centre in one of four dominoes leaves a path of seven, with
        # 21 (Fibonacci): 47 + 4 * 21. Nine cells need four dominoes and a cell.
        ('### ### ###', ((1, 1), (1, 2), (2, 1)), 5, 131),
        # The 4 x 4 board has 36 domino tilings.
        ('#### #### #### ####', DOMINOES, 8, 36),
        # A roof on a post: of its four tilings only the whole one does not fall down.
        ('### .#.', ((1, 1), (2, 1), (3, 1)), 2, 1),
        # A ring: ground in one piece or three, two walls, a roof in one piece.
        ('### #.# ###', ((1, 1), (3, 1)), 4, 2),
        # A roof on nothing.
        ('## ..', LYING, None, 0),
        # The step: one lying under nothing that fits.
        ('#. ##', DOMINOES, None, 0),
        ('#. ##', ((1, 1), (1, 2), (2, 1)), 2, 3),
        # Blocks of the same size make no difference.
        ('## ##', ((2, 1), (2, 1)), 2, 1),
        # Nothing to do is one arrangement: that of no blocks.
        ('.. ..', LYING, 0, 1),
    ],
)
def test_exact_by_hand(
    picture: str, library: tuple[Block, ...], fewest: int | None, arrangements: int
) -> None:
    width, height, region = read_picture(picture)
    expected = exact.Exact(fewest, arrangements)
    assert exact.by_dropping(width, height, library, region, EMPTY) == expected
    assert exact.by_tiling(width, height, library, region, EMPTY) == expected


@pytest.mark.parametrize(
    ('built', 'fewest', 'arrangements'),
    [
        # On a 2 x 2 board of dominoes. One standing: the other one.
        ({(0, 0), (0, 1)}, 1, 1),
        # All of it.
        ({(0, 0), (0, 1), (1, 0), (1, 1)}, 0, 1),
        # A single cell leaves three.
        ({(0, 0)}, None, 0),
        # A roof over the ground: what is left could be tiled, but not be reached.
        ({(0, 1), (1, 1)}, None, 0),
        # Something outside the region.
        ({(2, 0)}, None, 0),
    ],
)
def test_exact_from_a_built_state(built: set[Cell], fewest: int | None, arrangements: int) -> None:
    region, state = full_board(2, 2), frozenset(built)
    expected = exact.Exact(fewest, arrangements)
    assert exact.by_dropping(3, 2, DOMINOES, region, state) == expected
    assert exact.by_tiling(3, 2, DOMINOES, region, state) == expected


def test_dropping_in_any_order_is_tiling_with_support() -> None:
    rng = random.Random(20210613)
    filled = 0
    for _ in range(1500):
        board = random_board(rng)
        by_dropping = exact.by_dropping(*board)
        assert by_dropping == exact.by_tiling(*board), board
        filled += by_dropping.fewest_blocks not in (None, 0)
    assert filled > 200


@pytest.mark.parametrize(
    ('picture', 'arrangements', 'fewest'),
    [
        (TOWER_1, 12780, [4, None, 8, 6, 10, 9, 12, 10]),
        (TOWER_6, 748026, [3, 4, 4, None, 7, 10, 9, 12]),
    ],
    ids=['tower 1', 'tower 6'],
)
def test_exact_of_towers(picture: str, arrangements: int, fewest: list[int | None]) -> None:
    width, height, silhouette = read_picture(picture)
    results = [
        exact.by_tiling(width, height, PAPER_LIBRARY, rows(silhouette, k), EMPTY)
        for k in range(1, height + 1)
    ]
    assert [result.fewest_blocks for result in results] == fewest
    assert results[-1].arrangements == arrangements
