"""The journal of the world: the placements of the running trial, written before they are said.

A world that is started again in the middle of a trial finds its board here. What is written
outlives any end of the process at once, and a power cut as soon as a thread of its own has seen
it on disk: waiting for that would take longer than the rest of a placement. One file per trial,
``<trial id>.journal``: a line ``blocks_planning/journal 1``, then ``width height column row`` for
each placement. The last line may be torn; any other fault sets the file aside, and nothing is
ever deleted but the journal of a trial that is over, or was left for ``MOST_KEPT`` others.
"""

from __future__ import annotations

import os
import re
from concurrent.futures import ThreadPoolExecutor
from hashlib import blake2b
from pathlib import Path

from blocks_planning.board.blocks import Placed
from blocks_planning.errors import RecordError

_HEADER = b'blocks_planning/journal 1'
_LINE = re.compile(rb'(\d{1,2}) (\d{1,2}) (\d{1,2}) (\d{1,2})')
SUFFIX = '.journal'
MOST_KEPT = 16
"""Journals of trials that were left for others; one trial runs at a time."""


class Journal:
    """The journals in a folder, one of them open."""

    def __init__(self, folder: Path) -> None:
        """Make the folder if it is not there.

        Raises:
            RecordError: if it can't be written to.
        """
        self._folder = folder
        self._descriptor: int | None = None
        self._path: Path | None = None
        self._disk = ThreadPoolExecutor(1, 'journal')  # in the order in which it is asked
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordError(f'{folder}: cannot be written: {error.strerror}') from None

    def begin(self, trial_id: str) -> tuple[list[Placed], str]:
        """Open the journal of a trial, and close any other; an empty one has no file.

        Returns:
            (the placements that it has already; a warning, or '')
        """
        self.close()
        self._path = self._folder / (_file_name(trial_id) + SUFFIX)
        placements, warning = self._read(self._path)
        if placements:
            self._open(self._path, placements)
        return placements, warning

    def append(self, placed: Placed) -> None:
        """Write a placement; it is on disk soon after.

        Raises:
            OSError: if the disk does not take it.
        """
        if self._path is not None:
            if self._descriptor is None:
                self._descriptor = self._open(self._path, [])
            os.write(self._descriptor, b'%d %d %d %d\n' % placed)
            self._disk.submit(os.fdatasync, self._descriptor)

    def end(self) -> None:
        """The trial is over: its journal is of no use any more."""
        path = self._path
        self.close()
        if path is not None:
            path.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the open journal; it stays."""
        self._path = None
        if self._descriptor is not None:
            self._disk.submit(os.close, self._descriptor)
            self._descriptor = None

    def _open(self, path: Path, placements: list[Placed]) -> int:
        """Write a journal anew, as a whole, and keep it open."""
        for old in sorted(self._folder.glob(f'*{SUFFIX}'), key=_age_s)[MOST_KEPT:]:
            old.unlink(missing_ok=True)
        whole = [_HEADER, *(b'%d %d %d %d' % placed for placed in placements)]
        temporary = path.with_suffix('.new')
        temporary.write_bytes(b'\n'.join(whole) + b'\n')
        temporary.replace(path)
        self._descriptor = os.open(path, os.O_WRONLY | os.O_APPEND)
        self._disk.submit(os.fsync, self._descriptor)
        return self._descriptor

    def _read(self, path: Path) -> tuple[list[Placed], str]:
        if not path.exists():
            return [], ''
        header, *lines = path.read_bytes().split(b'\n')
        matches = [_LINE.fullmatch(line) for line in lines[:-1]]  # what follows the last is torn
        if header != _HEADER or not all(matches):
            aside = path.with_suffix(f'.aside-{os.getpid()}')
            path.replace(aside)
            return [], f'{path} is not a journal; it was set aside as {aside.name}'
        return [Placed(*map(int, match.groups())) for match in matches if match], ''


def _age_s(path: Path) -> float:
    try:
        return -path.stat().st_mtime
    except OSError:  # gone already
        return 0.0


def _file_name(trial_id: str) -> str:
    """A name of its own for every id; one comes from a message, and must not leave the folder."""
    plain = re.sub(r'[^A-Za-z0-9_-]', '_', trial_id)[:150]
    if plain == trial_id:
        return plain
    return f'{plain}-{blake2b(trial_id.encode(errors="replace"), digest_size=8).hexdigest()}'
