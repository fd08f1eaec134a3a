"""Histories of boards on plain lists of blocks, and what cannot stand."""

from __future__ import annotations

import pytest

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.worlds.observation import (
    Observation,
    blocks_after,
    history_of,
    impossible,
    mask_of,
    standing,
    states_of,
    wrong_change,
)

BOARD = Board(4, 4)
POST = Placed(1, 2, 0, 0)
OTHER = Placed(1, 2, 3, 0)
BEAM = Placed(4, 2, 0, 2)
ORDER = Placement(Block(1, 2), 0)


def test_blocks_land_move_and_go() -> None:
    moved = Placed(1, 2, 2, 0)
    seen = (
        Observation(landed=(POST,)),
        Observation(OTHER.placement, (OTHER,)),
        Observation(ORDER),
        Observation(landed=(moved,), gone=(POST,)),
        Observation(gone=(moved, OTHER)),
    )
    expected = [(POST,), (POST, OTHER), (POST, OTHER), (OTHER, moved), ()]
    assert list(history_of(seen)) == expected
    assert states_of(BOARD, seen) == [mask_of(BOARD, blocks) for blocks in expected]
    assert standing(seen) == ()
    assert blocks_after((POST,), Observation(landed=(OTHER,), gone=(POST,))) == (OTHER,)


@pytest.mark.parametrize(
    ('seen', 'expected'),
    [
        (Observation(ORDER, (POST,)), True),
        (Observation(ORDER), False),
        (Observation(None, (POST,)), False),
        (Observation(ORDER, (Placed(1, 2, 1, 0),)), False),
        (Observation(ORDER, (Placed(2, 2, 0, 0),)), False),
        (Observation(ORDER, (POST, OTHER)), False),
        (Observation(ORDER, (POST,), (OTHER,)), False),
    ],
)
def test_as_ordered_is_one_block_in_its_column_and_nothing_else(
    seen: Observation, expected: bool
) -> None:
    assert seen.is_as_ordered is expected


@pytest.mark.parametrize(
    ('blocks', 'reason'),
    [
        ((), ''),
        ((POST, OTHER, BEAM), ''),
        ((BEAM, POST), ''),
        ((Placed(1, 2, 4, 0),), 'does not lie inside'),
        ((Placed(1, 2, -1, 0),), 'does not lie inside'),
        ((POST, Placed(1, 4, 0, 2), Placed(2, 1, 0, 4)), 'does not lie inside'),
        ((POST, Placed(2, 2, 0, 1)), 'overlaps another'),
        ((POST, POST), 'overlaps another'),
        ((BEAM,), 'rests on nothing'),
        ((POST, Placed(2, 2, 1, 2)), 'rests on nothing'),
    ],
)
def test_what_cannot_stand_is_named(blocks: tuple[Placed, ...], reason: str) -> None:
    found = impossible(BOARD, blocks)
    assert (reason in found) if reason else not found


def test_what_did_not_stand_cannot_go() -> None:
    assert wrong_change((POST,), Observation(gone=(POST,))) == ''
    found = wrong_change((POST,), Observation(gone=(POST, OTHER)))
    assert found == 'block 1x2 in column 3 and row 0 is gone, but it was not on the board'
