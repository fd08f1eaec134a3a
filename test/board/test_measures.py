"""Measures of silhouettes against a twin on sets of cells."""

from __future__ import annotations

import pytest
from builders import picture
from hypothesis import given
from hypothesis import strategies as st
from oracles.shapes import measures
from strategies import boards

from blocks_planning.board.measures import Shape, shape_of


@given(st.data())
def test_measures_agree_with_the_twin(data: st.DataObject) -> None:
    board = data.draw(boards())
    mask = data.draw(st.integers(0, board.full)) | data.draw(st.integers(0, board.full))
    expected = measures(board.width, board.height, frozenset(board.cells(mask)))
    assert shape_of(board, mask)._asdict() == expected


@pytest.mark.parametrize(
    ('rows', 'shape'),
    [
        ('####/#..#/####', Shape(10, 4, 3, 1, 2, 1, 2, 0)),
        ('#.#/#.#', Shape(4, 3, 2, 0, 0, 0, 0, 4)),
        ('###/#.#', Shape(5, 3, 2, 1, 1, 1, 1, 0)),
        ('.../.#.', Shape(1, 1, 1, 0, 0, 0, 0, 2)),
        ('#####/.#.#.', Shape(7, 5, 2, 3, 3, 3, 3, 0)),
        ('../..', Shape(0, 0, 0, 0, 0, 0, 0, 0)),
    ],
)
def test_by_hand(rows: str, shape: Shape) -> None:
    assert shape_of(*picture(rows)) == shape
