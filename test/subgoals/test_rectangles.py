"""Rectangles as regions, held to their readable twin and to what is known of small towers."""

from __future__ import annotations

import builders
import pytest
from hypothesis import given
from hypothesis import strategies as st
from oracles import regions as oracle

from blocks_planning.board.geometry import Board, area
from blocks_planning.board.task import Task
from blocks_planning.subgoals.rectangles import rectangles


@st.composite
def situations(draw: st.DrawFn) -> tuple[Task, int]:
    """A board of up to 6 x 6 cells with any silhouette, and any cells of it (or not) built."""
    board = Board(draw(st.integers(1, 6)), draw(st.integers(1, 6)))
    masks = st.integers(0, board.full)
    silhouette = draw(masks) | draw(masks)
    return Task(board, silhouette), draw(masks) & draw(masks) & draw(masks)


@given(situations(), st.integers(0, 4), st.sampled_from([0, 0, 3, 6, 36]))
def test_rectangles_are_those_of_the_twin(
    situation: tuple[Task, int], fewest: int, most: int
) -> None:
    task, built = situation
    board = task.board
    fewest = max(1, fewest)
    expected = oracle.rectangles(
        board.width,
        board.height,
        frozenset(board.cells(task.silhouette)),
        frozenset(board.cells(built)),
        fewest,
        most,
    )
    found = rectangles(task, built, fewest, most)
    assert [(label, frozenset(board.cells(cells))) for label, cells in found] == [
        (('rectangle', sides), cells) for sides, cells in expected
    ]


@given(situations())
def test_no_two_rectangles_have_the_same_cells(situation: tuple[Task, int]) -> None:
    cells = [cells for _, cells in rectangles(*situation)]
    assert len(set(cells)) == len(cells)


def found(rows: str, built: str | None = None, **sizes: int) -> list[tuple[int, ...]]:
    """Sides of the rectangles of a tower, given what is built as a picture."""
    task = builders.task(rows)
    mask = 0 if built is None else builders.picture(built)[1]
    return [sides for (_, sides), _ in rectangles(task, mask, **sizes)]


def test_order_is_by_row_column_height_and_width() -> None:
    assert found('##/##', max_cells=4) == [(0, 0, 2, 1), (0, 0, 1, 2), (0, 0, 2, 2), (1, 0, 1, 2)]


def test_three_quarters_of_the_silhouette_is_the_most_by_default() -> None:
    # Of 4 cells 3 are allowed, of 7 cells 5.
    assert (0, 0, 4, 1) not in found('####')
    assert (0, 0, 3, 1) in found('####')
    assert (0, 0, 5, 1) in found('#######')
    assert (0, 0, 6, 1) not in found('#######')


def test_two_cells_are_the_fewest_by_default() -> None:
    assert min(width * height for _, _, width, height in found('###')) == 2
    assert (1, 0, 1, 1) in found('###', min_cells=1)


def test_edge_without_target_cell_is_refused() -> None:
    assert found('#.#', max_cells=9) == [(0, 0, 3, 1)]


def test_built_cell_inside_is_refused() -> None:
    assert found('##/##', '../#.', max_cells=9) == [(1, 0, 1, 2), (0, 1, 2, 1)]


@pytest.mark.parametrize(('built', 'expected'), [('..../....', False), ('..../...#', True)])
def test_region_rests_on_the_ground_or_on_a_built_cell(built: str, expected: bool) -> None:
    assert ((0, 1, 4, 1) in found('####/...#', built, max_cells=9)) is expected


def test_large_board_is_not_slow_to_enumerate() -> None:
    task = builders.task('/'.join(['#' * 16] * 16))
    regions = rectangles(task, 0, max_cells=256)
    assert len(regions) == 136 * 16 - 16  # on the ground, without single cells
    assert max(area(cells) for _, cells in regions) == 256
