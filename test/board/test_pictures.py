"""Text pictures: what the reader takes, what it refuses and where it says the fault is."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from builders import picture
from hypothesis import example, given
from hypothesis import strategies as st
from strategies import boards

from blocks_planning.board.geometry import MAX_SIDE, Board, Mask
from blocks_planning.board.pictures import (
    MAX_FILE_BYTES,
    format_silhouette,
    parse_silhouettes,
    read_file,
)
from blocks_planning.board.stimuli import Stimulus
from blocks_planning.errors import StimulusError

ARCH = '###\n#.#\n#.#\n'
STEP = '#.\n##\n'
ARCH_READ = picture('###/#.#/#.#')
STEP_READ = picture('#./##')
SIDES = range(1, MAX_SIDE + 1)


def refused(text: str, origin: str = 'towers') -> str:
    """The message with which a text is refused."""
    with pytest.raises(StimulusError) as caught:
        parse_silhouettes(text, origin)
    return one_line(caught.value)


def one_line(error: StimulusError) -> str:
    """The message of an error, which has one line."""
    message = str(error)
    assert len(message.splitlines()) == 1
    return message


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


@pytest.mark.parametrize(
    'data', [b'\xef\xbb\xbf' + ARCH.encode(), ARCH.encode()], ids=['BOM', 'no']
)
def test_file_may_begin_with_a_byte_order_mark(tmp_path: Path, data: bytes) -> None:
    path = tmp_path / 'arch.txt'
    path.write_bytes(data)
    assert read_file(path) == {'1': ARCH_READ}


def test_fault_in_a_file_is_named_with_the_file(tmp_path: Path) -> None:
    path = tmp_path / 'my towers.txt'
    path.write_text('##\n#?\n')
    with pytest.raises(StimulusError) as caught:
        read_file(path)
    assert str(caught.value) == f"{path}, line 2, column 2: expected '#' or '.', got '?'"


@pytest.mark.parametrize(
    ('data', 'words'),
    [
        pytest.param(b'##\n\xff\xfe', 'is not a text file (byte 3)', id='no UTF-8'),
        pytest.param('##'.encode('utf-16'), 'is not a text file (byte 0)', id='UTF-16'),
        pytest.param(
            b'\x89PNG\r\n\x1a\n\0\0\0\r', 'is not a text file (byte 0)', id='picture file'
        ),
        pytest.param(b'#\n' * (MAX_FILE_BYTES // 2) + b'#', 'is larger than', id='too large'),
    ],
)
def test_file_that_is_no_text_is_refused(tmp_path: Path, data: bytes, words: str) -> None:
    path = tmp_path / 'towers.txt'
    path.write_bytes(data)
    with pytest.raises(StimulusError) as caught:
        read_file(path)
    assert one_line(caught.value).startswith(f'{path}: {words}')


def test_file_of_the_largest_size_is_read(tmp_path: Path) -> None:
    path = tmp_path / 'towers.txt'
    path.write_bytes(STEP.encode() + b'\n' * (MAX_FILE_BYTES - len(STEP)))
    assert read_file(path) == {'1': STEP_READ}


def test_directory_missing_and_unreadable_files_are_refused(tmp_path: Path) -> None:
    loop = tmp_path / 'loop'
    loop.symlink_to(loop)
    for path, words in (
        (tmp_path, 'is a directory; name a file in it'),
        (tmp_path / 'missing.txt', 'cannot be read: No such file or directory'),
        (tmp_path / 'missing' / 'x.txt', 'cannot be read: No such file or directory'),
        (loop, 'cannot be read: Too many levels of symbolic links'),
        (tmp_path / ('x' * 300), 'cannot be read: File name too long'),
    ):
        with pytest.raises(StimulusError) as caught:
            read_file(path)
        assert one_line(caught.value) == f'{path}: {words}'


def test_path_with_a_nul_is_refused(tmp_path: Path) -> None:
    with pytest.raises(StimulusError):
        read_file(tmp_path / 'a\0b')


def test_one_endless_line_is_refused_at_once(tmp_path: Path) -> None:
    path = tmp_path / 'towers.txt'
    path.write_bytes(b'# ' * (MAX_FILE_BYTES // 2))
    code = (
        'import sys; from pathlib import Path; '
        'from blocks_planning.board.pictures import read_file; read_file(Path(sys.argv[1]))'
    )
    command = [sys.executable, '-c', code, str(path)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=20)
    assert 'line 1, column 2' in done.stderr


@given(st.data())
def test_what_is_drawn_is_read_back(data: st.DataObject) -> None:
    pictures = data.draw(st.lists(_pictures(), min_size=1, max_size=4))
    text = '\n\n'.join(board.draw(mask) for board, mask in pictures)
    assert list(parse_silhouettes(text, 'x').values()) == pictures
    for board, mask in pictures:
        assert board.parse(Stimulus('x', board, mask).draw().split('\n')) == mask


@st.composite
def _pictures(draw: st.DrawFn) -> tuple[Board, Mask]:
    board = draw(boards())
    return board, draw(st.integers(0, board.full))


@given(st.data())
def test_a_row_of_another_length_is_found_where_it_is(data: st.DataObject) -> None:
    board = Board(data.draw(st.integers(2, 15)), data.draw(st.integers(2, 16)))
    rows = board.draw(data.draw(st.integers(0, board.full))).split('\n')
    index = data.draw(st.integers(1, len(rows) - 1))
    longer = data.draw(st.booleans())
    rows[index] = rows[index] + '#' if longer else rows[index][:-1] + ''
    column = board.width + 1 if longer else board.width
    assert refused('\n'.join(rows)).startswith(f'towers, line {index + 1}, column {column}: ')


def read_or_refused(path: Path) -> dict[str, tuple[Board, Mask]]:
    """The pictures of a file; none if it is refused as it should be."""
    try:
        read = read_file(path)
    except StimulusError as error:
        message = one_line(error).removeprefix(str(path))
        assert message.startswith((', line ', ': found no silhouette', ': is not a text file'))
        return {}
    assert read
    return read


@given(st.binary(max_size=300))
@example(b'')
@example(b'\xef\xbb\xbf')
@example(b'#\r')
def test_any_bytes_are_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, data: bytes
) -> None:
    path = tmp_path_factory.getbasetemp() / 'any.txt'
    path.write_bytes(data)
    read_or_refused(path)


_PIECES = [
    '#',
    '.',
    ' ',
    '\t',
    '\r',
    '\n',
    '\r\n',
    '# x',
    'tower 1\n',
    'tower a\n',
    '\0',
    '\ufeff',
    'é',
]


@given(st.data())
def test_damaged_text_is_read_or_refused_with_a_place(
    tmp_path_factory: pytest.TempPathFactory, data: st.DataObject
) -> None:
    text = f'# Two towers.\n#\n# See below.\ntower a\n{ARCH}\n\n{STEP}'
    for _ in range(data.draw(st.integers(1, 4))):
        start = data.draw(st.integers(0, len(text)))
        pieces = data.draw(st.lists(st.sampled_from(_PIECES), max_size=2))
        text = text[:start] + ''.join(pieces) + text[start + data.draw(st.integers(0, 3)) :]
    path = tmp_path_factory.getbasetemp() / 'damaged.txt'
    path.write_text(text)
    for board, mask in read_or_refused(path).values():
        assert board.parse(board.draw(mask).split('\n')) == mask


# Margins.


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


@given(st.data())
def test_what_is_written_is_read_back(data: st.DataObject) -> None:
    board, mask = data.draw(_pictures())
    text = format_silhouette('gate', board, mask, ['cells 9, holes 1', 'made by hand'])
    assert parse_silhouettes(text, 'x') == {'gate': (board, mask)}
