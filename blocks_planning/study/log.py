"""The file of a participant's events."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from blocks_planning.errors import RecordError
from blocks_planning.study.events import Event, read_event
from blocks_planning.trials.linefile import LineFile

EVENTS = 'events.jsonl'


class Log:
    """The events of a session; an event is on disk when :meth:`append` returns."""

    def __init__(self, folder: Path) -> None:
        """Open or make the file in a participant's folder.

        Raises:
            RecordError: if it can't be written, or another process writes it.
        """
        self._file = LineFile(folder / EVENTS)

    def events(self) -> list[Event]:
        """All events.

        Raises:
            RecordError: if a line is no event.
        """
        return list(_events(self._file.lines(), self._file.path))

    def append(self, event: Event) -> None:
        """Keep an event.

        Raises:
            RecordError: if the disk does not take it; then it has not happened.
        """
        self._file.append(event.to_line())

    def close(self) -> None:
        """Close the file."""
        self._file.close()


def read_events(folder: Path) -> list[Event]:
    """The events of a participant's folder, while or after they are written.

    Raises:
        RecordError: if they can't be read, or a line is no event.
    """
    path = folder / EVENTS
    try:
        lines = path.read_bytes().split(b'\n')[:-1]
    except OSError as error:
        raise RecordError(f'{path}: cannot be read: {error.strerror}') from None
    return list(_events(lines, path))


def _events(lines: list[bytes], path: Path) -> Iterator[Event]:
    for number, line in enumerate(lines, start=1):
        yield read_event(line, f'{path}, line {number}')
