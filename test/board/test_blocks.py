"""Block libraries and tasks: what they are read from, and what is refused."""

from __future__ import annotations

import pytest
from hypothesis import given
from strategies import libraries

from blocks_planning.board.blocks import (
    MAX_BLOCKS,
    PAPER_LIBRARY,
    Block,
    Library,
    Placed,
    Placement,
    check_library,
    format_library,
    parse_library,
)
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, InvalidInput


def test_library_of_the_paper() -> None:
    assert format_library(PAPER_LIBRARY) == '1x2,2x1,2x2,2x4,4x2'
    assert [block.area for block in PAPER_LIBRARY] == [2, 2, 4, 8, 8]


def test_block_is_width_by_height() -> None:
    block = Block(4, 2)
    assert (block.width, block.height, block.area, str(block)) == (4, 2, 8, '4x2')


def test_placed_block_knows_the_decision_that_put_it_there() -> None:
    assert Placed(4, 2, 3, 5).placement == Placement(Block(4, 2), 3)


@pytest.mark.parametrize(
    ('text', 'library'),
    [
        ('1x1', (Block(1, 1),)),
        ('2x1,1x2', (Block(2, 1), Block(1, 2))),
        (' 2x1 , 1x2 ', (Block(2, 1), Block(1, 2))),
        ('16x16,16x1,1x16', (Block(16, 16), Block(16, 1), Block(1, 16))),
        ('01x002', (Block(1, 2),)),
    ],
)
def test_library_is_read_in_its_order(text: str, library: Library) -> None:
    assert parse_library(text) == library


@given(libraries(most_side=16))
def test_library_that_is_written_is_read_back(library: Library) -> None:
    assert parse_library(format_library(library)) == library
    assert check_library(library) is library


@pytest.mark.parametrize(
    ('text', 'item'),
    [
        ('', "got ''"),
        ('junk', "got 'junk'"),
        ('1x2,', "got ''"),
        (',1x2', "got ''"),
        ('1x2;2x1', "got '1x2;2x1'"),
        ('1x2 2x1', "got '1x2 2x1'"),
        ('1X2', "got '1X2'"),
        ('1 x 2', "got '1 x 2'"),
        ('1x', "got '1x'"),
        ('1x2x3', "got '1x2x3'"),
        ('-1x2', "got '-1x2'"),
        ('1.5x2', "got '1.5x2'"),
        ('\uff11x2', "got '\uff11x2'"),
        ('1000x1', "got '1000x1'"),
        ('1x2,2\nx1', r"got '2\nx1'"),
        ('1x2,2x1\0', r"got '2x1\x00'"),
    ],
)
def test_what_is_no_list_of_blocks_is_refused(text: str, item: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        parse_library(text, '--library')
    message = str(caught.value)
    assert message.startswith('--library: expected blocks as WIDTHxHEIGHT')
    assert item in message
    assert len(message.splitlines()) == 1


@pytest.mark.parametrize(
    ('text', 'words'),
    [
        ('0x1', 'sides of a block are 1 to 16 cells, got 0x1'),
        ('2x2,1x0', 'got 1x0'),
        ('17x1', 'got 17x1'),
        ('1x999', 'got 1x999'),
        ('1x2,2x1,1x2', 'block 1x2 is listed twice'),
        ('1x2,01x2', 'block 1x2 is listed twice'),
        (','.join(f'{n % 16 + 1}x{n // 16 + 1}' for n in range(65)), '1 to 64 blocks, got 65'),
    ],
)
def test_library_that_cannot_be_used_is_refused(text: str, words: str) -> None:
    with pytest.raises(ConfigurationError) as caught:
        parse_library(text, 'here')
    assert str(caught.value).startswith('here: ')
    assert words in str(caught.value)


def test_number_of_blocks_is_limited() -> None:
    blocks = [Block(n % 16 + 1, n // 16 + 1) for n in range(MAX_BLOCKS)]
    assert len(check_library(tuple(blocks))) == MAX_BLOCKS
    with pytest.raises(
        ConfigurationError, match='block library: a library has 1 to 64 blocks, got 0'
    ):
        check_library(())


@pytest.mark.parametrize('silhouette', [-1, 1 << 6, 1 << 300])
def test_silhouette_off_the_board_is_refused(silhouette: int) -> None:
    with pytest.raises(InvalidInput, match=r'has cells off the board of 2 x 3 cells'):
        Task(Board(2, 3), silhouette)


def test_task_checks_its_library() -> None:
    with pytest.raises(ConfigurationError, match='got 17x1'):
        Task(Board(2, 3), 0, (Block(17, 1),))


def test_rows_of_a_task_are_its_target_cells_below_a_height() -> None:
    board = Board(3, 3)
    task = Task(board, board.parse(['#..', '#.#', '.##']))
    assert [board.draw(task.rows(height)) for height in range(4)] == [
        '...\n...\n...',
        '...\n...\n.##',
        '...\n#.#\n.##',
        '#..\n#.#\n.##',
    ]
