"""The journal of the world: the placements of the running trial, written before they are said.

A world that is started again in the middle of a trial finds its board here. What is written
outlives any end of the process at once, and a power cut as soon as a thread of its own has seen
it on disk: waiting for that would take longer than the rest of a placement. One file per trial,
``<trial id>.journal``: a line ``blocks_planning/journal 1``, then ``width height column row`` for
each placement. The last line may be torn; any other fault sets the file aside, and nothing is
ever deleted but the journal of a trial that is over. One process at a time writes in a folder.
"""

from __future__ import annotations

import os
import re
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from itertools import count
from pathlib import Path

from blocks_planning.board.blocks import Placed
from blocks_planning.errors import RecordError
from blocks_planning.trials import disk

_HEADER = b'blocks_planning/journal 1'
_LINE = re.compile(rb'(\d{1,2}) (\d{1,2}) (\d{1,2}) (\d{1,2})')
SUFFIX = '.journal'


class Journal:
    """The journals in a folder, one of them open."""

    def __init__(self, folder: Path, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Make the folder if it is not there, and lock it.

        Args:
            folder: of the journals.
            wait_s: how long to wait for another process that writes there [s].

        Raises:
            RecordError: if it can't be written to, or another process still does.
        """
        self._folder = folder
        self._descriptor: int | None = None
        self._path = folder
        self._failure: OSError | None = None
        self._disk = ThreadPoolExecutor(1, 'journal')  # in the order in which it is asked
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

    def begin(self, trial_id: str) -> tuple[list[Placed], str]:
        """Open the journal of a trial, and close any other.

        Returns:
            (the placements that it has already; a warning, or '')

        Raises:
            RecordError: if the disk does not take it, or does not give it back.
        """
        self.close()
        # An id comes from a message: no part of it may lead out of the folder.
        self._path = self._folder / (re.sub(r'[^A-Za-z0-9_-]', '_', trial_id)[:200] + SUFFIX)
        try:
            placements, warning = self._read()
            self._open(placements)
        except OSError as error:
            raise self._unwritable(error) from None
        return placements, warning

    def append(self, placed: Placed) -> None:
        """Write a placement; it is on disk soon after.

        Raises:
            RecordError: if the disk does not take it; the journal is as it was.
        """
        if self._descriptor is None:
            raise RecordError(f'{self._path}: could not be opened when the trial began')
        try:
            if self._failure is not None:
                raise self._failure
            disk.append(self._descriptor, _line(placed), sync=False)
        except OSError as error:
            raise self._unwritable(error) from None
        self._disk.submit(self._sync, self._descriptor)

    def refuse(self) -> str:
        """Set the open journal aside, for it can't be right, and begin an empty one.

        Returns:
            a warning

        Raises:
            RecordError: if the disk does not take it.
        """
        self.close()
        try:
            name = self._set_aside()
            self._open([])
        except OSError as error:
            raise self._unwritable(error) from None
        return f'{self._path} is of another trial; it was set aside as {name}'

    def end(self) -> None:
        """The trial is over: its journal is of no use any more."""
        self.close()
        with suppress(OSError):  # it does no harm: its trial does not run again
            self._path.unlink(missing_ok=True)

    def close(self) -> None:
        """Close the open journal; it stays."""
        if self._descriptor is not None:
            self._disk.submit(os.close, self._descriptor)
            self._descriptor = None

    def release(self) -> None:
        """Close the open journal, and let others write in the folder."""
        self.close()
        self._disk.shutdown()
        os.close(self._lock)

    def _open(self, placements: list[Placed]) -> None:
        """Write all anew, so that nothing torn is left, and open it for more."""
        temporary = self._path.with_suffix('.new')
        with temporary.open('wb') as file:
            file.write(b''.join([_HEADER + b'\n', *map(_line, placements)]))
            if placements:  # an empty journal is worth no waiting
                file.flush()
                os.fsync(file.fileno())
        temporary.replace(self._path)
        self._descriptor = os.open(self._path, os.O_RDWR | os.O_APPEND)
        self._failure = None
        self._disk.submit(self._sync, self._descriptor)
        self._disk.submit(self._sync, self._lock)

    def _sync(self, descriptor: int) -> None:
        """See a file, or the names in the folder, on disk; if not, the next placement fails."""
        try:
            os.fsync(descriptor)
        except OSError as error:
            self._failure = error

    def _unwritable(self, error: OSError) -> RecordError:
        return RecordError(f'{self._path}: cannot be written: {error.strerror}')

    def _set_aside(self) -> str:
        free = (self._path.with_suffix(f'.aside-{number}') for number in count(1))
        aside = next(path for path in free if not path.exists())
        self._path.replace(aside)
        return aside.name

    def _read(self) -> tuple[list[Placed], str]:
        if not self._path.exists():
            return [], ''
        header, *lines = self._path.read_bytes().split(b'\n')
        matches = [_LINE.fullmatch(line) for line in lines[:-1]]  # what follows the last is torn
        if header != _HEADER or not all(matches):
            return [], f'{self._path} is not a journal; it was set aside as {self._set_aside()}'
        return [Placed(*map(int, match.groups())) for match in matches if match], ''


def _line(placed: Placed) -> bytes:
    return b'%d %d %d %d\n' % placed
