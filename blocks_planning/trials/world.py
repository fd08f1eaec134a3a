"""The world: the only part that may change the board."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.trials.messages import (
    ArmOrder,
    ArmReport,
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import MAX_OBSERVATIONS, Blocks, Observation, Observations
from blocks_planning.worlds.world import ImpossibleOrder, drop_ordered

TOO_MANY = f'the trial would need more than {MAX_OBSERVATIONS} observations'


@dataclass(frozen=True)
class Memory:
    """What the world knows: the running trial and the state of its board."""

    spec: TrialSpec | None = None
    state: WorldState | None = None


def status_of(spec: TrialSpec, blocks: Blocks, built: Mask) -> TrialStatus:
    """The status of a board: success, stuck, collapsed or building.

    Args:
        spec: silhouette, library and world.
        blocks: that stand.
        built: the cells that they fill.
    """
    if not spec.world.holds(blocks):
        return TrialStatus.COLLAPSED
    return _status_of_cells(spec.task, built)


@lru_cache(maxsize=4096)
def _status_of_cells(task: Task, built: Mask) -> TrialStatus:
    if built == task.silhouette:
        return TrialStatus.SUCCESS
    if next(rules.legal_placements(task, built, task.silhouette), None) is None:
        return TrialStatus.STUCK
    return TrialStatus.BUILDING


def state_after(trial_id: str, spec: TrialSpec, observations: Observations) -> WorldState:
    """The state of a trial's board after some observations."""
    state = observed(trial_id, spec.task.board, observations, TrialStatus.BUILDING)
    return replace(state, status=status_of(spec, state.placements, state.built))


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Set up the board for a new trial; carry out an order that refers to the current state.

    In an observed world an arm carries it out, and reports the state of the board afterwards.
    """
    spec, state = memory.spec, memory.state
    if isinstance(message, TrialStarted):
        if state is not None and state.trial_id == message.trial_id:
            return memory, ()
        found = (Observation(landed=message.spec.built),)
        cleared = state_after(message.trial_id, message.spec, found)
        return Memory(message.spec, cleared), (cleared,)
    if spec is None or state is None or state.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case PlaceBlock() if message.sequence == state.sequence:
            return _carry_out(memory, spec, state, message)
        case ArmReport() if message.sequence == state.sequence:
            return _note_report(memory, spec, state, message)
    return memory, ()


def restored(memory: Memory, observations: Observations) -> Memory | None:
    """The world after the observations of a journal; None if they are impossible."""
    spec, state = memory.spec, memory.state
    assert spec is not None
    assert state is not None
    kept = state.observations[0]
    if not observations:
        return memory
    if observations[0] != kept:
        return None
    blocks, built = state.placements, state.built
    for sequence, seen in enumerate(observations[1:], start=1):
        if spec.world.complaint(spec.task, blocks, built, seen, spec.seed, sequence):
            return None
        after = state_after(state.trial_id, spec, observations[: sequence + 1])
        blocks, built = after.placements, after.built
    return replace(memory, state=state_after(state.trial_id, spec, observations))


def _carry_out(
    memory: Memory, spec: TrialSpec, state: WorldState, action: PlaceBlock
) -> tuple[Memory, tuple[Message, ...]]:
    sequence = state.sequence + 1
    if sequence >= MAX_OBSERVATIONS:
        failed = PlacementOutcome(
            state.trial_id, state.sequence, None, TOO_MANY, PlacementCode.FAILED
        )
        return memory, (failed,)
    try:
        if not spec.world.simulates:
            placed = drop_ordered(spec.task, state.built, action.placement)
            return memory, (ArmOrder(state.trial_id, state.sequence, placed),)
        seen = spec.world.carry_out(spec.task, state.built, action.placement, spec.seed, sequence)
    except ImpossibleOrder as error:
        refused = PlacementCode.IMPOSSIBLE
        return memory, (
            PlacementOutcome(state.trial_id, state.sequence, None, str(error), refused),
        )
    after = state_after(state.trial_id, spec, (*state.observations, seen))
    return _observed(memory, seen, after)


_OBSERVED = (
    *(PlacementCode.PLACED, PlacementCode.SLIPPED),
    *(PlacementCode.LOST, PlacementCode.COLLAPSED),
)
"""Codes after which there is another board to look at."""


def _note_report(
    memory: Memory, spec: TrialSpec, state: WorldState, report: ArmReport
) -> tuple[Memory, tuple[Message, ...]]:
    """Observe what an arm says that it has done, or pass on why it has done nothing."""
    outcome = PlacementOutcome(
        state.trial_id, state.sequence, None, report.reason, report.code, report.progress
    )
    if report.code not in _OBSERVED:
        return memory, (outcome,)
    seen = Observation(report.ordered, report.landed, report.gone)
    wrong = spec.world.complaint(
        spec.task, state.placements, state.built, seen, spec.seed, state.sequence + 1
    )
    if wrong:
        reason = f'the arm reports what cannot be: {wrong}'
        return memory, (replace(outcome, reason=reason, code=PlacementCode.FAILED),)
    after = state_after(state.trial_id, spec, (*state.observations, seen))
    if report.code is PlacementCode.COLLAPSED:
        after = replace(after, status=TrialStatus.COLLAPSED)
    return _observed(memory, seen, after, report.reason)


def _observed(
    memory: Memory, seen: Observation, after: WorldState, reason: str = ''
) -> tuple[Memory, tuple[Message, ...]]:
    """Go on with another state."""
    landed = seen.landed[0] if seen.landed else None
    code = _code_of(seen, after.status)
    outcome = PlacementOutcome(after.trial_id, after.sequence - 1, landed, reason, code)
    return replace(memory, state=after), (outcome, after)


def _code_of(seen: Observation, status: TrialStatus) -> PlacementCode:
    """The outcome of the order that led to an observation."""
    if status is TrialStatus.COLLAPSED:
        return PlacementCode.COLLAPSED
    if seen.is_as_ordered:
        return PlacementCode.PLACED
    return PlacementCode.SLIPPED if seen.landed else PlacementCode.LOST
