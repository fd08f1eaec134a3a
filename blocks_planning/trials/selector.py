"""The selector: which region comes next."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Decision, Query
from blocks_planning.subgoals.human import Human, used
from blocks_planning.subgoals.proposals import (
    Proposal,
    ProposalKind,
    proposed_at,
    target_of,
)
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
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
        proposals: of a person, in the order of their numbers in every state.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    known: Mapping[Query, SolveResult] = field(default_factory=dict)
    asked: tuple[Query, ...] = ()
    chosen: SubgoalChosen | None = None
    proposals: tuple[Proposal, ...] = ()


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
        case ProposalMade(_, proposal) if _is_next(memory, trial.spec, proposal):
            memory = replace(memory, proposals=(*memory.proposals, proposal))
            return (memory, ()) if state is None else _consider(memory, trial, state, proposal)
        case Remind():
            unanswered = [query for query in memory.asked if query not in memory.known]
            return memory, tuple(SearchRequest(trial.trial_id, query) for query in unanswered)
    return memory, ()


def reason_against(memory: Memory, proposal: Proposal) -> str:
    """Why a person's proposal is not taken; '' if it is, or was, or waits for its state."""
    if memory.trial is None or memory.state is None:
        return ''
    spec, state = memory.trial.spec, memory.state
    if not isinstance(spec.strategy, Human):
        return f'the strategy is {spec.strategy.name}, which asks no person'
    taken = len(proposed_at(memory.proposals, proposal.sequence))
    if proposal.number > taken:
        return f'number: expected {taken}, got {proposal.number}'
    is_new = proposal.number == taken and proposal.sequence == state.sequence
    target = target_of(spec.task, state.built, proposal.region)
    if is_new and proposal.kind is ProposalKind.BUILD and target == state.built:
        return 'region: expected a target cell that is still empty'
    return ''


def _is_next(memory: Memory, spec: TrialSpec, proposal: Proposal) -> bool:
    """Whether a person is asked at all, and the proposals before this one were all taken."""
    earlier = proposed_at(memory.proposals, proposal.sequence)
    return isinstance(spec.strategy, Human) and proposal.number == len(earlier)


def _consider(
    memory: Memory, trial: TrialStarted, state: WorldState, proposal: Proposal
) -> tuple[Memory, tuple[Message, ...]]:
    """Take a person's word; what is known already to be unsolvable is answered once more."""
    memory, said = _go_on(memory, trial.spec, state)
    target = target_of(trial.spec.task, state.built, proposal.region)
    query = Query(state.built, target)
    is_known = proposal.kind is ProposalKind.BUILD and query in memory.known
    if not said and is_known and proposal.sequence == state.sequence:
        said = (SearchRequest(trial.trial_id, query),)
    return memory, said


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
            chosen = _chosen(chosen, at, executed=chosen.index + 2)
            continue
        proposals = proposed_at(memory.proposals, at)
        answer = spec.strategy.decide(spec.task, states[at], spec.seed, memory.known, proposals)
        if not isinstance(answer, Decision):
            return _ask(replace(memory, chosen=chosen), state, answer)
        chosen = _decided(
            spec.task, state.trial_id, chosen, DecisionRecord(at, answer, 0), proposals
        )
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


def _chosen(chosen: SubgoalChosen, at: int, executed: int) -> SubgoalChosen:
    """The same decisions, when so many subgoals of the last one have been begun."""
    last = replace(chosen.decisions[-1], executed=executed)
    return replace(chosen, sequence=at, decisions=(*chosen.decisions[:-1], last))


def _decided(
    task: Task,
    trial_id: str,
    before: SubgoalChosen | None,
    entry: DecisionRecord,
    proposals: tuple[Proposal, ...],
) -> SubgoalChosen:
    """What has been chosen after another decision."""
    if before is None:
        before = SubgoalChosen(trial_id, entry.placed, ())
    led_here = used(task, entry.decision, proposals) if proposals else ()
    chosen = replace(
        before,
        decisions=(*before.decisions, entry),
        proposals=(*before.proposals, *led_here),
    )
    return _chosen(chosen, entry.placed, executed=min(1, len(entry.decision.subgoals)))


def _ask(
    memory: Memory, state: WorldState, queries: list[Query]
) -> tuple[Memory, tuple[Message, ...]]:
    new = tuple(query for query in queries if query not in memory.asked)
    requests = tuple(SearchRequest(state.trial_id, query) for query in new)
    return replace(memory, asked=memory.asked + new), requests
