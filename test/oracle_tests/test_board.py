"""How blocks fall on plain sets of cells, and which placements there are."""

from __future__ import annotations

import pytest
from oracles.board import (
    EMPTY,
    Placement,
    cells_of,
    drop,
    is_dead,
    legal_placements,
    possible_placements,
    read_picture,
    rows,
)
from small_boards import PAPER_LIBRARY, STEP, full_board


def test_read_picture_puts_the_ground_at_the_bottom() -> None:
    assert read_picture(STEP) == (2, 2, frozenset({(0, 0), (1, 0), (0, 1)}))
    with pytest.raises(ValueError, match='not a row'):
        read_picture('##\n#')
    with pytest.raises(ValueError, match='not a row'):
        read_picture('#x')


def test_blocks_rest_on_the_highest_cell_under_them() -> None:
    state = frozenset({(0, 0), (2, 0), (2, 1)})
    assert drop(EMPTY, (2, 2), 1) == Placement(2, 2, 1, 0)
    assert drop(state, (1, 2), 0).row == 1
    assert drop(state, (1, 2), 1).row == 0
    assert drop(state, (2, 1), 0).row == 1
    assert drop(state, (3, 1), 0).row == 2


def test_cells_of_a_placement() -> None:
    assert cells_of(Placement(2, 1, 3, 4)) == {(3, 4), (4, 4)}
    assert cells_of(Placement(1, 2, 3, 4)) == {(3, 4), (3, 5)}


def test_placements_come_block_by_block_from_left_to_right() -> None:
    assert possible_placements(2, 2, PAPER_LIBRARY, EMPTY) == [
        (1, 2, 0, 0),
        (1, 2, 1, 0),
        (2, 1, 0, 0),
        (2, 2, 0, 0),
    ]
    assert possible_placements(2, 2, ((2, 2), (1, 2)), EMPTY) == [
        (2, 2, 0, 0),
        (1, 2, 0, 0),
        (1, 2, 1, 0),
    ]


def test_possible_is_inside_the_board() -> None:
    # On one cell in the left of a 2 x 2 board: standing blocks fit in the right column only,
    # a lying one bridges, a square does not fit any more.
    state = frozenset({(0, 0)})
    assert possible_placements(2, 2, PAPER_LIBRARY, state) == [(1, 2, 1, 0), (2, 1, 0, 1)]


def test_legal_is_inside_the_region() -> None:
    width, height, step = read_picture(STEP)
    legal = legal_placements(width, height, PAPER_LIBRARY, step, EMPTY)
    assert legal == [(1, 2, 0, 0), (2, 1, 0, 0)]


def test_dead_is_an_empty_target_cell_under_a_filled_one() -> None:
    region = full_board(2, 2)
    assert is_dead(region, frozenset({(0, 0), (0, 1), (1, 1)}))
    assert not is_dead(region, frozenset({(0, 0), (0, 1)}))
    # The empty cell under the bridge is no target.
    assert not is_dead(region - {(1, 0)}, frozenset({(0, 0), (0, 1), (1, 1)}))


def test_rows_are_the_lowest() -> None:
    step = read_picture(STEP)[2]
    assert rows(step, 0) == EMPTY
    assert rows(step, 1) == {(0, 0), (1, 0)}
    assert rows(step, 2) == step
