"""The scribe: records a trial, and announces its end."""

from __future__ import annotations

from dataclasses import dataclass, replace

from blocks_planning.trials.cutting import begun
from blocks_planning.trials.execution import SubgoalChosen, history
from blocks_planning.trials.messages import (
    CancelTrial,
    DecisionFailed,
    Message,
    PlacementOutcome,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class Memory:
    """The trial so far; ``status`` is building until the trial is over.

    ``reason`` says why the trial was cancelled.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    chosen: SubgoalChosen | None = None
    status: TrialStatus = TrialStatus.BUILDING
    reason: str = ''

    def record(self) -> TrialRecord:
        """The record of the trial; it must have begun."""
        if self.trial is None:
            raise ValueError('there is no record before a trial begins')
        record = TrialRecord(
            spec=self.trial.spec,
            status=self.status,
            observations=() if self.state is None else self.state.observations,
            decisions=() if self.chosen is None else self.chosen.decisions,
            proposals=() if self.chosen is None else self.chosen.proposals,
            reason=self.reason,
        )
        # A state or a decision may have been on its way when the trial was cancelled.
        return begun(record) if self.status is TrialStatus.CANCELLED else record


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Record states and decisions, and end the trial when nothing more is expected."""
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
        case CancelTrial(_, reason) | DecisionFailed(_, reason):
            return _cancelled(memory, trial.trial_id, reason)
        case PlacementOutcome(sequence=at, failed=True) if state and at == state.sequence:
            return _cancelled(memory, trial.trial_id, message.sentence)
        case _:
            return memory, ()
    memory = replace(memory, status=_status(memory))
    return memory, _ended(memory, trial.trial_id)


def _ended(memory: Memory, trial_id: str) -> tuple[TrialEnded, ...]:
    """The message that ends a trial, once it is over."""
    if memory.status is TrialStatus.BUILDING:
        return ()
    return (TrialEnded(trial_id, memory.status, memory.reason, memory.record()),)


def _cancelled(memory: Memory, trial_id: str, reason: str) -> tuple[Memory, tuple[Message, ...]]:
    memory = replace(memory, status=TrialStatus.CANCELLED, reason=reason)
    return memory, _ended(memory, trial_id)


def _status(memory: Memory) -> TrialStatus:
    """The status of the trial, from a state and a decision that belong together.

    State and subgoal arrive in either order. A board that is complete or stuck ends the trial
    when the decision that led there is known too.
    """
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if trial is None or state is None:
        return TrialStatus.BUILDING
    if chosen is not None and chosen.subgoal is None and chosen.sequence == state.sequence:
        return TrialStatus.GAVE_UP
    if state.sequence == 0 or (chosen is not None and _leads_to(chosen, trial, state)):
        return state.status
    return TrialStatus.BUILDING


def _leads_to(chosen: SubgoalChosen, trial: TrialStarted, state: WorldState) -> bool:
    """Whether no other decision is due between a subgoal and a state."""
    if chosen.subgoal is None or chosen.sequence >= state.sequence:
        return False
    seen = history(trial.spec.task.board, state.observations)
    return chosen.progress(trial.spec, seen).sequence == state.sequence
