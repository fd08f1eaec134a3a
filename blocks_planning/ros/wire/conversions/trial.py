"""Trials: specifications and outcomes."""

from __future__ import annotations

from copy import deepcopy
from typing import Any

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput
from blocks_planning.ros.wire.conversions.cells import (
    block_from_ros,
    block_to_ros,
    blocks_from_ros,
    blocks_to_ros,
    grid_from_ros,
    grid_to_ros,
)
from blocks_planning.ros.wire.conversions.fields import MessageError, bounded, refuse, word
from blocks_planning.ros.wire.conversions.settings import members_from_ros, planner_to_ros
from blocks_planning.trials.messages import TrialEnded, TrialStarted
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

MAX_TRIAL_ID = 200
MAX_STIMULUS = 4096
"""Length limit of a path [characters]."""
MOST_BLOCKS = 256
"""Limit of the number of blocks in a library."""
MOST_REASON = 300
"""Length limit of the reason of an outcome [characters]; it may come from another node."""


def spec_to_ros(trial_id: str, spec: TrialSpec) -> ros.TrialSpec:
    """A trial, for an announcement or a goal. A client may change the message before sending."""
    return ros.TrialSpec(
        trial_id=trial_id,
        stimulus=spec.stimulus,
        silhouette=deepcopy(grid_to_ros(spec.task.board, spec.task.silhouette)),
        library=deepcopy([block_to_ros(block) for block in spec.task.library]),
        built=deepcopy(blocks_to_ros(spec.built)),
        planner=planner_to_ros(spec),
        seed=spec.seed,
    )


def spec_from_ros(message: ros.TrialSpec) -> TrialSpec:
    """The trial of an announcement or a goal."""
    board, silhouette = grid_from_ros(message.silhouette, 'silhouette')
    bounded(message.library, 'library', 1, MOST_BLOCKS)
    library = tuple(
        block_from_ros(block, f'library[{index}]') for index, block in enumerate(message.library)
    )
    if len(message.stimulus) > MAX_STIMULUS:
        raise refuse('stimulus', message.stimulus, f'a name of up to {MAX_STIMULUS} characters')
    built = blocks_from_ros(board, message.built, 'built')
    members: dict[str, Any] = members_from_ros(message.planner)
    try:
        return TrialSpec(
            stimulus=message.stimulus,
            task=Task(board, silhouette, library),
            seed=message.seed,
            budget=message.planner.budget,
            built=built,
            **members,
        )
    except InvalidInput as error:
        raise MessageError(f'trial: {error}') from None


def started_to_ros(board: Board | None, message: TrialStarted) -> ros.TrialSpec:
    """See :class:`TrialStarted`; the board is that of its specification."""
    return spec_to_ros(message.trial_id, message.spec)


def started_from_ros(board: Board | None, message: ros.TrialSpec) -> TrialStarted:
    """See :class:`TrialStarted`."""
    if not 1 <= len(message.trial_id) <= MAX_TRIAL_ID or not message.trial_id.isprintable():
        raise refuse('trial_id', message.trial_id, f'a name of up to {MAX_TRIAL_ID} characters')
    return TrialStarted(message.trial_id, spec_from_ros(message))


_OUTCOME_REASONS = {
    'success': 'the filled cells are the silhouette',
    'stuck': 'no legal placement is left',
    'gave_up': 'no subgoal could be solved',
    'cancelled': 'the trial was cancelled',
    'collapsed': 'the tower fell',
}
_OUTCOME_STATUSES = [s.value for s in TrialStatus if s is not TrialStatus.BUILDING]


def code_of(status: TrialStatus, reason: str) -> int:
    """The numeric code of an end; a trial that was cancelled with a reason has failed."""
    if status is TrialStatus.CANCELLED and reason:
        return int(ros.TrialOutcome.CODE_FAILED)
    return int(getattr(ros.TrialOutcome, f'CODE_{status.name}'))


def ended_to_ros(board: Board | None, message: TrialEnded) -> ros.TrialOutcome:
    """See :class:`TrialEnded`; counts, costs and measures are those of its record."""
    record = message.record
    usual = _OUTCOME_REASONS.get(message.status.value, message.status.value)
    outcome = ros.TrialOutcome(
        trial_id=message.trial_id,
        status=message.status.value,
        code=code_of(message.status, message.reason),
        reason=message.reason[:MOST_REASON] or usual,
        sequence=-1,
    )
    if record is not None:
        outcome.sequence = len(record.observations) - 1
        outcome.placements = blocks_to_ros(record.placements)
        for name, value in record.summary().items():
            setattr(outcome, name, value)
    return outcome


def ended_from_ros(board: Board | None, message: ros.TrialOutcome) -> TrialEnded:
    """See :class:`TrialEnded`; only the node that wrote the record has it."""
    status = word(TrialStatus, message.status, 'status', _OUTCOME_STATUSES)
    has_failed = message.code == ros.TrialOutcome.CODE_FAILED
    reason = message.reason[:MOST_REASON] if has_failed else ''
    if message.code != code_of(status, reason):
        raise refuse('code', message.code, f'{code_of(status, reason)} for status {status.value}')
    return TrialEnded(message.trial_id, status, reason)


def refusal(reason: str) -> ros.TrialOutcome:
    """The outcome of a goal that could not start."""
    kind = ros.TrialOutcome
    return kind(
        status=kind.STATUS_REFUSED,
        code=kind.CODE_REFUSED,
        reason=reason[:MOST_REASON],
        sequence=-1,
    )
