"""Silhouettes as text pictures: their form in files and records.

A file holds one or more pictures, top row first, '#' for a target cell and '.' for an empty one::

    # A comment: a '#', a blank, and words.
    tower 9
    ...###..
    .#.###..

A line ``tower NAME`` names the picture below it (:mod:`.names`); otherwise pictures are numbered
from 1. Pictures are separated by blank lines or headings. CRLF, trailing blanks, a byte order
mark and comments after a row are accepted. If a picture is wider or taller than a board, its
empty margins in that direction are removed.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from blocks_planning.board.geometry import EMPTY, FILLED, MAX_SIDE, Board, Mask
from blocks_planning.board.names import name_fault, normalised
from blocks_planning.errors import StimulusError

MAX_FILE_BYTES = 1 << 20

_HEADING = re.compile(r'tower(?:[ \t]+(.*))?', re.DOTALL)
# A comment needs a character that no row has, so that a row drawn with blanks is an error and
# not silently ignored.
_COMMENT = re.compile(r'(?:^|[ \t])#[ \t]')
_WORDS = re.compile(r'[^#. \t]')


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
            sides over 16 cells without their empty margins, a heading without a usable name or
            without a picture, a repeated name, or no picture.
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


def format_silhouette(
    name: str, board: Board, silhouette: Mask, comments: Iterable[str] = ()
) -> str:
    """A named picture as :func:`parse_silhouettes` reads it, with a newline at its end.

    Args:
        name: of the tower (:mod:`.names`).
        board: its size.
        silhouette: its target cells.
        comments: lines of words above the picture.
    """
    lines = [f'# {comment}' for comment in comments]
    return '\n'.join([*lines, f'tower {name}', board.draw(silhouette), ''])


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
            heading = line, _name_in(match, f'{origin}, line {line}')
        elif content:
            rows.append((line, content))
    _refuse_bare(heading, origin)


def _name_in(heading: re.Match[str], place: str) -> str:
    """The name in a heading."""
    name = heading[1] or ''
    fault = name_fault(name)
    if fault is not None:
        index, reason = fault
        column = (heading.start(1) if name else heading.end()) + index + 1
        raise StimulusError(f'{place}, column {column}: {reason}')
    return normalised(name)


def _refuse_bare(heading: tuple[int, str] | None, origin: str) -> None:
    if heading:
        line, name = heading
        raise StimulusError(f'{origin}, line {line}: tower {name!r} has no picture below it')


def _without_comments(text: str, origin: str) -> Iterator[tuple[int, str]]:
    """Line numbers from 1 and lines without comments and trailing blanks.

    Lines that held a comment only are left out. A lone '#' directly below a comment is a part of
    it if the comment continues below; otherwise it could be a row, so it is refused.
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
    for line, row in picture.rows:
        _check_row(row, width, f'{origin}, line {line}')
    left, right = _extent([''.join(column) for column in zip(*_texts(picture), strict=True)])
    top, bottom = _extent(_texts(picture))
    if right - left > MAX_SIDE:
        raise StimulusError(
            f'{origin}, line {picture.rows[0][0]}, column {left + MAX_SIDE + 1}: a row has at '
            f'most {MAX_SIDE} cells between its empty margins, this one has {right - left}'
        )
    if bottom - top > MAX_SIDE:
        raise StimulusError(
            f'{origin}, line {picture.rows[top + MAX_SIDE][0]}: a silhouette has at most '
            f'{MAX_SIDE} rows between its empty margins, this is row {MAX_SIDE + 1} of the picture'
        )
    board = Board(right - left, bottom - top)
    return board, board.parse([row[left:right] for row in _texts(picture)[top:bottom]])


def _texts(picture: _Picture) -> list[str]:
    return [row for _, row in picture.rows]


def _extent(lines: list[str]) -> tuple[int, int]:
    """First line and end of the kept part: all if it fits a board, otherwise without margins."""
    filled = [index for index, line in enumerate(lines) if FILLED in line]
    if len(lines) <= MAX_SIDE or not filled:
        return 0, len(lines)
    return filled[0], filled[-1] + 1


def _check_row(row: str, width: int, place: str) -> None:
    for column, character in enumerate(row, start=1):
        if character not in (FILLED, EMPTY):
            hint = "; a heading is written 'tower NAME'" if row.lower().startswith('tower') else ''
            raise StimulusError(
                f"{place}, column {column}: expected '{FILLED}' or '{EMPTY}', "
                f'got {character!r}{hint}'
            )
    if len(row) != width:
        raise StimulusError(
            f'{place}, column {min(len(row), width) + 1}: expected {width} cells as in the first '
            f'row of the picture, got {len(row)}'
        )


def read_file(path: Path) -> dict[str, tuple[Board, Mask]]:
    """Read the pictures of a file, by name.

    Raises:
        StimulusError: see :func:`read_text` and :func:`parse_silhouettes`.
    """
    return parse_silhouettes(read_text(path), str(path))


def read_text(path: Path) -> str:
    """The text of a file with silhouettes in any form.

    Raises:
        StimulusError: if the file can't be read, is not UTF-8 text, or is larger than 1 MiB.
    """
    try:
        with path.open('rb') as file:
            data = file.read(MAX_FILE_BYTES + 1)
    except OSError as error:
        if isinstance(error, IsADirectoryError):
            raise StimulusError(f'{path}: is a directory; name a file in it') from None
        raise StimulusError(f'{path}: cannot be read: {error.strerror}') from None
    except ValueError as error:  # a NUL in the path
        raise StimulusError(f'{str(path)!r}: cannot be read: {error}') from None
    if len(data) > MAX_FILE_BYTES:
        raise StimulusError(f'{path}: is larger than {MAX_FILE_BYTES} bytes, not a silhouette')
    try:
        return data.decode('utf-8-sig')
    except UnicodeDecodeError as error:
        raise StimulusError(f'{path}: is not a text file (byte {error.start})') from None
