"""The file to which finished records are appended, one per line."""

from __future__ import annotations

import json
from pathlib import Path

from blocks_planning.errors import RecordError
from blocks_planning.trials import disk
from blocks_planning.trials.linefile import LineFile
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


class RecordFile:
    """A file of trial records; see :class:`LineFile`.

    Attributes:
        finished: ids of the trials in it that came to their own end.
    """

    def __init__(self, path: Path, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Open or make the file; see :class:`LineFile`.

        Raises:
            RecordError: also if a line is not a record.
        """
        self.finished: set[str] = set()
        self._file = LineFile(path, wait_s)
        try:
            for number, line in enumerate(self._file.lines(), start=1):
                trial_id, is_finished = _read(line, f'{path}, line {number}')
                if is_finished:
                    self.finished.add(trial_id)
        except RecordError:
            self.close()
            raise

    def append(self, record: TrialRecord) -> None:
        """Write a record, and return when it is on disk.

        Raises:
            RecordError: if it cannot be written; the file is then unchanged.
        """
        self._file.append(record.to_line().encode())
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
