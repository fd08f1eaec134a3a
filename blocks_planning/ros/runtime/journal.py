"""The journal of the world: the observations of the running trial, written before publication.

A world that is restarted in the middle of a trial restores its board from the journal. A written
line survives the end of the process immediately, and a power cut as soon as a separate thread has
flushed it to disk: waiting for that would take longer than the rest of a placement. One file per
trial, ``<trial id>.journal``: a line ``blocks_planning/journal 2``, then a line
``order;landed;gone`` for each observation after the first. The order is ``width height column``,
or empty; the blocks are ``width height column row``, separated by commas. Version 1, with a line
``width height column row`` for each placement, is still read. The last line may be truncated; a
file with any other fault is renamed. Only the journal of a finished trial is deleted, or that of an
interrupted trial after ``MOST_KEPT`` later ones. One process at a time writes in a folder.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from hashlib import blake2b
from itertools import count
from pathlib import Path

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.errors import RecordError
from blocks_planning.trials import disk
from blocks_planning.worlds.observation import Blocks, Observation

_HEADER = b'blocks_planning/journal 2'
_HEADER_1 = b'blocks_planning/journal 1'
_NUMBER = rb'\d{1,2}'
_BLOCK = b' '.join([_NUMBER] * 4)
_BLOCKS = b'((?:' + _BLOCK + b'(?:,' + _BLOCK + b')*)?)'
_LINE = re.compile(b'((?:' + b' '.join([_NUMBER] * 3) + b')?);' + _BLOCKS + b';' + _BLOCKS)
_LINE_1 = re.compile(_BLOCK)
SUFFIX = '.journal'
MOST_KEPT = 16
"""Number of kept journals of interrupted trials; one trial runs at a time."""


class Journal:
    """The journals in a folder, one of them open."""

    def __init__(self, folder: Path, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Make the folder if it is not there, and lock it.

        Args:
            folder: of the journals.
            wait_s: how long to wait for another process that writes there [s].

        Raises:
            RecordError: if it can't be written to, or another process is still writing.
        """
        self._folder = folder
        self._descriptor: int | None = None
        self._path: Path | None = None
        self._failure: OSError | None = None
        self._disk = ThreadPoolExecutor(1, 'journal')  # one thread keeps the order of requests
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._lock = os.open(folder, os.O_RDONLY)
        except OSError as error:
            raise RecordError(f'{folder}: cannot be written: {error.strerror}') from None
        try:
            disk.lock(self._lock, folder, wait_s)
        except RecordError:
            os.close(self._lock)
            raise

    def begin(self, trial_id: str) -> tuple[list[Observation], str]:
        """Open the journal of a trial, and close any other; an empty one has no file.

        Returns:
            (the observations in the journal; a warning, or '')

        Raises:
            RecordError: if the file cannot be written or read.
        """
        self.close()
        self._path = path = self._folder / (file_name(trial_id) + SUFFIX)
        try:
            observations, warning = _read(path)
            if observations:
                self._open(path, observations)
        except OSError as error:
            raise _unwritable(path, error) from None
        return observations, warning

    def append(self, seen: Observation) -> None:
        """Write an observation; it is on disk soon after.

        Raises:
            RecordError: if it cannot be written; the journal is then unchanged.
        """
        if self._path is None:
            raise RecordError(f'{self._folder}: no journal is open')
        try:
            descriptor = self._descriptor
            if descriptor is None:
                descriptor = self._open(self._path, [])
            if self._failure is not None:
                raise self._failure
            disk.append(descriptor, _line(seen), sync=False)
        except OSError as error:
            raise _unwritable(self._path, error) from None
        self._disk.submit(self._sync, descriptor)

    def refuse(self) -> str:
        """Rename the open journal, because it is inconsistent, and begin an empty one.

        Returns:
            a warning

        Raises:
            RecordError: if it cannot be written.
        """
        path = self._path
        assert path is not None
        self.close()
        self._path = path
        try:
            name = _set_aside(path)
        except OSError as error:
            raise _unwritable(path, error) from None
        return f'{path} is of another trial; it was renamed to {name}'

    def end(self) -> None:
        """Delete the journal of a finished trial."""
        path = self._path
        self.close()
        if path is not None:
            with suppress(OSError):  # harmless: its trial does not run again
                path.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the open journal, and keep its file."""
        self._path = None
        if self._descriptor is not None:
            self._disk.submit(os.close, self._descriptor)
            self._descriptor = None

    def release(self) -> None:
        """Close the open journal, and release the folder."""
        self.close()
        self._disk.shutdown()
        os.close(self._lock)

    def _open(self, path: Path, observations: list[Observation]) -> int:
        """Rewrite the file, without a truncated line, and open it for appending."""
        for old in sorted(self._folder.glob(f'*{SUFFIX}'), key=_latest_first)[MOST_KEPT:]:
            old.unlink(missing_ok=True)
        temporary = path.with_suffix('.new')
        with temporary.open('wb') as file:
            file.write(b''.join([_HEADER + b'\n', *map(_line, observations)]))
            if observations:  # an empty journal need not be on disk
                file.flush()
                os.fsync(file.fileno())
        temporary.replace(path)
        self._descriptor = os.open(path, os.O_RDWR | os.O_APPEND)
        self._failure = None
        self._disk.submit(self._sync, self._descriptor)
        self._disk.submit(self._sync, self._lock)
        return self._descriptor

    def _sync(self, descriptor: int) -> None:
        """Flush a file, or the names in the folder, to disk; report a failure at the next write."""
        try:
            os.fsync(descriptor)
        except OSError as error:
            self._failure = error


def _unwritable(path: Path, error: OSError) -> RecordError:
    return RecordError(f'{path}: cannot be written: {error.strerror}')


def _set_aside(path: Path) -> str:
    free = (path.with_suffix(f'.aside-{number}') for number in count(1))
    aside = next(path for path in free if not path.exists())
    path.replace(aside)
    return aside.name


def _read(path: Path) -> tuple[list[Observation], str]:
    """The observations of a journal, and a warning if the file is not a journal."""
    if not path.exists():
        return [], ''
    header, *lines = path.read_bytes().split(b'\n')
    pattern, parse = _FORMATS.get(header, _FORMATS[_HEADER])
    matches = [pattern.fullmatch(line) for line in lines[:-1]]  # the rest is truncated
    if header not in _FORMATS or not all(matches):
        return [], f'{path} is not a journal; it was renamed to {_set_aside(path)}'
    return [parse(match) for match in matches if match], ''


def _observation(match: re.Match[bytes]) -> Observation:
    order, landed, gone = match.groups()
    ordered = None
    if order:
        width, height, column = map(int, order.split())
        ordered = Placement(Block(width, height), column)
    return Observation(ordered, _blocks(landed), _blocks(gone))


def _observation_1(match: re.Match[bytes]) -> Observation:
    (placed,) = _blocks(match.group())
    return Observation(placed.placement, (placed,))


_FORMATS: dict[bytes, tuple[re.Pattern[bytes], Callable[[re.Match[bytes]], Observation]]] = {
    _HEADER: (_LINE, _observation),
    _HEADER_1: (_LINE_1, _observation_1),
}


def _blocks(text: bytes) -> Blocks:
    return tuple(Placed(*map(int, part.split())) for part in text.split(b',') if part)


def _line(seen: Observation) -> bytes:
    order = () if seen.ordered is None else (*seen.ordered.block, seen.ordered.column)
    parts = (_words(order), _listed(seen.landed), _listed(seen.gone))
    return f'{";".join(parts)}\n'.encode()


def _listed(blocks: Blocks) -> str:
    return ','.join(_words(placed) for placed in blocks)


def _words(numbers: Iterable[int]) -> str:
    return ' '.join(map(str, numbers))


def _latest_first(path: Path) -> float:
    try:
        return -path.stat().st_mtime
    except OSError:  # gone already
        return 0.0


def file_name(trial_id: str) -> str:
    """A unique file name for an id; ids come from messages, and must not lead out of the folder."""
    plain = re.sub(r'[^A-Za-z0-9_-]', '_', trial_id)[:150]
    if plain == trial_id:
        return plain
    return f'{plain}-{blake2b(trial_id.encode(errors="replace"), digest_size=8).hexdigest()}'
