"""The experimenter's desk: one participant at a time holds the session."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from blocks_planning.errors import ConfigurationError
from blocks_planning.study.events import Event, Moment
from blocks_planning.study.folder import Kept, StudyFolder, kept_participants
from blocks_planning.study.log import read_events
from blocks_planning.study.machine import State, Status, state_after
from blocks_planning.study.plan import Step, steps_of
from blocks_planning.study.session import Participant, Session, now
from blocks_planning.study.spec import Study


class Standing(NamedTuple):
    """How far a participant is; ``steps`` is how many there are."""

    participant: Participant
    state: State
    steps: int


class Desk:
    """Begins, closes and opens again the sessions of a study.

    Attributes:
        study: the study.
        folder: where it is kept.
        session: the one that is open; None if none is.
    """

    def __init__(self, study: Study, path: Path, clock: Callable[[], Moment] = now) -> None:
        """Open a study's folder, and the session that was open when a server ended.

        Raises:
            ConfigurationError: if the folder holds another study.
            RecordError: if something in it can't be read or written.
        """
        self.study = study
        self.folder = StudyFolder(path, study)
        self._clock = clock
        self.session: Session | None = None
        self._others: dict[str, Standing] = {}
        standings = [standing_of(study, kept) for kept in kept_participants(path)]
        for standing in standings:
            self._others[standing.participant.code] = standing
        for standing in standings:
            if not standing.state.is_closed and not _is_over(standing):
                self._open(standing.participant)
                break

    def begin(self, code: str) -> None:
        """Begin the session of the next participant.

        Raises:
            ConfigurationError: if a session is open that is not over, or the code can't be used.
            RecordError: if nothing can be kept.
        """
        self._leave_if_over()
        self._open(self.folder.add(code))

    def reopen(self, code: str) -> None:
        """Open a closed session again, where it was.

        Raises:
            ConfigurationError: if another one is open, there is none of this code, or it is over.
            RecordError: if nothing can be kept.
        """
        self._leave_if_over()
        if code not in self._others:
            raise ConfigurationError(f'there is no participant {code!r}')
        if _is_over(self._others[code]):
            raise ConfigurationError(f'the session of {code!r} is over')
        self._open(self._others[code].participant)

    def close(self) -> None:
        """Close the session that is open, if one is.

        Raises:
            RecordError: if that can't be kept.
        """
        if self.session is not None:
            self.session.close()
            self._forget(self.session)

    def release(self) -> None:
        """The server ends; the session goes on with the next one.

        Raises:
            RecordError: if it can't be kept that the participant's page is gone.
        """
        session, self.session = self.session, None
        try:
            if session is not None:
                session.leave()
        finally:
            if session is not None:
                session.release()
            self.folder.close()

    def standings(self) -> list[Standing]:
        """How far each participant is, by number."""
        found = dict(self._others)
        if self.session is not None:
            found[self.session.participant.code] = _standing(self.session)
        return sorted(found.values(), key=lambda one: one.participant.number)

    def suggested(self) -> str:
        """A code for the next participant."""
        codes = {one.participant.code for one in self.standings()}
        number = len(codes) + 1
        while f'P{number:02}' in codes:
            number += 1
        return f'P{number:02}'

    def _leave_if_over(self) -> None:
        session = self.session
        if session is None:
            return
        if session.step is not None:
            code = session.participant.code
            raise ConfigurationError(f'the session of {code!r} is open: close it first')
        session.release()
        self._forget(session)

    def _open(self, participant: Participant) -> None:
        log = self.folder.log_of(participant.code)
        steps = steps_of(self.study, participant.code, participant.number)
        try:
            self.session = Session(participant, steps, log, self._clock)
        except BaseException:
            log.close()
            raise

    def _forget(self, session: Session) -> None:
        self._others[session.participant.code] = _standing(session)
        self.session = None


def standing_of(study: Study, kept: Kept) -> Standing:
    """How far a participant of a folder is."""
    participant = kept.participant
    steps = steps_of(study, participant.code, participant.number)
    return Standing(participant, state_of(read_events(kept.folder), steps), len(steps))


def state_of(events: Sequence[Event], steps: Sequence[Step]) -> State:
    """The state after some events."""
    state = State()
    for event in events:
        state = state_after(state, event, steps)
    return state


def _standing(session: Session) -> Standing:
    return Standing(session.participant, session.state, len(session.steps))


def _is_over(standing: Standing) -> bool:
    return standing.state.status is Status.DECLINED or standing.state.step >= standing.steps
