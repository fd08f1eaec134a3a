"""The world: the only part that may change the board."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, format_library
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class Memory:
    """What the world knows: the task and the state of its board, while a trial runs."""

    task: Task | None = None
    state: WorldState | None = None


def status_of(task: Task, built: Mask) -> TrialStatus:
    """How a board stands: success, stuck or building."""
    if built == task.silhouette:
        return TrialStatus.SUCCESS
    if next(rules.legal_placements(task, built, task.silhouette), None) is None:
        return TrialStatus.STUCK
    return TrialStatus.BUILDING


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Clear the board for a new trial; drop a block that refers to the current state."""
    task, state = memory.task, memory.state
    if isinstance(message, TrialStarted):
        if state is not None and state.trial_id == message.trial_id:
            return memory, ()
        cleared = WorldState(message.trial_id, 0, 0, (), status_of(message.spec.task, 0))
        return Memory(message.spec.task, cleared), (cleared,)
    if task is None or state is None or state.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case PlaceBlock() if message.sequence == state.sequence:
            return _drop(memory, task, state, message)
    return memory, ()


def restored(memory: Memory, placements: Iterable[Placed]) -> Memory | None:
    """The world after placements that were carried out before; None if they can't have been."""
    assert memory.state is not None
    for sequence, placed in enumerate(placements):
        action = PlaceBlock(memory.state.trial_id, sequence, placed.placement)
        memory, _ = step(memory, action)
        assert memory.state is not None
        if memory.state.placements[sequence:] != (placed,):
            return None
    return memory


def _drop(
    memory: Memory, task: Task, state: WorldState, action: PlaceBlock
) -> tuple[Memory, tuple[Message, ...]]:
    block, column = action.placement
    known = block in task.library
    placed = rules.drop(task.board, state.built, action.placement) if known else None
    if placed is None:
        reason = (
            f'block {block} in column {column} does not come to rest inside the board'
            if known
            else f'block {block} is not in the library {format_library(task.library)}'
        )
        return memory, (PlacementOutcome(state.trial_id, state.sequence, None, reason),)
    built = state.built | rules.cells_of(task.board, placed)
    after = WorldState(
        trial_id=state.trial_id,
        sequence=state.sequence + 1,
        built=built,
        placements=(*state.placements, placed),
        status=status_of(task, built),
    )
    outcome = PlacementOutcome(state.trial_id, state.sequence, placed)
    return replace(memory, state=after), (outcome, after)
