"""Records of trials that were cancelled while messages were on their way."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from blocks_planning.trials.execution import spans_of
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


def begun(record: TrialRecord) -> TrialRecord:
    """As much of a record as has both observations and decisions, as if cancelled there."""
    executed: dict[int, int] = {}
    last = 0
    for span in spans_of(record):
        executed[span.decision] = span.subgoal + 1
        last = span.progress.sequence
        if span.progress.is_open:  # what was begun after it is not seen yet
            break
    return cut(record, executed, last, record.reason)


def cut(record: TrialRecord, executed: Mapping[int, int], last: int, reason: str) -> TrialRecord:
    """A record that was cancelled after an observation.

    Args:
        record: the whole.
        executed: number of subgoals that were begun, by the index of the decisions that are kept.
        last: number of the last observation that is kept.
        reason: why it was cancelled.
    """
    decisions = tuple(
        replace(record.decisions[index], executed=count) for index, count in executed.items()
    )
    places = {entry.sequence for entry in decisions}
    return replace(
        record,
        status=TrialStatus.CANCELLED,
        observations=record.observations[: last + 1],
        decisions=decisions,
        proposals=tuple(p for p in record.proposals if p.sequence in places),
        reason=reason,
    )
