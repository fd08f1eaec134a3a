"""The selector: which region comes next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Decision, Query
from blocks_planning.trials.messages import (
    Message,
    Remind,
    SearchAnswer,
    SearchRequest,
    SubgoalChosen,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class Memory:
    """What the selector knows of the trial that runs.

    Attributes:
        trial: the trial.
        state: the latest.
        known: answered queries.
        asked: queries that were sent, answered or not.
        chosen: the subgoal that is being executed.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    known: Mapping[Query, SolveResult] = field(default_factory=dict)
    asked: tuple[Query, ...] = ()
    chosen: SubgoalChosen | None = None


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Decide in every state that no subgoal leads on from; ask for what that takes."""
    trial, state = memory.trial, memory.state
    if isinstance(message, TrialStarted):
        same = trial is not None and trial.trial_id == message.trial_id
        return (memory if same else Memory(message)), ()
    if trial is None or trial.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case WorldState() if state is None or message.sequence > state.sequence:
            return _go_on(replace(memory, state=message), trial.spec, message)
        case SearchAnswer(_, query, result) if state is not None and query in memory.asked:
            known = {**memory.known, query: result}
            return _go_on(replace(memory, known=known), trial.spec, state)
        case Remind():
            unanswered = [query for query in memory.asked if query not in memory.known]
            return memory, tuple(SearchRequest(trial.trial_id, query) for query in unanswered)
    return memory, ()


def _go_on(
    memory: Memory, spec: TrialSpec, state: WorldState
) -> tuple[Memory, tuple[Message, ...]]:
    """Take decision after decision up to the latest state, beginning with the last one taken.

    That is one decision at most, unless this selector knows nothing because it has just been
    started in the middle of a trial. Then it decides as it has decided before.
    """
    states = rules.states_along(spec.task.board, 0, state.placements)
    chosen = memory.chosen
    while True:
        at = _next_decision(spec, chosen, states)
        if at is None or (at == state.sequence and state.status is not TrialStatus.BUILDING):
            break
        if chosen is not None and _has_next(chosen, states[at]):
            chosen = _chosen(state, at, chosen.decisions, executed=chosen.index + 2)
            continue
        answer = spec.strategy.decide(spec.task, states[at], spec.seed, memory.known)
        if not isinstance(answer, Decision):
            return _ask(replace(memory, chosen=chosen), state, answer)
        earlier = () if chosen is None else chosen.decisions
        entry = DecisionRecord(at, answer, 0)
        chosen = _chosen(state, at, (*earlier, entry), executed=min(1, len(answer.subgoals)))
    said = (chosen,) if chosen is not None and chosen != memory.chosen else ()
    return replace(memory, chosen=chosen), said


def _next_decision(spec: TrialSpec, chosen: SubgoalChosen | None, states: list[int]) -> int | None:
    """In which state to decide next: where the subgoal ends, or the way is lost; None: not yet."""
    if chosen is None:
        return 0
    if chosen.subgoal is None:
        return None
    expected = chosen.way(spec.task.board)
    for step_number, built in enumerate(states[chosen.sequence : chosen.end + 1]):
        if built != expected[step_number]:
            return chosen.sequence + step_number
    return chosen.end if chosen.end < len(states) else None


def _has_next(chosen: SubgoalChosen, built: Mask) -> bool:
    """Whether a subgoal is filled and its decision has another one."""
    filled = chosen.subgoal is not None and chosen.subgoal.region == built
    return filled and chosen.index + 1 < len(chosen.decision.subgoals)


def _chosen(
    state: WorldState, at: int, decisions: tuple[DecisionRecord, ...], executed: int
) -> SubgoalChosen:
    last = replace(decisions[-1], executed=executed)
    return SubgoalChosen(state.trial_id, at, (*decisions[:-1], last))


def _ask(
    memory: Memory, state: WorldState, queries: list[Query]
) -> tuple[Memory, tuple[Message, ...]]:
    new = tuple(query for query in queries if query not in memory.asked)
    requests = tuple(SearchRequest(state.trial_id, query) for query in new)
    return replace(memory, asked=memory.asked + new), requests
