"""The journal of the world: the placements of the running trial, written before they are said.

A world that is started again in the middle of a trial finds its board here. What is written
outlives any end of the process at once, and a power cut as soon as a thread of its own has seen
it on disk: waiting for that would take longer than the rest of a placement. One file per trial,
``<trial id>.journal``: a line ``blocks_planning/journal 1``, then ``width height column row`` for
each placement. The last line may be torn; any other fault sets the file aside, and nothing is
ever deleted but the journal of a trial that is over.
"""

from __future__ import annotations

import os
import re
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from blocks_planning.board.blocks import Placed
from blocks_planning.errors import RecordError

_HEADER = b'blocks_planning/journal 1'
_LINE = re.compile(rb'(\d{1,2}) (\d{1,2}) (\d{1,2}) (\d{1,2})')
SUFFIX = '.journal'


class Journal:
    """The journals in a folder, one of them open."""

    def __init__(self, folder: Path) -> None:
        """Make the folder if it is not there.

        Raises:
            RecordError: if it can't be written to.
        """
        self._folder = folder
        self._descriptor: int | None = None
        self._path = folder
        self._disk = ThreadPoolExecutor(1, 'journal')  # in the order in which it is asked
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise RecordError(f'{folder}: cannot be written: {error.strerror}') from None

    def begin(self, trial_id: str) -> tuple[list[Placed], str]:
        """Open the journal of a trial, and close any other.

        Returns:
            (the placements that it has already; a warning, or '')
        """
        self.close()
        # An id comes from a message: no part of it may lead out of the folder.
        self._path = self._folder / (re.sub(r'[^A-Za-z0-9_-]', '_', trial_id)[:200] + SUFFIX)
        placements, warning = self._read()
        whole = [_HEADER, *(b'%d %d %d %d' % placed for placed in placements)]
        temporary = self._path.with_suffix('.new')
        temporary.write_bytes(b'\n'.join(whole) + b'\n')
        temporary.replace(self._path)
        self._descriptor = os.open(self._path, os.O_WRONLY | os.O_APPEND)
        self._disk.submit(os.fsync, self._descriptor)
        return placements, warning

    def append(self, placed: Placed) -> None:
        """Write a placement; it is on disk soon after.

        Raises:
            OSError: if the disk does not take it.
        """
        if self._descriptor is not None:
            os.write(self._descriptor, b'%d %d %d %d\n' % placed)
            self._disk.submit(os.fdatasync, self._descriptor)

    def end(self) -> None:
        """The trial is over: its journal is of no use any more."""
        self.close()
        self._path.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the open journal; it stays."""
        if self._descriptor is not None:
            self._disk.submit(os.close, self._descriptor)
            self._descriptor = None

    def _read(self) -> tuple[list[Placed], str]:
        if not self._path.exists():
            return [], ''
        header, *lines = self._path.read_bytes().split(b'\n')
        matches = [_LINE.fullmatch(line) for line in lines[:-1]]  # what follows the last is torn
        if header != _HEADER or not all(matches):
            aside = self._path.with_suffix(f'.aside-{os.getpid()}')
            self._path.replace(aside)
            return [], f'{self._path} is not a journal; it was set aside as {aside.name}'
        return [Placed(*map(int, match.groups())) for match in matches if match], ''
