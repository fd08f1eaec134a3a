"""The selector: chooses the next region."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from blocks_planning.subgoals.decision import Decision, Query, Situation
from blocks_planning.subgoals.human import used
from blocks_planning.subgoals.proposals import (
    Proposal,
    ProposalKind,
    asks_nothing,
    out_of_turn,
    proposed_at,
    target_of,
)
from blocks_planning.trials.answers import Answers
from blocks_planning.trials.execution import History, SubgoalChosen, history
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import standing

MOST_IN_REQUEST = 1 << 12
"""Most queries in one request."""


@dataclass(frozen=True)
class Memory:
    """What the selector knows about the running trial.

    Attributes:
        trial: the trial.
        state: the latest.
        known: answered queries.
        asked: queries that were sent, answered or not, in order.
        chosen: the subgoal that is being executed.
        proposals: of a person, in the order of their numbers in every state.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    known: Answers = field(default_factory=Answers)
    asked: Mapping[Query, None] = field(default_factory=dict)
    chosen: SubgoalChosen | None = None
    proposals: tuple[Proposal, ...] = ()


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Make a decision in every state in which one is due; request the solves that it needs."""
    trial, state = memory.trial, memory.state
    if isinstance(message, TrialStarted):
        same = trial is not None and trial.trial_id == message.trial_id
        return (memory if same else _begun(message)), ()
    if trial is None or trial.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case WorldState() if state is None or message.sequence > state.sequence:
            return _go_on(replace(memory, state=message), trial.spec, message)
        case SearchAnswer(_, query, result) if state is not None and _is_open(memory, query):
            memory = replace(memory, known=memory.known.with_answer(query, result))
            if len(memory.known) < len(memory.asked):
                return memory, ()
            return _go_on(memory, trial.spec, state)
        case ProposalMade(_, proposal) if _is_next(memory, trial.spec, proposal):
            memory = replace(memory, proposals=(*memory.proposals, proposal))
            return (memory, ()) if state is None else _consider(memory, trial, state, proposal)
        case Remind():
            unanswered = tuple(query for query in memory.asked if query not in memory.known)
            return memory, _request(trial.trial_id, unanswered)
    return memory, ()


def _begun(trial: TrialStarted) -> Memory:
    """The memory at the start of a trial; nothing if another program does this part."""
    return Memory() if trial.spec.strategy.is_external else Memory(trial)


def reason_against(memory: Memory, proposal: Proposal) -> str:
    """Why a proposal is refused; '' if it is taken, was taken before, or waits for its state."""
    if memory.trial is None or memory.state is None:
        return ''
    spec, state = memory.trial.spec, memory.state
    if not spec.strategy.asks_person:
        return f'the strategy is {spec.strategy.name}, which does not ask a person'
    taken = proposed_at(memory.proposals, proposal.sequence)
    if proposal.number < len(taken):
        return ''
    reason = out_of_turn(memory.proposals, proposal)
    if reason or proposal.sequence != state.sequence:
        return reason
    return asks_nothing(spec.task, state.built, proposal)


def _is_open(memory: Memory, query: Query) -> bool:
    """Whether a query was asked and is not answered; the first answer counts."""
    return query in memory.asked and query not in memory.known


def _is_next(memory: Memory, spec: TrialSpec, proposal: Proposal) -> bool:
    """Whether the strategy asks a person, and this proposal is the next one in its state."""
    return spec.strategy.asks_person and not out_of_turn(memory.proposals, proposal)


def _consider(
    memory: Memory, trial: TrialStarted, state: WorldState, proposal: Proposal
) -> tuple[Memory, tuple[Message, ...]]:
    """Accept a proposal; a region that is known to be unsolvable is answered again."""
    memory, said = _go_on(memory, trial.spec, state)
    target = target_of(trial.spec.task, state.built, proposal.region)
    query = trial.spec.query(state.built, target, state.placements)
    is_known = proposal.kind is ProposalKind.BUILD and query in memory.known
    if not said and is_known and proposal.sequence == state.sequence:
        said = _request(trial.trial_id, (query,))
    return memory, said


def _go_on(
    memory: Memory, spec: TrialSpec, state: WorldState
) -> tuple[Memory, tuple[Message, ...]]:
    """Make decision after decision up to the latest state, beginning with the last one made.

    At most one decision is due, unless this selector was started in the middle of a trial and
    knows no decisions. Then it makes the earlier decisions again, with the same results.
    """
    seen = history(spec.task.board, state.observations)
    chosen = memory.chosen
    while True:
        due = due_decision(spec, chosen, seen)
        if due is None or (due == state.sequence and state.status is not TrialStatus.BUILDING):
            break
        if chosen is not None and is_followed_on(spec, chosen, seen):
            chosen = chosen.begun(due, executed=chosen.index + 2)
            continue
        situation = _situation(memory, spec, seen, chosen, due)
        answer = spec.strategy.decide(situation)
        if not isinstance(answer, Decision):
            return _ask(replace(memory, chosen=chosen), state, answer)
        chosen = _decided(state.trial_id, chosen, DecisionRecord(due, answer, 0), situation)
    said = (chosen,) if chosen is not None and chosen != memory.chosen else ()
    return replace(memory, chosen=chosen), said


def due_decision(spec: TrialSpec, chosen: SubgoalChosen | None, seen: History) -> int | None:
    """The sequence of the state in which the next decision is due; None if none is due yet."""
    if chosen is None:
        return 0
    if chosen.subgoal is None or chosen.sequence >= len(seen.states):
        return None
    progress = chosen.progress(spec, seen)
    return None if progress.is_open else progress.sequence


def is_followed_on(spec: TrialSpec, chosen: SubgoalChosen, seen: History) -> bool:
    """Whether the current subgoal is done and the next one of its decision is to be executed."""
    progress = chosen.progress(spec, seen)
    if chosen.subgoal is None or not progress.is_done or not chosen.has_next:
        return False
    is_filled = seen.states[progress.sequence] == chosen.subgoal.target
    return is_filled or spec.strategy.is_blind


def _situation(
    memory: Memory,
    spec: TrialSpec,
    seen: History,
    chosen: SubgoalChosen | None,
    sequence: int,
) -> Situation:
    return Situation(
        task=spec.task,
        built=seen.states[sequence],
        seed=spec.seed,
        known=memory.known,
        proposals=proposed_at(memory.proposals, sequence),
        blocks=standing(seen.observations[: sequence + 1]),
        decisions=0 if chosen is None else len(chosen.decisions),
        plans_on_blocks=spec.plans_on_blocks,
    )


def _decided(
    trial_id: str, before: SubgoalChosen | None, entry: DecisionRecord, situation: Situation
) -> SubgoalChosen:
    """The subgoal chosen after one more decision."""
    if before is None:
        before = SubgoalChosen(trial_id, entry.sequence, ())
    led_here = used(situation, entry.decision) if situation.proposals else ()
    chosen = replace(
        before,
        decisions=(*before.decisions, entry),
        proposals=(*before.proposals, *led_here),
    )
    return chosen.begun(entry.sequence, executed=min(1, len(entry.decision.subgoals)))


def _ask(
    memory: Memory, state: WorldState, queries: Sequence[Query]
) -> tuple[Memory, tuple[Message, ...]]:
    new = tuple(query for query in queries if query not in memory.asked)
    asked = {**memory.asked, **dict.fromkeys(new)}
    return replace(memory, asked=asked), _request(state.trial_id, new)


def _request(trial_id: str, queries: tuple[Query, ...]) -> tuple[SearchRequest, ...]:
    return tuple(
        SearchRequest(trial_id, queries[start : start + MOST_IN_REQUEST])
        for start in range(0, len(queries), MOST_IN_REQUEST)
    )
