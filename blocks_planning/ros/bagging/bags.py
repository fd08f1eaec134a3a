"""Reading trials back from a bag, with no graph running and no middleware.

The messages of each trial go through the same conversions as on the graph and through the scribe,
so that the record of a trial is made from the bag alone. Where one file of a bag ends and the next
begins messages may be missing: the recorder may have been killed, and started again later.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, fields, replace
from operator import lt
from pathlib import Path
from typing import Any

from rosbags.highlevel import AnyReader

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput, shown
from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.repair import file_begins, is_finished, repair
from blocks_planning.ros.runtime.inbox import Inbox
from blocks_planning.ros.wire.conversions.board import state_from_ros
from blocks_planning.ros.wire.conversions.cells import placed_from_ros
from blocks_planning.ros.wire.conversions.decisions import subgoal_from_ros
from blocks_planning.ros.wire.conversions.trial import ended_from_ros, started_from_ros
from blocks_planning.trials import scribe, verify
from blocks_planning.trials.consistency import Consistency
from blocks_planning.trials.messages import Message, TrialStarted
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.status import TrialStatus

__all__ = ['Outcome', 'RecordedTrial', 'repair', 'trials_of']

_PACKAGE = 'blocks_planning_msgs/msg/'
_TRIAL, _OUTCOME = 'TrialSpec', 'TrialOutcome'
_FROM_ROS: dict[str, Callable[[Board, Any], Message]] = {
    'WorldState': state_from_ros,
    'Subgoal': subgoal_from_ros,
}
_KINDS = (_TRIAL, _OUTCOME, *_FROM_ROS)
MOST_LETTERS = 200
"""Of what a library has to say about a damaged file."""
_MOST_OPEN = 8
"""So many trials later, nothing more is said of a trial. (Topics are not ordered.)"""


@dataclass(frozen=True)
class Outcome:
    """What was said at the end of a trial; the fields are those of :class:`TrialRecord`."""

    status: TrialStatus
    blocks: int
    subgoals: int
    action_planning_cost: int
    subgoal_planning_cost: int
    solution_cost: int
    placements: tuple[Placed, ...]


@dataclass(frozen=True)
class RecordedTrial:
    """A trial of a bag.

    Attributes:
        trial_id: of this run of it.
        record: made from its states and subgoals. Its status is building if they do not lead to
            an end.
        outcome: what was said at its end; None if that is not in the bag.
        spans_files: whether it was under way where one file ends and the next begins, or before
            the recorder of the next one had found all who speak.
    """

    trial_id: str
    record: TrialRecord
    outcome: Outcome | None
    spans_files: bool = False

    @property
    def is_over(self) -> bool:
        """Whether the bag has its end."""
        has_outcome = self.outcome is not None and not self._has_gap
        return has_outcome or self.record.status is not TrialStatus.BUILDING

    @property
    def _has_gap(self) -> bool:
        """Whether messages are missing that led to the outcome, and may be."""
        if self.outcome is None or not self.spans_files:
            return False
        found = (self.record.blocks, self.record.subgoals)
        fewer = any(map(lt, found, (self.outcome.blocks, self.outcome.subgoals)))
        return fewer or self.record.status is TrialStatus.BUILDING

    def contradictions(self) -> Iterator[str]:
        """Everything that does not follow from the rest, a sentence each."""
        if self.outcome is not None and self._has_gap:
            found, said = self.record.placements, self.outcome.placements
            if said[: len(found)] != found:
                yield 'the outcome says other placements than the messages that led there'
            yield from verify.contradictions(_begun(self.record))
            return
        if self.outcome is not None and self.record.status is TrialStatus.BUILDING:
            status = self.outcome.status.value
            yield f'the outcome says {status!r}, but messages that lead there are not in the bag'
            return
        if self.outcome is not None:
            for name in (entry.name for entry in fields(Outcome)):
                said, found = getattr(self.outcome, name), getattr(self.record, name)
                if said != found:
                    yield f'the outcome says {name} {_show(said)}, the messages {_show(found)}'
        yield from verify.contradictions(self.record if self.is_over else _begun(self.record))


def _show(value: object) -> str:
    if isinstance(value, TrialStatus):
        return repr(value.value)
    return f'of {len(value)} blocks' if isinstance(value, tuple) else str(value)


@dataclass
class _Heard:
    """What was said of a trial so far."""

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
            record = _cancelled(self.memory, outcome)
        return RecordedTrial(trial_id, record, outcome, self.spans_files)


def _begun(record: TrialRecord) -> TrialRecord:
    """As much of a record as both placements and decisions are there of, as if cancelled there."""
    decisions: list[DecisionRecord] = []
    led = 0
    for entry in record.decisions:
        left, executed = record.blocks - entry.placed, 0
        if left < 0 or not entry.decision.subgoals:
            break
        for subgoal in entry.decision.subgoals[: entry.executed]:
            executed += 1
            left -= subgoal.execute
            if left <= 0:
                break
        decisions.append(replace(entry, executed=executed))
        led = record.blocks - max(left, 0)
    return replace(
        record,
        status=TrialStatus.CANCELLED,
        placements=record.placements[:led],
        decisions=tuple(decisions),
    )


def _cancelled(memory: scribe.Memory, outcome: Outcome) -> TrialRecord:
    """The record as it was when the trial was cancelled: others may have gone on a little."""
    record = memory.record()
    decisions: list[DecisionRecord] = []
    left = outcome.subgoals
    for entry in record.decisions:
        executed = min(entry.executed, left)
        left -= executed
        if executed or not entry.decision.subgoals:
            decisions.append(replace(entry, executed=executed))
    places = {entry.placed for entry in decisions}
    return replace(
        record,
        status=TrialStatus.CANCELLED,
        placements=record.placements[: outcome.blocks],
        decisions=tuple(decisions),
        proposals=tuple(p for p in record.proposals if p.sequence in places),
    )


def trials_of(bag: Path, refuse: Callable[[str], None] | None = None) -> Iterator[RecordedTrial]:
    """The trials of a bag, in the order in which they were announced.

    Args:
        bag: a directory, or a single file of one.
        refuse: is told, in a sentence each, of messages that can't be; every node ignored them,
            and so does the record.

    Raises:
        BagError: if the bag can't be read, or was cut off and has to be repaired first.
    """
    trials: dict[str, _Heard] = {}
    finished: set[str] = set()
    inbox = Inbox()
    outcomes: set[str] = set()

    said: dict[int, set[str]] = {}

    def hear(kind: str, message: Any, file: int) -> None:
        trial_id = message.trial_id
        is_first = kind not in said.setdefault(file, set())
        said[file].add(kind)
        may_be_earlier = file and (is_first or _TRIAL not in said[file])
        if kind == _OUTCOME and not may_be_earlier:
            outcomes.add(trial_id)
        if trial_id in finished:
            return
        heard = trials.get(trial_id)
        if heard is not None and file > heard.file:
            heard.spans_files = True
        try:
            if kind == _TRIAL:
                _announce(trials, started_from_ros(message), file)
                if file and len(said[file]) < len(_KINDS):
                    trials[trial_id].spans_files = True
                for held in inbox.take(trial_id):
                    hear(*held)
            elif heard is None:
                inbox.hold(trial_id, (kind, message, file))
            elif kind == _OUTCOME:
                outcome = _outcome_from_ros(heard.board, message)
                if heard.outcome not in (None, outcome):
                    raise BagError('the trial ended already, in another way')
                heard.outcome = outcome
            else:
                converted = _FROM_ROS[kind](heard.board, message)
                heard.fits.check(converted)
                heard.memory, _ = scribe.step(heard.memory, converted)
        except InvalidInput as error:
            if refuse is not None:
                refuse(f'a {kind} of trial {shown(trial_id)} was refused: {error}')
        except AttributeError as error:
            raise BagError(f'{bag}: was recorded with another kind of {kind}: {error}') from None

    for kind, message, file in _messages_of(bag):
        if message is not None:
            hear(kind, message, file)
        elif refuse is not None:
            refuse(f'what was said as a {kind} was refused: its bytes are none')
        if len(trials) > _MOST_OPEN:
            oldest = next(iter(trials))
            finished.add(oldest)
            yield trials.pop(oldest).trial()
    for trial_id in sorted(outcomes - finished - set(trials)):
        if refuse is not None:
            refuse(f'trial {shown(trial_id)} ended, but was never announced')
    for heard in trials.values():
        yield heard.trial()


def _announce(trials: dict[str, _Heard], started: TrialStarted, file: int) -> None:
    if started.trial_id not in trials:
        trials[started.trial_id] = _Heard(scribe.Memory(started), file)
    elif trials[started.trial_id].memory.trial != started:
        raise BagError('it was announced already, as another one')


def _outcome_from_ros(board: Board, message: Any) -> Outcome:
    placements = tuple(
        placed_from_ros(board, placed, f'placements[{index}]')
        for index, placed in enumerate(message.placements)
    )
    status = ended_from_ros(message).status
    counts = {entry.name: getattr(message, entry.name) for entry in fields(Outcome)}
    return Outcome(**{**counts, 'status': status, 'placements': placements})


def _messages_of(bag: Path) -> Iterator[tuple[str, Any, int]]:
    """The messages that trials are made of, in the order in which they came.

    Yields:
        (kind, message, number of the file that it stands in); None stands for a message whose
        bytes say nothing: a bag has everything as it was sent.
    """
    if not bag.exists():
        raise BagError(f'{bag}: does not exist')
    try:
        finished = is_finished(bag)
        if not finished and bag.is_dir() and not any(bag.glob('*.mcap')):
            raise BagError(f'{bag}: holds no bag that can be read')
    except OSError as error:
        raise BagError(f'{bag}: cannot be read: {error.strerror}') from None
    if not finished:
        raise BagError(f'{bag}: was cut off; `blocks-planning verify {bag}` repairs it')
    source = _read(bag)
    while True:
        try:
            entry = next(source, None)
        except Exception as error:  # noqa: BLE001  whatever a damaged file leads to
            reason = ' '.join(str(error).split()) or type(error).__name__
            raise BagError(f'{bag}: cannot be read: {reason[:MOST_LETTERS]}') from None
        if entry is None:
            return
        yield entry


def _read(bag: Path) -> Iterator[tuple[str, Any, int]]:
    begins = file_begins(bag)
    times_ns = [begin.time_ns for begin in begins]
    with AnyReader([bag]) as reader:
        wanted = {
            connection.msgtype: connection.msgtype.removeprefix(_PACKAGE)
            for connection in reader.connections
        }
        connections = [c for c in reader.connections if wanted[c.msgtype] in _KINDS]
        if not connections:
            return
        for connection, received_ns, data in reader.messages(connections):
            try:
                message = reader.deserialize(data, connection.msgtype)
            except Exception:  # noqa: BLE001  whatever bytes lead to
                message = None
            place = bisect_right(times_ns, received_ns) - 1
            file = begins[place].number if place >= 0 else 0
            yield wanted[connection.msgtype], message, file
