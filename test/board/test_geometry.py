"""The coordinate convention, on boards small enough to count by hand."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import boards

from blocks_planning.board.geometry import MAX_SIDE, Board, area
from blocks_planning.errors import BlocksPlanningError, ConfigurationError

# row 3 |  3  7 11
# row 2 |  2  6 10
# row 1 |  1  5  9
# row 0 |  0  4  8
TALL = Board(width=3, height=4)


@pytest.mark.parametrize(
    ('column', 'row', 'bit'), [(0, 0, 0), (0, 3, 3), (1, 0, 4), (1, 2, 6), (2, 0, 8), (2, 3, 11)]
)
def test_bits_run_up_a_column_then_on_to_the_next(column: int, row: int, bit: int) -> None:
    assert TALL.bit(column, row) == bit
    assert TALL.cell(bit) == (column, row)
    assert TALL.mask([(column, row)]) == 1 << bit


def test_picture_has_the_ground_at_the_bottom() -> None:
    mask = 0b0001_0011_0001
    assert TALL.draw(mask) == '...\n...\n.#.\n###'
    assert TALL.parse(['...', '...', '.#.', '###']) == mask


def test_cells_come_column_by_column_from_the_ground_up() -> None:
    cells = [(0, 1), (0, 3), (1, 0), (2, 2)]
    assert list(TALL.cells(TALL.mask(reversed(cells)))) == cells
    assert list(TALL.cells(0)) == []


def test_size_full_and_ground() -> None:
    assert TALL.size == 12
    assert TALL.full == 0b1111_1111_1111
    assert TALL.ground == 0b0001_0001_0001


@pytest.mark.parametrize(
    ('height', 'mask'),
    [
        (0, 0),
        (1, 0b0001_0001_0001),
        (2, 0b0011_0011_0011),
        (3, 0b0111_0111_0111),
        (4, 0b1111_1111_1111),
    ],
)
def test_rows_below_a_height(height: int, mask: int) -> None:
    assert TALL.rows_below(height) == mask


def test_rectangle_is_named_by_its_lower_left_cell() -> None:
    assert TALL.draw(TALL.rectangle(1, 0, 2, 3)) == '...\n.##\n.##\n.##'
    assert TALL.draw(TALL.rectangle(0, 3, 3, 1)) == '###\n...\n...\n...'
    assert TALL.rectangle(0, 0, 3, 4) == TALL.full


@pytest.mark.parametrize(
    ('mask', 'cells'), [(0, 0), (0b1011, 3), (1 << 255, 1), ((1 << 256) - 1, 256)]
)
def test_area_is_the_number_of_cells(mask: int, cells: int) -> None:
    assert area(mask) == cells


def test_highest_cell_of_the_largest_board() -> None:
    board = Board(MAX_SIDE, MAX_SIDE)
    assert board.bit(15, 15) == 255
    assert board.full == (1 << 256) - 1
    assert board.parse(board.draw(1 << 255).split('\n')) == 1 << 255


@given(boards(), st.data())
def test_masks_cells_and_pictures_say_the_same(board: Board, data: st.DataObject) -> None:
    mask = data.draw(st.integers(0, board.full))
    cells = list(board.cells(mask))
    assert len(cells) == area(mask)
    assert all(0 <= column < board.width and 0 <= row < board.height for column, row in cells)
    assert board.mask(cells) == mask
    picture = board.draw(mask).split('\n')
    assert [len(line) for line in picture] == [board.width] * board.height
    assert {
        (c, r) for r, line in enumerate(reversed(picture)) for c, x in enumerate(line) if x == '#'
    } == set(cells)
    assert board.parse(picture) == mask


@given(boards(), st.data())
def test_rectangles_and_rows_are_the_cells_they_should_be(
    board: Board, data: st.DataObject
) -> None:
    column, row = (
        data.draw(st.integers(0, board.width - 1)),
        data.draw(st.integers(0, board.height - 1)),
    )
    width = data.draw(st.integers(1, board.width - column))
    height = data.draw(st.integers(1, board.height - row))
    cells = {(c, r) for c in range(column, column + width) for r in range(row, row + height)}
    assert set(board.cells(board.rectangle(column, row, width, height))) == cells
    below = board.rows_below(row)
    assert below == board.mask((c, r) for c in range(board.width) for r in range(row))


@pytest.mark.parametrize('side', [0, -1, 17, 10**30, True, 1.0, '3', None, float('nan')], ids=repr)
def test_side_out_of_range_is_refused(side: object) -> None:
    for name, sides in (('width', (side, 3)), ('height', (3, side))):
        with pytest.raises(ConfigurationError) as caught:
            Board(*sides)
        assert str(caught.value) == (
            f'board {name} must be a whole number from 1 to 16, got {side!r}'
        )


def test_number_too_long_to_be_written_is_refused() -> None:
    with pytest.raises(BlocksPlanningError, match='board width must be a whole number'):
        Board(10**5000, 3)
