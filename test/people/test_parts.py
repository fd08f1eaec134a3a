"""Parts of a silhouette: pieces, and what is a region of a family."""

from __future__ import annotations

import random

import builders
import pytest
from hypothesis import given
from hypothesis import strategies as st

from blocks_planning.board.geometry import Board, area
from blocks_planning.errors import ConfigurationError
from blocks_planning.people import data
from blocks_planning.people.families import family_names, find_family
from blocks_planning.people.parts import grown_part, is_region, neighbours, pieces

boards = st.builds(Board, st.integers(1, 6), st.integers(1, 6))


@given(boards, st.data())
def test_neighbours_share_an_edge(board: Board, drawn: st.DataObject) -> None:
    mask = drawn.draw(st.integers(0, board.full))
    cells = set(board.cells(mask))
    around = {
        (column + x, row + y)
        for column, row in cells
        for x, y in ((0, 1), (1, 0), (0, -1), (-1, 0))
    }
    on_board = {
        (column, row)
        for column, row in around - cells
        if 0 <= column < board.width and 0 <= row < board.height
    }
    assert set(board.cells(neighbours(board, mask))) == on_board


@given(boards, st.data())
def test_pieces_are_apart_and_hang_together(board: Board, drawn: st.DataObject) -> None:
    mask = drawn.draw(st.integers(0, board.full))
    found = list(pieces(board, mask))
    assert sum(found) == mask
    assert sum(map(area, found)) == area(mask)
    for piece in found:
        assert not neighbours(board, piece) & mask
        assert list(pieces(board, piece)) == [piece]


def test_marked_parts_have_the_known_number_of_pieces() -> None:
    counted = sum(
        len(list(pieces(data.tasks()[marking.tower].board, part)))
        for marking in data.read_markings()
        for part in marking.parts
    )
    assert counted == 2688


@pytest.mark.parametrize(
    ('part', 'families'),
    [
        ('..../..../####', {'rows', 'rectangles'}),
        ('..../##../....', {'rectangles'}),
        ('..../##../##..', {'rectangles'}),
        ('..../####/....', {'rows', 'rectangles'}),
        ('####/####/....', {'rows', 'rectangles'}),
        ('..../#.../##..', set()),
        ('####/####/####', {'rows'}),
    ],
)
def test_part_is_a_region_of(part: str, families: set[str]) -> None:
    task = builders.task('####/####/####')
    _, mask = builders.picture(part)
    found = {name for name in family_names() if is_region(task, mask, find_family(name))}
    assert found == families


def test_grown_part_is_one_piece_of_the_silhouette() -> None:
    task = builders.task('###.#/#.#.#/####.')
    for seed in range(30):
        part = grown_part(task, 5, random.Random(seed))
        assert area(part) == 5
        assert not part & ~task.silhouette
        assert list(pieces(task.board, part)) == [part]


def test_unknown_family_is_named() -> None:
    with pytest.raises(ConfigurationError, match="one of rows, rectangles, got 'columns'"):
        find_family('columns')
