"""Silhouettes as text pictures: reading, writing, and finding them by address.

A file holds one or more pictures, top row first, '#' for a target cell and '.' for an empty one::

    # A comment: a '#', a blank, and words.
    tower 9
    ...###..
    .#.###..

A line ``tower NAME`` names the picture below it; otherwise pictures are numbered from 1. Pictures
are kept apart by blank lines or headings. CRLF, trailing blanks, a byte order mark and comments
behind a row are fine.

An *address* is ``SET`` (all silhouettes of an installed set, or of a file by its path) or
``SET/NAME`` (one of them), such as ``cogsci2021/9`` or ``my/towers.txt/arch``.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from blocks_planning.board.geometry import EMPTY, FILLED, MAX_SIDE, Board, Mask
from blocks_planning.errors import StimulusError, shown
from blocks_planning.resources import resource_directories

MAX_FILE_BYTES = 1 << 20
_MOST_SHOWN = 200
SUFFIX = '.txt'

_HEADING = re.compile(r'tower[ \t]+([A-Za-z0-9_.-]+)')
# A comment needs a character that no row has, so that a row drawn with blanks is an error and
# not a lost row.
_COMMENT = re.compile(r'(?:^|[ \t])#[ \t]')
_WORDS = re.compile(r'[^#. \t]')


@dataclass(frozen=True)
class Stimulus:
    """A silhouette with its address."""

    name: str
    board: Board
    silhouette: Mask

    def draw(self) -> str:
        """The picture, as it stands in a file."""
        return self.board.draw(self.silhouette)


@dataclass
class _Picture:
    """A picture while it is read: where it begins, its name, its rows with their line numbers."""

    line: int
    name: str
    rows: list[tuple[int, str]]


def parse_silhouettes(text: str, origin: str) -> dict[str, tuple[Board, Mask]]:
    """Read every picture of a text, by name.

    Args:
        text: one or more pictures (see the module).
        origin: where the text comes from, for messages.

    Raises:
        StimulusError: naming ``origin``, line and column, for ragged rows, unknown characters,
            sides over 16 cells, a repeated name, a heading without a picture, or no picture.
    """
    silhouettes: dict[str, tuple[Board, Mask]] = {}
    for picture in _split(text, origin):
        if picture.name in silhouettes:
            raise StimulusError(
                f'{origin}, line {picture.line}: there is already a tower {picture.name!r}'
            )
        silhouettes[picture.name] = _read(picture, origin)
    if not silhouettes:
        raise StimulusError(
            f"{origin}: found no silhouette; draw one with '{FILLED}' for target cells "
            f"and '{EMPTY}' for empty ones"
        )
    return silhouettes


def _split(text: str, origin: str) -> Iterator[_Picture]:
    """Cut a text into pictures; a heading without one is refused."""
    heading: tuple[int, str] | None = None
    rows: list[tuple[int, str]] = []
    count = 0
    for line, content in [*_without_comments(text, origin), (0, '')]:
        match = _HEADING.fullmatch(content)
        if rows and (match or not content):
            count += 1
            yield _Picture(*(heading or (rows[0][0], str(count))), rows)
            heading, rows = None, []
        if match:
            _refuse_bare(heading, origin)
            heading = line, match[1]
        elif content:
            rows.append((line, content))
    _refuse_bare(heading, origin)


def _refuse_bare(heading: tuple[int, str] | None, origin: str) -> None:
    if heading:
        line, name = heading
        raise StimulusError(f'{origin}, line {line}: tower {name!r} has no picture below it')


def _without_comments(text: str, origin: str) -> Iterator[tuple[int, str]]:
    """Line numbers from 1 and lines without comments and trailing blanks.

    Lines that held a comment only are left out. A lone '#' right below a comment is a part of it
    if the comment goes on below, and else may be a row: the writer has to say.
    """
    lines = [line.rstrip(' \t') for line in re.split(r'\r\n|\r|\n', text)]
    unclear: int | None = None
    in_comment = False
    for number, line in enumerate(lines, start=1):
        content = _without_comment(line)
        if line and not content:
            unclear, in_comment = None, True
        elif content == FILLED and in_comment:
            unclear = unclear or number
        elif unclear:
            break
        else:
            in_comment = False
            yield number, content
    if unclear:
        raise StimulusError(
            f"{origin}, line {unclear}: a lone '{FILLED}' below a comment may be comment or row; "
            "put a blank line or 'tower NAME' above a row"
        )


def _without_comment(line: str) -> str:
    """A line without its comment and the blanks before it."""
    begin = _COMMENT.search(line)
    if begin and _WORDS.search(line, begin.end()):
        return line[: begin.start()].rstrip(' \t')
    return line


def _read(picture: _Picture, origin: str) -> tuple[Board, Mask]:
    """The board and mask of one picture."""
    width = len(picture.rows[0][1])
    for index, (line, row) in enumerate(picture.rows):
        _check_row(row, width, f'{origin}, line {line}')
        if index == MAX_SIDE:
            raise StimulusError(
                f'{origin}, line {line}: a silhouette has at most {MAX_SIDE} rows, this is row '
                f'{index + 1} of the picture'
            )
    board = Board(width, len(picture.rows))
    return board, board.parse([row for _, row in picture.rows])


def _check_row(row: str, width: int, place: str) -> None:
    for column, character in enumerate(row, start=1):
        if character not in (FILLED, EMPTY):
            raise StimulusError(
                f"{place}, column {column}: expected '{FILLED}' or '{EMPTY}', got {character!r}"
            )
    if len(row) > MAX_SIDE:
        raise StimulusError(
            f'{place}, column {MAX_SIDE + 1}: a row has at most {MAX_SIDE} cells, '
            f'this one has {len(row)}'
        )
    if len(row) != width:
        raise StimulusError(
            f'{place}, column {min(len(row), width) + 1}: expected {width} cells as in the first '
            f'row of the picture, got {len(row)}'
        )


def read_file(path: Path) -> dict[str, tuple[Board, Mask]]:
    """Read the pictures of a file, by name.

    Raises:
        StimulusError: if the file can't be read, is not UTF-8 text, is larger than 1 MiB, or see
            :func:`parse_silhouettes`.
    """
    try:
        with path.open('rb') as file:
            data = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        if path.is_dir():
            raise StimulusError(f'{path}: is a directory; name a file in it') from None
        raise StimulusError(f'{path}: cannot be read: {error.strerror}') from None
    except ValueError as error:  # a NUL in the path
        raise StimulusError(f'{str(path)!r}: cannot be read: {error}') from None
    if len(data) > MAX_FILE_BYTES:
        raise StimulusError(f'{path}: is larger than {MAX_FILE_BYTES} bytes, not a silhouette')
    try:
        text = data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise StimulusError(f'{path}: is not a text file (byte {error.start})') from None
    return parse_silhouettes(text, str(path))


def installed_sets() -> dict[str, Path]:
    """The sets that ship with the package, by name."""
    sets: dict[str, Path] = {}
    for directory in resource_directories('stimuli'):
        for path in sorted(directory.glob(f'*{SUFFIX}')):
            sets.setdefault(path.stem, path)
    return sets


def find_stimuli(address: str) -> list[Stimulus]:
    """The silhouettes that an address names, in the order of their file.

    Raises:
        StimulusError: if there is no such set, file or silhouette, or it can't be read.
    """
    sets = installed_sets()
    whole = _file_of(address, sets)
    if whole is not None:
        silhouettes = read_file(whole)
        alone = address not in sets and list(silhouettes) == ['1']
        return [
            Stimulus(address if alone else f'{address}/{name}', *silhouette)
            for name, silhouette in silhouettes.items()
        ]
    head, _, item = address.rpartition('/')
    path = _file_of(head, sets) if head else None
    if path is None or not (head in sets or path.is_file()):
        raise StimulusError(
            f'stimulus {shown(address, _MOST_SHOWN)}: no such file, and no such set '
            f'(there are: {", ".join(sorted(sets)) or "none"}); '
            'expected SET, SET/NAME or a path'
        )
    silhouettes = read_file(path)
    if item not in silhouettes:
        raise StimulusError(
            f'stimulus {shown(address, _MOST_SHOWN)}: {path} has no tower {shown(item)}; '
            f'it has {_listing(silhouettes)}'
        )
    return [Stimulus(address, *silhouettes[item])]


def _file_of(address: str, sets: dict[str, Path]) -> Path | None:
    """The file that an address without a name stands for, if there is one."""
    if address in sets:
        return sets[address]
    path = Path(address)
    try:
        return path if address and path.exists() else None
    except (OSError, ValueError):  # too long for the file system, or with a NUL
        return None


def _listing(names: Iterable[str], most: int = 20) -> str:
    listed = list(names)
    more = f' and {len(listed) - most} more' if len(listed) > most else ''
    return ', '.join(listed[:most]) + more
