"""Files of silhouettes: any bytes are read, or refused in one line."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from drawings import ARCH, ARCH_READ, STEP, STEP_READ, one_line
from hypothesis import example, given
from hypothesis import strategies as st

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.pictures import MAX_FILE_BYTES, read_file
from blocks_planning.errors import StimulusError


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
