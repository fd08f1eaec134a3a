"""A file to which lines are appended, and that stays valid when the process is interrupted."""

from __future__ import annotations

from pathlib import Path

from blocks_planning.errors import RecordError
from blocks_planning.trials import disk


class LineFile:
    """A line is on disk when :meth:`append` returns, or not there at all.

    An incomplete last line of an interrupted writer is moved to a separate file with the suffix
    .torn, never deleted. The file is locked for other writers.

    Attributes:
        path: of the file.
    """

    def __init__(self, path: Path, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Open or make the file.

        Args:
            path: of the file; its folder is made.
            wait_s: how long to wait for another process that writes it [s].

        Raises:
            RecordError: if it can't be written, or another process is still writing it.
        """
        self.path = path
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open('ab+', buffering=0)
        except OSError as error:
            raise self._cannot(error) from None
        try:
            disk.lock(self._file.fileno(), path, wait_s)
            self._put_aside()
        except RecordError:
            self._file.close()
            raise
        except OSError as error:
            self._file.close()
            raise self._cannot(error) from None

    def _put_aside(self) -> None:
        data = self._all()
        torn = data.rpartition(b'\n')[2]
        if torn:
            with self.path.with_suffix('.torn').open('ab') as aside:
                aside.write(torn + b'\n')
            self._file.truncate(len(data) - len(torn))

    def _all(self) -> bytes:
        self._file.seek(0)
        return self._file.read()

    def lines(self) -> list[bytes]:
        """Every line, without its end."""
        return self._all().split(b'\n')[:-1]

    def append(self, line: bytes) -> None:
        """Write a line, and return when it is on disk.

        Args:
            line: without its end.

        Raises:
            RecordError: if it cannot be written; the file is then unchanged.
        """
        try:
            disk.append(self._file.fileno(), line + b'\n', sync=True)
        except OSError as error:
            raise self._cannot(error) from None

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _cannot(self, error: OSError) -> RecordError:
        return RecordError(f'{self.path}: cannot be written: {error.strerror}')
