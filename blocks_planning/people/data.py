"""Reads the human data that ship with the package (stimuli/people/README.md)."""

from __future__ import annotations

import csv
import gzip
from collections.abc import Iterator
from functools import lru_cache
from itertools import groupby
from pathlib import Path
from typing import NamedTuple, TextIO

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.resources import resource_directories

SET = 'cogsci2021'
SEQUENCES = 'building_sequences.csv.gz'
PARTS = 'perceptual_chunks.csv'


class Build(NamedTuple):
    """A tower that a person or a planner built.

    Attributes:
        builder: name of the person or planner; builds of one builder are resampled together.
        tower: name of the silhouette in its set.
        placements: in the order of building. A person's may lie partly or wholly off the board.
    """

    builder: str
    tower: str
    placements: tuple[Placed, ...]


class Marking(NamedTuple):
    """The parts that a person marked in a silhouette, ordered by number."""

    marker: str
    pilot: str
    tower: str
    parts: tuple[Mask, ...]


def installed_file(name: str) -> Path:
    """The path of a file of ``stimuli/people``.

    Raises:
        InvalidInput: if it is not installed.
    """
    for directory in resource_directories('stimuli'):
        path = Path(directory, 'people', name)
        if path.is_file():
            return path
    raise InvalidInput(f'stimuli/people/{name} is not installed; install the package again')


@lru_cache(maxsize=1)
def tasks() -> dict[str, Task]:
    """The task of each silhouette of the set, by name, with the paper's library."""
    found = find_stimuli(SET)
    return {
        stimulus.name.rpartition('/')[2]: Task(stimulus.board, stimulus.silhouette)
        for stimulus in found
    }


def read_builds(path: Path | None = None) -> list[Build]:
    """The builds of people, trial by trial.

    Args:
        path: of a file with the same columns as the installed one; None: the installed one.

    Raises:
        InvalidInput: if the file cannot be read, or a value does not suit its column.
    """
    path = path or installed_file(SEQUENCES)
    rows = _rows(path, ('participant', 'trial', 'tower', 'width', 'height', 'column', 'row'))
    builds = []
    for (participant, _, tower), part in groupby(rows, _trial_of):
        placements = tuple(_placed(row, place) for place, row in part)
        builds.append(Build(participant, tower, placements))
    return builds


def read_markings(path: Path | None = None) -> list[Marking]:
    """The parts that people marked; see :func:`read_builds` for the argument and errors."""
    path = path or installed_file(PARTS)
    return [
        Marking(
            f'{row["pilot"]}{row["participant"]}',
            row['pilot'],
            row['tower'],
            _parts(row['chunks'], row['tower'], place),
        )
        for place, row in _rows(path, ('pilot', 'participant', 'tower', 'chunks'))
    ]


def _rows(path: Path, columns: tuple[str, ...]) -> Iterator[tuple[str, dict[str, str]]]:
    """The rows of a CSV file, each with its place for messages."""
    try:
        with _open(path) as file:
            reader = csv.DictReader(file)
            for row in reader:
                place = f'{path}, line {reader.line_num}'
                for column in columns:
                    if row.get(column) is None:
                        raise InvalidInput(f'{place}: missing column {column!r}')
                if row['tower'] not in tasks():
                    raise InvalidInput(
                        f'{place}: unknown tower {row["tower"]!r} of {SET}; '
                        f'expected one of {", ".join(tasks())}'
                    )
                yield place, row
    except (OSError, EOFError, UnicodeDecodeError, csv.Error) as error:
        raise InvalidInput(f'{path}: cannot be read: {error}') from None


def _open(path: Path) -> TextIO:
    if path.suffix == '.gz':
        return gzip.open(path, 'rt', encoding='utf-8')
    return path.open(encoding='utf-8')


def _trial_of(item: tuple[str, dict[str, str]]) -> tuple[str, str, str]:
    _, row = item
    return row['participant'], row['trial'], row['tower']


def _placed(row: dict[str, str], place: str) -> Placed:
    try:
        return Placed(*(int(row[name]) for name in Placed._fields))
    except ValueError as error:
        raise InvalidInput(f'{place}: expected whole numbers of cells: {error}') from None


def _parts(text: str, tower: str, place: str) -> tuple[Mask, ...]:
    """The masks of the parts that a picture in digits shows."""
    board = tasks()[tower].board
    lines = text.split('/')
    if [len(line) for line in lines] != [board.width] * board.height:
        raise InvalidInput(
            f'{place}: expected {board.height} rows of {board.width} digits separated by /, '
            f'got {text!r}'
        )
    digits = sorted(set(text) - {'0', '/'})
    return tuple(_cells_with(digit, lines, board) for digit in digits)


def _cells_with(digit: str, lines: list[str], board: Board) -> Mask:
    return board.mask(
        (column, board.height - 1 - number)
        for number, line in enumerate(lines)
        for column, found in enumerate(line)
        if found == digit
    )
