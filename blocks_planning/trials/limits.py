"""Trials that ended because a search reached its memory limit."""

from __future__ import annotations

from blocks_planning.search.result import SolveStatus
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


def ended_at_a_limit(record: TrialRecord) -> bool:
    """Whether the planner gave up because a search exceeded its memory limit."""
    if record.status is not TrialStatus.GAVE_UP:
        return False
    candidates = record.decisions[-1].decision.candidates
    return any(candidate.status is SolveStatus.LIMIT_EXCEEDED for candidate in candidates)
