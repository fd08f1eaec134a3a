"""Empty margins of silhouettes in text."""

from __future__ import annotations

import pytest
from builders import picture
from drawings import refused

from blocks_planning.board.geometry import Board
from blocks_planning.board.pictures import parse_silhouettes


@pytest.mark.parametrize(
    ('rows', 'expected'),
    [
        pytest.param(['.' * 9 + '###' + '.' * 9, '.' * 9 + '#.#' + '.' * 9], '###/#.#', id='wide'),
        pytest.param(['....'] * 20 + ['.##.'], '.##.', id='high'),
        pytest.param(['.' * 20] * 9 + ['##' + '.' * 18] + ['.' * 20] * 9, '##', id='all around'),
        pytest.param(['#' + '.' * 16] * 2, '#/#', id='one column too many'),
        pytest.param(['#' + '.' * 14 + '#.'], '#' + '.' * 14 + '#', id='just fits'),
    ],
)
def test_margins_beyond_the_largest_board_are_trimmed(rows: list[str], expected: str) -> None:
    assert parse_silhouettes('\n'.join(rows), 'x') == {'1': picture(expected)}


def test_margins_of_a_board_are_kept() -> None:
    rows = ['.' * 16] * 15 + ['.#' + '.' * 14]
    board, mask = parse_silhouettes('\n'.join(rows), 'x')['1']
    assert (board, mask) == (Board(16, 16), board.mask([(1, 0)]))


@pytest.mark.parametrize(
    ('text', 'place', 'words'),
    [
        ('...' + '#' * 17 + '..', 'line 1, column 20', 'this one has 17'),
        ('.\n' * 3 + '#\n' * 17, 'line 20', 'between its empty margins'),
        ('.' * 17, 'line 1, column 17', 'this one has 17'),
        ('.\n' * 17, 'line 17', 'row 17'),
    ],
)
def test_a_tower_larger_than_any_board_is_refused(text: str, place: str, words: str) -> None:
    message = refused(text)
    assert message.startswith(f'towers, {place}: ')
    assert words in message
