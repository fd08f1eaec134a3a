from __future__ import annotations

from math import radians

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.board.geometry import Board
from blocks_planning.robot.coverage import Sighting, cover, rectangle
from blocks_planning.robot.fitting import Change, Misfit, Perceived, change, fit

BOARD = Board(6, 6)


def seen(number: int, block: Block, x: float, z: float, degrees: float = 0.0) -> Sighting:
    """A block by its middle, in cells."""
    half = block.width / 2, block.height / 2
    coverage = cover(rectangle((x, z), half, radians(degrees)), 1.0)
    off = degrees % 90
    return Sighting(number, block, coverage, min(off, 90 - off))


def kinds(state: Perceived) -> list[tuple[int, Misfit]]:
    return [(remark.number, remark.kind) for remark in state.warnings]


def test_blocks_on_the_grid_need_no_remark() -> None:
    state = fit(BOARD, [seen(0, Block(2, 1), 2, 0.5), seen(1, Block(1, 2), 1.5, 2)], 0.25)
    assert state.blocks == ((0, Placed(2, 1, 1, 0)), (1, Placed(1, 2, 1, 1)))
    assert state.warnings == ()
    assert state.built(BOARD) == BOARD.mask([(1, 0), (2, 0), (1, 1), (1, 2)])


def test_small_errors_are_rounded_away_and_larger_ones_said() -> None:
    assert fit(BOARD, [seen(0, Block(2, 1), 2.1, 0.6)], 0.25).warnings == ()
    state = fit(BOARD, [seen(0, Block(2, 1), 2.3, 0.5)], 0.25)
    assert state.placed == (Placed(2, 1, 1, 0),)
    assert kinds(state) == [(0, Misfit.DISPLACED)]


def test_tilted_block_gets_the_cells_that_it_covers_most() -> None:
    state = fit(BOARD, [seen(0, Block(4, 2), 3, 1.2, 15)], 0.25)
    assert state.placed == (Placed(4, 2, 1, 0),)
    assert kinds(state) == [(0, Misfit.TILTED)]
    assert '15 degrees' in state.warnings[0].text


def test_block_on_its_side_has_its_sides_swapped() -> None:
    state = fit(BOARD, [seen(0, Block(1, 2), 3, 0.5, 90)], 0.25)
    assert state.placed == (Placed(2, 1, 2, 0),)
    assert state.warnings == ()


def test_block_that_stands_beyond_the_board_is_left_out() -> None:
    state = fit(BOARD, [seen(0, Block(2, 1), -0.1, 0.5), seen(1, Block(2, 1), 8, 0.5)], 0.25)
    assert state.placed == ()
    assert kinds(state) == [(0, Misfit.OFF_BOARD), (1, Misfit.OFF_BOARD)]
    assert state.is_possible


def test_blocks_that_are_seen_in_one_another_are_set_apart() -> None:
    below = seen(0, Block(2, 2), 2, 1)
    state = fit(BOARD, [seen(1, Block(2, 2), 2.1, 2.4), below], 0.25)
    assert state.blocks == ((0, Placed(2, 2, 1, 0)), (1, Placed(2, 2, 1, 2)))
    # Half a cell above row 1 is nearest to row 1, which is taken.
    assert kinds(state) == [(1, Misfit.CORRECTED)]


def test_block_in_the_air_makes_the_state_impossible() -> None:
    state = fit(BOARD, [seen(0, Block(2, 1), 2, 4.5)], 0.25)
    assert state.placed == ()
    assert kinds(state) == [(0, Misfit.IMPOSSIBLE)]
    assert not state.is_possible


def test_every_state_rests_and_overlaps_nothing() -> None:
    heap = [seen(n, Block(2, 1), 1.5 + 0.7 * n, 0.5 + 0.8 * (n % 3), 7 * n) for n in range(5)]
    state = fit(BOARD, heap, 0.25)
    built = 0
    for placed in sorted(state.placed, key=lambda one: one.row):
        cells = BOARD.rectangle(placed.column, placed.row, placed.width, placed.height)
        assert not cells & built
        assert placed.row == 0 or cells >> 1 & built
        built |= cells


def test_change_names_what_landed_and_what_is_gone() -> None:
    first, moved, new = Placed(2, 1, 0, 0), Placed(2, 1, 1, 0), Placed(1, 2, 4, 0)
    before = Perceived(((0, first),))
    assert change(before, Perceived(((0, first), (1, new)))) == Change((new,), ())
    assert change(before, Perceived(((0, moved), (1, new)))) == Change((moved, new), (first,))
    assert change(before, before) == Change((), ())
