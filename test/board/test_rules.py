"""The rules of the board on towers small enough to build by hand."""

from __future__ import annotations

import doctest
import importlib

import pytest
from builders import picture, task
from source_imports import PACKAGE, package_sources

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Placed, Placement, parse_library
from blocks_planning.board.geometry import Board, Mask

WIDE = Board(6, 4)


def built(rows: str) -> Mask:
    return picture(rows)[1]


@pytest.mark.parametrize(
    ('state', 'block', 'column', 'row'),
    [
        pytest.param('....../....../....../......', '2x2', 0, 0, id='on the ground'),
        pytest.param('....../....../....../......', '2x2', 4, 0, id='against the right side'),
        pytest.param('....../....../....../......', '6x4', 0, 0, id='as large as the board'),
        pytest.param('....../....../....../.#....', '2x2', 1, 1, id='on one of its columns'),
        pytest.param('....../....../....../.#....', '2x2', 2, 0, id='beside a block'),
        pytest.param('....../....../.#..#./.#..#.', '4x2', 1, 2, id='bridging a gap'),
        pytest.param('....../....../....#./.#..#.', '4x2', 1, 2, id='on the highest'),
        pytest.param('....../.#..../.#..../.#..#.', '4x1', 1, 3, id='on the highest, far left'),
        pytest.param('....../.####./....../......', '1x1', 2, 3, id='on a bridge, not below it'),
        pytest.param('.##.../....../....../......', '1x4', 0, 0, id='up to the top beside'),
    ],
)
def test_block_comes_to_rest_on_what_is_highest(
    state: str, block: str, column: int, row: int
) -> None:
    [dropped] = parse_library(block)
    placed = Placed(*dropped, column, row)
    assert rules.drop(WIDE, built(state), Placement(dropped, column)) == placed


@pytest.mark.parametrize(
    ('state', 'block', 'column'),
    [
        pytest.param('....../....../....../......', '2x2', -1, id='left of the board'),
        pytest.param('....../....../....../......', '2x2', 5, id='over the right side'),
        pytest.param('....../....../....../......', '2x2', 6, id='right of the board'),
        pytest.param('....../....../....../......', '2x2', 10**9, id='far away'),
        pytest.param('....../....../....../......', '1x5', 0, id='higher than the board'),
        pytest.param('....../....../....../......', '7x1', 0, id='wider than the board'),
        pytest.param('....../#...../#...../#.....', '1x2', 0, id='over the top'),
        pytest.param('#...../#...../#...../#.....', '1x1', 0, id='on a full column'),
        pytest.param('....../.....#/....../......', '6x2', 0, id='over the top, by one column'),
    ],
)
def test_block_that_would_not_rest_inside_the_board_is_not_placed(
    state: str, block: str, column: int
) -> None:
    [dropped] = parse_library(block)
    assert rules.drop(WIDE, built(state), Placement(dropped, column)) is None


@pytest.mark.parametrize('block', [Block(1, 2), Block(2, 1), Block(1, 1)])
def test_top_row_is_part_of_the_board(block: Block) -> None:
    board = Board(2, 2)
    placed = Placed(*block, 0, 2 - block.height)
    under = board.rows_below(placed.row)
    assert rules.drop(board, under, Placement(block, 0)) == placed
    assert rules.drop(board, under | 1 << placed.row, Placement(block, 0)) is None


def test_cells_of_a_placed_block() -> None:
    assert WIDE.draw(rules.cells_of(WIDE, Placed(4, 2, 1, 2))) == (
        '.####.\n.####.\n......\n......'
    )


def test_possible_placements_come_block_by_block_from_left_to_right() -> None:
    library = parse_library('2x1,1x2')
    board, state = picture('.../.../#..')
    assert list(rules.possible_placements(board, state, library)) == [
        (2, 1, 0, 1),
        (2, 1, 1, 0),
        (1, 2, 0, 1),
        (1, 2, 1, 0),
        (1, 2, 2, 0),
    ]


def test_legal_placements_cover_the_region_only() -> None:
    target = task('.##/.##/##.', '2x1,1x2')
    # Column 2 has a hole on the ground: a block that stands there would fill it.
    assert list(rules.legal_placements(target, 0, target.silhouette)) == [
        (2, 1, 0, 0),
        (1, 2, 1, 0),
    ]
    ground = target.board.rectangle(0, 0, 2, 1)
    assert list(rules.legal_placements(target, ground, target.silhouette)) == [
        (2, 1, 1, 1),
        (1, 2, 1, 1),
    ]
    assert list(rules.legal_placements(target, 0, target.rows(1))) == [(2, 1, 0, 0)]
    assert list(rules.legal_placements(target, 0, 0)) == []


def test_shadow_is_what_no_block_can_reach() -> None:
    board, state = picture('.##./.#../#.../....')
    assert board.draw(rules.shadow(board, state)) == '.##.\n.##.\n###.\n###.'
    assert rules.shadow(board, 0) == 0
    assert rules.shadow(board, board.full) == board.full


@pytest.mark.parametrize(
    ('region', 'state', 'dead'),
    [
        pytest.param('##/##', '../..', False, id='nothing built'),
        pytest.param('##/##', '../##', False, id='first row'),
        pytest.param('##/##', '##/##', False, id='complete'),
        pytest.param('##/##', '##/#.', True, id='cell under a bridge'),
        pytest.param('##/#.', '##/#.', False, id='hole of the silhouette'),
        pytest.param('.#/##', '#./..', True, id='under a cell outside the region'),
        pytest.param('../..', '##/..', False, id='nothing wanted'),
    ],
)
def test_state_is_dead_if_a_target_cell_lies_empty_under_a_filled_one(
    region: str, state: str, dead: bool
) -> None:
    board, cells = picture(state)
    assert rules.is_dead(board, cells, built(region)) is dead


def test_states_along_a_way_begin_with_the_first() -> None:
    board = Board(2, 2)
    way = (Placed(1, 1, 0, 0), Placed(1, 1, 1, 0), Placed(2, 1, 0, 1))
    assert rules.states_along(board, 0, way) == [0, 0b0001, 0b0101, 0b1111]
    assert rules.states_along(board, 0b0101, ()) == [0b0101]


# The examples in docstrings, of all modules.


EXAMPLES = [source.module for source in package_sources() if '>>> ' in source.text]


def test_there_are_examples() -> None:
    for name in ('board.geometry', 'board.blocks', 'search.randomness'):
        assert f'{PACKAGE}.{name}' in EXAMPLES


@pytest.mark.parametrize('name', EXAMPLES)
def test_examples_of_a_module_hold(name: str) -> None:
    results = doctest.testmod(importlib.import_module(name))
    assert results.failed == 0
    assert results.attempted > 0
