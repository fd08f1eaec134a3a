"""Silhouettes in text: what is read, and what is refused where."""

from __future__ import annotations

import pytest
from builders import picture
from drawings import ARCH, ARCH_READ, STEP, STEP_READ, drawn, refused
from hypothesis import given
from hypothesis import strategies as st

from blocks_planning.board.geometry import MAX_SIDE, Board
from blocks_planning.board.pictures import format_silhouette, parse_silhouettes
from blocks_planning.board.stimuli import Stimulus

SIDES = range(1, MAX_SIDE + 1)


@pytest.mark.parametrize('width', SIDES)
def test_every_size_is_read(width: int) -> None:
    for height in SIDES:
        board = Board(width, height)
        striped = board.mask((c, r) for c in range(width) for r in range(height) if (c + r) % 3)
        for mask in (0, striped, board.full):
            assert parse_silhouettes(board.draw(mask), 'x') == {'1': (board, mask)}


@pytest.mark.parametrize(
    'text',
    [
        pytest.param(ARCH, id='plain'),
        pytest.param('###\n#.#\n#.#', id='no final newline'),
        pytest.param(ARCH.replace('\n', '\r\n'), id='CRLF'),
        pytest.param(ARCH.replace('\n', '\r'), id='CR'),
        pytest.param('###\r\n#.#\r#.#\n', id='mixed line ends'),
        pytest.param('###  \n#.#\t\n#.# \t \n', id='trailing blanks and tabs'),
        pytest.param('###  \r\n#.#\t\r\n#.# \t \r\n', id='trailing blanks before CRLF'),
        pytest.param(f'\n\n \t\n{ARCH}\n\n', id='blank lines around'),
        pytest.param(f'# An arch.\n{ARCH}', id='comment before'),
        pytest.param('###\n# with legs\n#.#\n#.#\n', id='comment between rows'),
        pytest.param(f'{ARCH}# The end.\n', id='comment after'),
        pytest.param(
            '### # the bridge\n#.#\t# a leg\n#.#  # ##.\n'.replace('##.', '##x'), id='behind'
        ),
        pytest.param('###  #\tthe bridge\n#.#\n#.#\n', id='comment with a tab'),
        pytest.param(f'# An arch\n#\n# of three rows.\n{ARCH}', id="lone '#' in a comment"),
        pytest.param(f'# An arch\n#\n#\n# of rows.\n\n{ARCH}', id="lone '#'s in a comment"),
        pytest.param(f'# ----------\n{ARCH}', id='ruler as a comment'),
        pytest.param(f'   # indented\n{ARCH}', id='indented comment'),
    ],
)
def test_one_picture_is_number_1(text: str) -> None:
    assert parse_silhouettes(text, 'x') == {'1': ARCH_READ}


@pytest.mark.parametrize(
    ('text', 'names'),
    [
        pytest.param(f'{ARCH}\n{STEP}', ['1', '2'], id='by number'),
        pytest.param(f'{ARCH}\n\n \n{STEP}', ['1', '2'], id='several blank lines between'),
        pytest.param(f'tower a\n{ARCH}\ntower b\n{STEP}', ['a', 'b'], id='by heading'),
        pytest.param(f'tower a\n{ARCH}tower b\n{STEP}', ['a', 'b'], id='no blank line between'),
        pytest.param(f'tower 2\n{ARCH}tower 1\n{STEP}', ['2', '1'], id='in the order of the file'),
        pytest.param(f'tower a\n{ARCH}\n{STEP}', ['a', '2'], id='heading on the first only'),
        pytest.param(f'{ARCH}tower b\n{STEP}', ['1', 'b'], id='heading on the second only'),
        pytest.param(f'tower a\n\n{ARCH}\ntower b\n\n{STEP}', ['a', 'b'], id='blank line below'),
        pytest.param(
            f'tower a  # best\n{ARCH}tower \t A_b.c-9 \n{STEP}', ['a', 'A_b.c-9'], id='any name'
        ),
        pytest.param(
            f'# Two.\ntower a\n# The first.\n{ARCH}\n# Next.\ntower b\n{STEP}',
            ['a', 'b'],
            id='comments everywhere',
        ),
    ],
)
def test_several_pictures_are_told_apart(text: str, names: list[str]) -> None:
    read = parse_silhouettes(text, 'x')
    assert list(read.items()) == [(names[0], ARCH_READ), (names[1], STEP_READ)]


@pytest.mark.parametrize('rows', ['#', '.', '#\n#', '#\n.\n#'])
def test_a_column_of_one_cell_is_no_comment(rows: str) -> None:
    assert parse_silhouettes(rows, 'x') == {'1': picture(rows.replace('\n', '/'))}
    assert parse_silhouettes(f'# A column.\n\n{rows}', 'x') == {
        '1': picture(rows.replace('\n', '/'))
    }


@pytest.mark.parametrize(
    ('text', 'place', 'words'),
    [
        pytest.param('###\n#.\n', 'line 2, column 3', 'expected 3 cells', id='short row'),
        pytest.param('##\n#.##\n', 'line 2, column 3', 'expected 2 cells', id='long row'),
        pytest.param('##\n\n##\n###\n', 'line 4, column 3', 'got 3', id='ragged second picture'),
        pytest.param('##\n#?\n', 'line 2, column 2', "got '?'", id='unknown character'),
        pytest.param('##\n#X###\n', 'line 2, column 2', "got 'X'", id='before a wrong length'),
        pytest.param('\n##\n1#\n', 'line 3, column 1', "got '1'", id='in the first column'),
        pytest.param('##\n#\u0441\n', 'line 2, column 2', "got '\u0441'", id='foreign letter'),
        pytest.param('##\n#\x00\n', 'line 2, column 2', r"got '\x00'", id='NUL'),
        pytest.param('##\n#\u2028\n', 'line 2, column 2', r"got '\u2028'", id='line separator'),
        pytest.param('##\x0c\n##\n', 'line 1, column 3', r"got '\x0c'", id='form feed'),
        pytest.param('##\n\ufeff##\n', 'line 2, column 1', r"got '\ufeff'", id='BOM inside'),
        pytest.param('##\n# #\n', 'line 2, column 2', "got ' '", id='blank inside a row'),
        pytest.param('##\n #\n', 'line 2, column 1', "got ' '", id='blank before a row'),
        pytest.param('###\n#\t#\n', 'line 2, column 2', r"got '\t'", id='tab inside a row'),
        pytest.param('# #\n# #\n', 'line 1, column 2', "got ' '", id='picture drawn with blanks'),
        pytest.param('##\n## comment\n', 'line 2, column 3', "got ' '", id="comment without '#'"),
        pytest.param(
            'Tower a\n##\n', 'line 1, column 1', "'tower NAME'", id='heading in capitals'
        ),
        pytest.param('#' * 17, 'line 1, column 17', 'at most 16 cells', id='17 columns'),
        pytest.param('#' * 999, 'line 1, column 17', 'this one has 999', id='999 columns'),
        pytest.param('#\n' * 17, 'line 17', 'at most 16 rows', id='17 rows'),
        pytest.param('\n' + '##\n' * 40, 'line 18', 'row 17 of the picture', id='40 rows'),
        pytest.param('tower a\n', 'line 1', "tower 'a' has no picture", id='heading alone'),
        pytest.param('##\ntower a', 'line 2', "tower 'a' has no picture", id='heading at the end'),
        pytest.param('tower a\n\ntower b\n##', 'line 1', "tower 'a'", id='heading over heading'),
        pytest.param('tower a\n#\ntower a\n#', 'line 3', "already a tower 'a'", id='doubled name'),
        pytest.param('tower 2\n#\n\n#', 'line 4', "already a tower '2'", id='number taken'),
        pytest.param('# Words\n#\n', 'line 2', "a lone '#'", id='comment or row at the end'),
        pytest.param('# Words\n#\n#\n.\n', 'line 2', "a lone '#'", id='comment or row'),
        pytest.param('# Words\n\n#\n# Words\n#\n', 'line 5', "a lone '#'", id='row or comment'),
    ],
)
def test_fault_is_named_with_its_place(text: str, place: str, words: str) -> None:
    for variant in (text, text.replace('\n', '\r\n'), text.replace('\n', '\r')):
        message = refused(variant)
        assert message.startswith(f'towers, {place}: ')
        assert words in message


@pytest.mark.parametrize('text', ['', '\n', ' \t\r\n\n', '# Only words.\n', '\n# a\n#\n# b\n'])
def test_text_without_a_picture_is_refused(text: str) -> None:
    message = refused(text)
    assert message.startswith('towers: found no silhouette')
    assert "'#'" in message


@given(st.data())
def test_what_is_drawn_is_read_back(data: st.DataObject) -> None:
    pictures = data.draw(st.lists(drawn(), min_size=1, max_size=4))
    text = '\n\n'.join(board.draw(mask) for board, mask in pictures)
    assert list(parse_silhouettes(text, 'x').values()) == pictures
    for board, mask in pictures:
        assert board.parse(Stimulus('x', board, mask).draw().split('\n')) == mask


@given(st.data())
def test_a_row_of_another_length_is_found_where_it_is(data: st.DataObject) -> None:
    board = Board(data.draw(st.integers(2, 15)), data.draw(st.integers(2, 16)))
    rows = board.draw(data.draw(st.integers(0, board.full))).split('\n')
    index = data.draw(st.integers(1, len(rows) - 1))
    longer = data.draw(st.booleans())
    rows[index] = rows[index] + '#' if longer else rows[index][:-1] + ''
    column = board.width + 1 if longer else board.width
    assert refused('\n'.join(rows)).startswith(f'towers, line {index + 1}, column {column}: ')


@given(st.data())
def test_what_is_written_is_read_back(data: st.DataObject) -> None:
    board, mask = data.draw(drawn())
    text = format_silhouette('gate', board, mask, ['cells 9, holes 1', 'made by hand'])
    assert parse_silhouettes(text, 'x') == {'gate': (board, mask)}
