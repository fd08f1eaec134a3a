"""The scribe: writes down what happens in a trial, and says when it is over."""

from __future__ import annotations

from dataclasses import dataclass, replace

from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    PlacementOutcome,
    SubgoalChosen,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class Memory:
    """What has happened so far; ``status`` is building until the trial is over."""

    trial: TrialStarted | None = None
    state: WorldState | None = None
    chosen: SubgoalChosen | None = None
    status: TrialStatus = TrialStatus.BUILDING

    def record(self) -> TrialRecord:
        """The record of the trial; it must have begun."""
        if self.trial is None:
            raise ValueError('there is no record before a trial begins')
        placements = () if self.state is None else self.state.placements
        decisions = () if self.chosen is None else self.chosen.decisions
        proposals = () if self.chosen is None else self.chosen.proposals
        return TrialRecord(self.trial.spec, self.status, placements, decisions, proposals)


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Note states and decisions, and end the trial when there is nothing to wait for."""
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if isinstance(message, TrialStarted):
        same = trial is not None and trial.trial_id == message.trial_id
        return (memory if same else Memory(message)), ()
    over = memory.status is not TrialStatus.BUILDING
    if trial is None or trial.trial_id != message.trial_id or over:
        return memory, ()
    match message:
        case WorldState() if state is None or message.sequence > state.sequence:
            memory = replace(memory, state=message)
        case SubgoalChosen() if chosen is None or message.sequence > chosen.sequence:
            memory = replace(memory, chosen=message)
        case CancelTrial(_, reason):
            return _cancelled(memory, trial.trial_id, reason)
        case PlacementOutcome(_, at, _, reason, failed=True) if state and at == state.sequence:
            return _cancelled(memory, trial.trial_id, reason)
        case _:
            return memory, ()
    memory = replace(memory, status=_status(memory.state, memory.chosen))
    if memory.status is TrialStatus.BUILDING:
        return memory, ()
    return memory, (TrialEnded(trial.trial_id, memory.status),)


def _cancelled(memory: Memory, trial_id: str, reason: str) -> tuple[Memory, tuple[Message, ...]]:
    memory = replace(memory, status=TrialStatus.CANCELLED)
    return memory, (TrialEnded(trial_id, memory.status, reason),)


def _status(state: WorldState | None, chosen: SubgoalChosen | None) -> TrialStatus:
    """How the trial stands, once both sides have said what belongs together.

    State and subgoal arrive in either order. A board that is complete or stuck ends the trial
    when the decision that led there is known too.
    """
    if state is None:
        return TrialStatus.BUILDING
    if chosen is not None and chosen.subgoal is None and chosen.sequence == state.sequence:
        return TrialStatus.GAVE_UP
    led_here = chosen is not None and chosen.sequence < state.sequence <= chosen.end
    return state.status if led_here or state.sequence == 0 else TrialStatus.BUILDING
