"""The folder of a study.

::

    DIR/study.json                      what the study says
    DIR/participants/CODE/events.jsonl  what happened, see :mod:`.events`

A participant's folder is made once and never written over.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import NamedTuple

from blocks_planning.errors import ConfigurationError, RecordError
from blocks_planning.study.events import EventKind
from blocks_planning.study.log import Log, read_events
from blocks_planning.study.plan import CODE
from blocks_planning.study.session import Participant
from blocks_planning.study.spec import Study
from blocks_planning.trials import disk
from blocks_planning.trials.linefile import LineFile

STUDY, LOCK = 'study.json', 'lock'
PARTICIPANTS = 'participants'


class StudyFolder:
    """The folder of one study; one process at a time works in it.

    Attributes:
        path: of the folder.
    """

    def __init__(self, path: Path, study: Study, wait_s: float = disk.LOCK_WAIT_S) -> None:
        """Open or make it.

        Args:
            path: of the folder.
            study: that it is to hold.
            wait_s: how long to wait for another process [s].

        Raises:
            ConfigurationError: if it holds another study, or can't be made.
            RecordError: if another process works in it.
        """
        self.path = path
        self._study_id = study.study_id
        there = path / STUDY
        try:
            (path / PARTICIPANTS).mkdir(parents=True, exist_ok=True)
            self._lock = LineFile(path / LOCK, wait_s)
            if not there.exists():
                said = {'study_id': study.study_id, **study.to_json()}
                _write(there, json.dumps(said, indent=2))
        except OSError as error:
            raise ConfigurationError(f'--out {path}: {error.strerror}') from None
        found = read_study_json(path)['study_id']
        if found != study.study_id:
            self.close()
            raise ConfigurationError(
                f'--out {path}: holds another study ({found}, not {study.study_id}); the file of '
                'the study or one of its towers has changed: name another folder'
            )

    def close(self) -> None:
        """Release the folder for other processes."""
        self._lock.close()

    def participants(self) -> list[Participant]:
        """The participants so far, by number."""
        return [one.participant for one in kept_participants(self.path)]

    def add(self, code: str) -> Participant:
        """Make the folder of a new participant.

        Raises:
            ConfigurationError: if the code cannot be one, or has a folder already.
            RecordError: if the folder can't be made.
        """
        CODE.check(code)
        participant = Participant(code, self._next_number(), self._study_id)
        folder = self.folder_of(code)
        try:
            folder.mkdir(exist_ok=True)
            is_taken = any(path.stat().st_size for path in folder.iterdir())
        except OSError as error:
            raise RecordError(f'{folder}: cannot be made: {error.strerror}') from None
        if is_taken:
            raise ConfigurationError(
                f'participant {code!r} has a folder already; take another code'
            )
        return participant

    def log_of(self, code: str) -> Log:
        """The log of a participant."""
        return Log(self.folder_of(code))

    def folder_of(self, code: str) -> Path:
        """The folder of a participant."""
        return self.path / PARTICIPANTS / code

    def _next_number(self) -> int:
        return max((one.number for one in self.participants()), default=-1) + 1


class Kept(NamedTuple):
    """A participant, and the folder with what is kept."""

    participant: Participant
    folder: Path


def read_study_json(path: Path) -> dict[str, object]:
    """What the study of a folder says.

    Raises:
        ConfigurationError: if there is none.
    """
    try:
        found = json.loads((path / STUDY).read_text(encoding='utf-8'))
    except (OSError, ValueError):
        found = None
    if not isinstance(found, dict) or 'study_id' not in found:
        raise ConfigurationError(f'{path}: is not the folder of a study: it has no {STUDY}')
    return found


def kept_participants(path: Path) -> list[Kept]:
    """The participants of a study's folder, by number; empty folders are skipped.

    Raises:
        RecordError: if the events of one can't be read.
    """
    found = []
    for folder in sorted((path / PARTICIPANTS).iterdir()):
        events = read_events(folder) if folder.is_dir() and any(folder.iterdir()) else []
        if events and events[0].kind is EventKind.OPENED:
            data = events[0].data
            participant = Participant(data['participant'], data['number'], data['study_id'])
            found.append(Kept(participant, folder))
    return sorted(found, key=lambda kept: kept.participant.number)


def _write(path: Path, text: str) -> None:
    part = path.with_suffix('.part')
    part.write_text(text + '\n', encoding='utf-8')
    part.replace(path)
