"""The file to which finished records are appended, one per line."""

from __future__ import annotations

import json
from pathlib import Path

from blocks_planning.errors import RecordError
from blocks_planning.trials import disk
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


class RecordFile:
    """A file of trial records that stays valid when the writing process is interrupted.

    A record is on disk when :meth:`append` returns. An incomplete last line of an interrupted
    writer is moved to a separate file, never deleted. The file is locked for other writers.
    """

    def __init__(self, path: Path, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Open or make the file.

        Args:
            path: of the file; its folder is made.
            wait_s: how long to wait for another process that writes it [s].

        Raises:
            RecordError: if it can't be written, a line is not a record, or another process is
                still writing it.
        """
        self._path = path
        self.finished: set[str] = set()
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = path.open('ab+', buffering=0)
        except OSError as error:
            raise RecordError(f'{path}: cannot be written: {error.strerror}') from None
        try:
            disk.lock(self._file.fileno(), path, wait_s)
            self._file.seek(0)
            self._read(self._file.read())
        except RecordError:
            self._file.close()
            raise
        except OSError as error:
            self._file.close()
            raise RecordError(f'{path}: cannot be written: {error.strerror}') from None

    def _read(self, data: bytes) -> None:
        whole, _, torn = data.rpartition(b'\n')
        if torn:
            with self._path.with_suffix('.torn').open('ab') as aside:
                aside.write(torn + b'\n')
            self._file.truncate(len(data) - len(torn))
        for number, line in enumerate(whole.split(b'\n') if whole else [], start=1):
            trial_id, is_finished = _read(line, f'{self._path}, line {number}')
            if is_finished:
                self.finished.add(trial_id)

    def append(self, record: TrialRecord) -> None:
        """Write a record, and return when it is on disk.

        Raises:
            RecordError: if it cannot be written; the file is then unchanged.
        """
        line = record.to_line().encode() + b'\n'
        try:
            disk.append(self._file.fileno(), line, sync=True)
        except OSError as error:
            raise RecordError(f'{self._path}: cannot be written: {error.strerror}') from None
        if record.status is not TrialStatus.CANCELLED:
            self.finished.add(record.spec.trial_id)

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def _read(line: bytes, place: str) -> tuple[str, bool]:
    """The trial id of a record, and whether the trial was finished and not cancelled."""
    try:
        record = json.loads(line)
        return str(record['trial_id']), record['status'] != TrialStatus.CANCELLED.value
    except (ValueError, KeyError, TypeError, RecursionError):
        raise RecordError(
            f'{place}: is not a trial record; move the file to another place'
        ) from None
