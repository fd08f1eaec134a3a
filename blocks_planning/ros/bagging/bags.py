"""Reading trials from a bag, without a running graph and without middleware.

The messages of each trial go through the same conversions as on the graph and through the scribe,
so the record of a trial is rebuilt from the bag alone. Messages may be missing between the end of
one file of a bag and the begin of the next: the recorder may have been killed and restarted later.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput, shown
from blocks_planning.ros.bagging import BagError, version1
from blocks_planning.ros.bagging.judging import Outcome, RecordedTrial, cancelled
from blocks_planning.ros.bagging.reading import BagMessage, messages_of
from blocks_planning.ros.bagging.repair import repair
from blocks_planning.ros.runtime.inbox import Inbox
from blocks_planning.ros.wire.conversions.board import state_from_ros
from blocks_planning.ros.wire.conversions.cells import blocks_from_ros
from blocks_planning.ros.wire.conversions.decisions import subgoal_from_ros
from blocks_planning.ros.wire.conversions.trial import ended_from_ros, started_from_ros
from blocks_planning.trials import scribe
from blocks_planning.trials.consistency import Consistency
from blocks_planning.trials.messages import Message, TrialStarted
from blocks_planning.trials.status import TrialStatus

__all__ = ['Outcome', 'RecordedTrial', 'repair', 'trials_of']

_TRIAL, _OUTCOME = 'TrialSpec', 'TrialOutcome'
_FROM_ROS: dict[str, Callable[[Board, Any], Message]] = {
    'WorldState': state_from_ros,
    'Subgoal': subgoal_from_ros,
}
_KINDS = (_TRIAL, _OUTCOME, *_FROM_ROS)
_MOST_OPEN = 8
"""Number of later trials after which no message of a trial is expected (topics are unordered)."""
_VERSION1 = (
    'blocks',
    'subgoals',
    'action_planning_cost',
    'subgoal_planning_cost',
    'solution_cost',
)
"""The fields of a record's summary in an outcome of version 1."""


@dataclass
class _Heard:
    """The messages of a trial in a bag so far."""

    memory: scribe.Memory
    file: int
    outcome: Outcome | None = None
    spans_files: bool = False
    board: Board = field(init=False)
    fits: Consistency = field(init=False)

    def __post_init__(self) -> None:
        assert self.memory.trial is not None
        self.board = self.memory.trial.spec.task.board
        self.fits = Consistency(self.memory.trial.spec)

    def trial(self) -> RecordedTrial:
        assert self.memory.trial is not None
        trial_id = self.memory.trial.trial_id
        record, outcome = self.memory.record(), self.outcome
        if outcome is not None and outcome.status is TrialStatus.CANCELLED:
            record = cancelled(self.memory, outcome)
        return RecordedTrial(trial_id, record, outcome, self.spans_files)

    def take(self, kind: str, message: Any) -> None:
        """Handle a message of this trial, of any version."""
        assert self.memory.trial is not None
        is_old = version1.is_of_version1(kind, message)
        if is_old:
            message = version1.upgraded(kind, message, self.memory.trial.spec)
        if kind == _OUTCOME:
            outcome = _outcome_from_ros(self, message, is_old)
            if self.outcome not in (None, outcome):
                raise BagError('the trial had already ended with another outcome')
            self.outcome = outcome
        else:
            converted = _FROM_ROS[kind](self.board, message)
            self.fits.check(converted)
            self.memory, _ = scribe.step(self.memory, converted)


class _Listener:
    """Handles the messages of a bag one by one, and sorts them by trial."""

    def __init__(self, refuse: Callable[[str], None]) -> None:
        self.trials: dict[str, _Heard] = {}
        self.finished: set[str] = set()
        self.outcomes: set[str] = set()
        self._refuse = refuse
        self._inbox = Inbox()
        self._kinds_in: dict[int, set[str]] = {}

    def hear(self, entry: BagMessage) -> None:
        """Take a message.

        Raises:
            BagError: if it was recorded with a definition that is unknown.
        """
        kind, message, file = entry
        if message is None:
            self._refuse(f'a message on a topic of {kind} was refused: its bytes are invalid')
            return
        trial_id = message.trial_id
        kinds = self._kinds_in.setdefault(file, set())
        is_first = kind not in kinds
        kinds.add(kind)
        may_be_earlier = file and (is_first or _TRIAL not in kinds)
        if kind == _OUTCOME and not may_be_earlier:
            self.outcomes.add(trial_id)
        if trial_id in self.finished:
            return
        heard = self.trials.get(trial_id)
        if heard is not None and file > heard.file:
            heard.spans_files = True
        try:
            if kind == _TRIAL:
                self._announce(message, file)
            elif heard is None:
                self._inbox.hold(trial_id, entry)
            else:
                heard.take(kind, message)
        except InvalidInput as error:
            self._refuse(f'a {kind} of trial {shown(trial_id)} was refused: {error}')
        except AttributeError as error:
            raise BagError(f'was recorded with another definition of {kind}: {error}') from None

    def _announce(self, message: Any, file: int) -> None:
        if version1.is_of_version1(_TRIAL, message):
            message = version1.upgraded(_TRIAL, message, None)
        started: TrialStarted = started_from_ros(None, message)
        trial_id = started.trial_id
        if trial_id not in self.trials:
            self.trials[trial_id] = _Heard(scribe.Memory(started), file)
        elif self.trials[trial_id].memory.trial != started:
            raise BagError('it was already announced with another specification')
        if file and len(self._kinds_in[file]) < len(_KINDS):
            self.trials[trial_id].spans_files = True
        for held in self._inbox.take(trial_id):
            self.hear(held)

    def oldest(self) -> RecordedTrial:
        """Remove the trial that was announced first; no further message of it is expected."""
        trial_id = next(iter(self.trials))
        self.finished.add(trial_id)
        return self.trials.pop(trial_id).trial()


def _ignore(_: str) -> None:
    """Ignore a sentence."""


def trials_of(bag: Path, refuse: Callable[[str], None] | None = None) -> Iterator[RecordedTrial]:
    """The trials of a bag, in the order in which they were announced.

    Args:
        bag: a directory, or a single file of one.
        refuse: called with a sentence for each impossible message; all nodes ignored it, and so
            does the record.

    Raises:
        BagError: if the bag can't be read, or is truncated and has to be repaired first.
    """
    tell = refuse or _ignore
    listener = _Listener(tell)
    for entry in messages_of(bag, _KINDS):
        try:
            listener.hear(entry)
        except BagError as error:
            raise BagError(f'{bag}: {error}') from None
        if len(listener.trials) > _MOST_OPEN:
            yield listener.oldest()
    for trial_id in sorted(listener.outcomes - listener.finished - set(listener.trials)):
        tell(f'trial {shown(trial_id)} ended, but was never announced')
    for heard in listener.trials.values():
        yield heard.trial()


def _outcome_from_ros(heard: _Heard, message: Any, is_old: bool) -> Outcome:
    names = _VERSION1 if is_old else heard.memory.record().summary()
    ended = ended_from_ros(None, message)
    return Outcome(
        status=ended.status,
        reason=ended.reason,
        sequence=int(message.sequence),
        placements=blocks_from_ros(heard.board, message.placements, 'placements'),
        summary={name: getattr(message, name) for name in names},
    )
