"""Were the decisions made in the states in which they were due, and executed as planned?"""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.subgoals.decision import Subgoal
from blocks_planning.trials.execution import History, Progress, history, progress_of
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

_ENDED_FROM_OUTSIDE = (TrialStatus.CANCELLED, TrialStatus.COLLAPSED, TrialStatus.STUCK)
"""Statuses that can end a trial in the middle of a plan without a surprise."""


def wrong_execution(record: TrialRecord) -> Iterator[str]:
    """The first decision that was not due, or not executed as planned."""
    seen = history(record.spec.task.board, record.observations)
    due = 0
    for index, entry in enumerate(record.decisions):
        is_last = index == len(record.decisions) - 1
        sentence, due = _execution(record, entry, seen, due, is_last)
        if sentence:
            yield f'decision {index}: {sentence}'
            return
    if due < len(seen.states) - 1:
        yield f'observation {due + 1} follows from no decision'


def _execution(
    record: TrialRecord, entry: DecisionRecord, seen: History, due: int, is_last: bool
) -> tuple[str, int]:
    """The error of an execution, or '' and the sequence where the next decision is due."""
    decision = entry.decision
    if entry.sequence != due:
        return f'was made at observation {entry.sequence}, but was due at {due}', due
    if due >= len(seen.states) or seen.states[due] != decision.built:
        return f'built is {decision.built:#x}, which is not the state of observation {due}', due
    if decision.chosen is None:
        return ('' if is_last else 'gives up, but another decision follows'), due
    if decision.chosen >= len(decision.candidates):
        return 'chose no candidate', due
    start, built = due, decision.built
    for number, subgoal in enumerate(decision.subgoals):
        is_solved = decision.candidates[decision.chosen].is_solved
        sentence = _wrong_plan(record.spec, built, subgoal, is_solved)
        if sentence:
            return f'subgoal {number}: {sentence}', due
        if number < entry.executed:
            progress = progress_of(record.spec, built, subgoal, start, seen)
            sentence = _wrong_orders(record, built, subgoal, progress, start, seen)
            if sentence:
                return f'subgoal {number}: {sentence}', due
            start = progress.sequence
            if not progress.is_done:
                return _cut_short(record, entry, number, progress), start
        built = subgoal.target
    return _left_out(record, entry), start


def _wrong_plan(spec: TrialSpec, built: Mask, subgoal: Subgoal, is_solved: bool) -> str:
    """Why a plan does not fill its target, or stops before it is stuck; '' if it is correct."""
    task = spec.task
    for placed in subgoal.placements:
        if rules.drop(task.board, built, placed.placement) != placed:
            return f'block {placed} of its plan is not in the place where it comes to rest'
        built |= rules.cells_of(task.board, placed)
    if is_solved:
        return '' if built == subgoal.target else 'its plan does not fill the target'
    if spec.search.is_external:
        return ''
    goes_on = next(rules.legal_placements(task, built, subgoal.target), None) is not None
    return 'its last attempt stops before it is stuck' if goes_on else ''


def _wrong_orders(
    record: TrialRecord, built: Mask, subgoal: Subgoal, span: Progress, start: int, seen: History
) -> str:
    """Why the orders of an execution differ from its plan; '' if they do not."""
    for sequence in range(start + 1, span.sequence + 1):
        ordered = seen.observations[sequence].ordered
        if ordered is None:
            continue
        before = History(seen.observations[:sequence], seen.states[:sequence])
        done = progress_of(record.spec, built, subgoal, start, before).done
        if ordered != subgoal.placements[done].placement:
            return f'observation {sequence} has an order that was not planned'
    return ''


def _cut_short(
    record: TrialRecord,
    entry: DecisionRecord,
    number: int,
    progress: Progress,
) -> str:
    """Why an execution must not end before all placements are done; '' if it may."""
    if number < entry.executed - 1:
        return f'subgoal {number + 1} was begun before subgoal {number} was filled'
    at_end = progress.sequence == len(record.observations) - 1
    if progress.is_surprised or (at_end and record.status in _ENDED_FROM_OUTSIDE):
        return ''
    return f'subgoal {number} was not executed as planned'


def _left_out(record: TrialRecord, entry: DecisionRecord) -> str:
    """Why the remaining subgoals must not be omitted after those begun; '' if they may."""
    left = len(entry.decision.subgoals) - entry.executed
    if left and record.status not in _ENDED_FROM_OUTSIDE:
        return f'{entry.executed} of {len(entry.decision.subgoals)} subgoals were executed'
    return ''
