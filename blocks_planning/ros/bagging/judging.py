"""A trial of a bag, and its contradictions."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from blocks_planning.trials import scribe, verify
from blocks_planning.trials.cutting import begun, cut
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Blocks


@dataclass(frozen=True)
class Outcome:
    """What was published at the end of a trial.

    Attributes:
        status: how it ended.
        reason: why it could not continue; '' if it ended regularly or a user cancelled it.
        sequence: of the latest observation; -1 if the board was never observed.
        placements: the blocks that stand.
        summary: counts, costs and measures by name, as far as the version of the message has them.
    """

    status: TrialStatus
    reason: str
    sequence: int
    placements: Blocks
    summary: Mapping[str, float]

    @property
    def subgoals(self) -> int:
        """Number of subgoals that were begun."""
        return int(self.summary['subgoals'])


@dataclass(frozen=True)
class RecordedTrial:
    """A trial of a bag.

    Attributes:
        trial_id: id of this run of the trial.
        record: built from its states and subgoals. Its status is building if they do not lead to an
            end.
        outcome: what was published at its end; None if that is not in the bag.
        spans_files: whether it was running when one file ended and the next began, or before the
            recorder of the next file had found all publishers.
    """

    trial_id: str
    record: TrialRecord
    outcome: Outcome | None
    spans_files: bool = False

    @property
    def is_over(self) -> bool:
        """Whether the bag contains its end."""
        has_outcome = self.outcome is not None and not self._has_gap
        return has_outcome or self.record.status is not TrialStatus.BUILDING

    @property
    def _has_gap(self) -> bool:
        """Whether messages that led to the outcome are missing, for a known reason."""
        if self.outcome is None or not self.spans_files:
            return False
        lacks_states = len(self.record.observations) <= self.outcome.sequence
        lacks_subgoals = self.record.subgoals < self.outcome.subgoals
        return lacks_states or lacks_subgoals or self.record.status is TrialStatus.BUILDING

    def contradictions(self) -> Iterator[str]:
        """All contradictions of the trial, a sentence each."""
        record, outcome = self.record, self.outcome
        if outcome is not None and self._has_gap:
            found = record.placements
            if record.spec.world.obeys and outcome.placements[: len(found)] != found:
                yield 'the placements of the outcome differ from those of the earlier messages'
            yield from verify.contradictions(begun(record))
            return
        if outcome is not None and record.status is TrialStatus.BUILDING:
            status = outcome.status.value
            yield f'the outcome has status {status!r}, but the bag lacks the messages that lead to it'
            return
        if outcome is not None:
            yield from _differences(record, outcome)
        yield from verify.contradictions(record if self.is_over else begun(record))


def _differences(record: TrialRecord, outcome: Outcome) -> Iterator[str]:
    found = {'status': record.status.value, **record.summary(), 'placements': record.placements}
    published = {
        'status': outcome.status.value,
        **outcome.summary,
        'placements': outcome.placements,
    }
    for name, value in published.items():
        if value != found[name]:
            yield f'the outcome has {name} {_show(value)}, the messages give {_show(found[name])}'


def _show(value: object) -> str:
    if isinstance(value, tuple):
        return f'of {len(value)} blocks'
    return repr(value) if isinstance(value, str) else str(value)


def cancelled(memory: scribe.Memory, outcome: Outcome) -> TrialRecord:
    """The record at the time of cancelling: other nodes may have continued for a moment."""
    record = memory.record()
    executed: dict[int, int] = {}
    left = outcome.subgoals
    for index, entry in enumerate(record.decisions):
        count = min(entry.executed, left)
        left -= count
        if count or not entry.decision.subgoals:
            executed[index] = count
    return cut(record, executed, outcome.sequence, outcome.reason)
