"""The searcher: plans how to fill a region."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.answers import Answers
from blocks_planning.trials.execution import SubgoalChosen, history
from blocks_planning.trials.messages import (
    Held,
    Message,
    PlaceBlock,
    PlanMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    Solve,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.status import TrialStatus

MOST_SOLVING = 1 << 16
"""Most queries that are open at once; excess queries are dropped, and the selector asks again."""
MOST_KNOWN = 1 << 17
"""Most answers that are kept of a trial; the oldest are dropped and solved again."""


@dataclass(frozen=True)
class Memory:
    """What the searcher knows about the running trial.

    Attributes:
        trial: the trial.
        state: the latest.
        known: answered queries.
        solving: queries that are being solved.
        chosen: the subgoal to execute.
        planned: the subgoal whose plan was announced.
        until: number of the first state in which no order may be given; None: there is none.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    known: Answers = field(default_factory=Answers)
    solving: frozenset[Query] = frozenset()
    chosen: SubgoalChosen | None = None
    planned: SubgoalChosen | None = None
    until: int | None = None


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Solve queries; order the placements of the subgoal, one for each state."""
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if isinstance(message, TrialStarted):
        same = trial is not None and trial.trial_id == message.trial_id
        return (memory if same else _begun(message)), ()
    if trial is None or trial.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case SearchRequest(trial_id, queries):
            return _answer(memory, trial_id, queries)
        case SearchAnswer(_, query, result) if query not in memory.known:
            known = memory.known.with_answer(query, result).latest(MOST_KNOWN)
            solving = memory.solving - {query}
            return _act(replace(memory, known=known, solving=solving), only_for=query)
        case WorldState() if state is None or message.sequence > state.sequence:
            return _act(replace(memory, state=message))
        case SubgoalChosen() if chosen is None or message.sequence > chosen.sequence:
            return _act(replace(memory, chosen=message))
        case Held(_, until) if until != memory.until:
            return _act(replace(memory, until=until))
        case Remind():
            return _act(memory)
    return memory, ()


def _begun(trial: TrialStarted) -> Memory:
    """The memory at the start of a trial; nothing if another program does this part."""
    return Memory() if trial.spec.search.is_external else Memory(trial)


def _answer(
    memory: Memory, trial_id: str, queries: Iterable[Query]
) -> tuple[Memory, tuple[Message, ...]]:
    """Answer known queries; start the solves of the others, except those that are running."""
    said: list[Message] = []
    solving = set(memory.solving)
    for query in queries:
        if query in memory.known:
            said.append(SearchAnswer(trial_id, query, memory.known[query]))
        elif query not in solving and len(solving) < MOST_SOLVING:
            solving.add(query)
            said.append(Solve(trial_id, query))
    return replace(memory, solving=frozenset(solving)), tuple(said)


def _act(memory: Memory, only_for: Query | None = None) -> tuple[Memory, tuple[Message, ...]]:
    """Order the next placement of the plan, if the latest state is on its way."""
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if trial is None or state is None or chosen is None or chosen.subgoal is None:
        return memory, ()
    if chosen.sequence > state.sequence:
        return memory, ()
    query = trial.spec.query(
        chosen.built, chosen.subgoal.target, chosen.blocks(state.observations)
    )
    if only_for not in (None, query):
        return memory, ()
    if query not in memory.known:
        return _answer(memory, trial.trial_id, (query,))
    plan = memory.known[query].plan
    said: tuple[Message, ...] = ()
    if memory.planned != chosen:
        execute = chosen.subgoal.execute
        said = (PlanMade(trial.trial_id, chosen.sequence, query.target, execute, plan),)
    done = _next_placement(trial, state, chosen)
    may_order = memory.until is None or state.sequence < memory.until
    if done is not None and done < len(plan) and may_order:
        said += (PlaceBlock(trial.trial_id, state.sequence, plan[done].placement),)
    return replace(memory, planned=chosen), said


def _next_placement(trial: TrialStarted, state: WorldState, chosen: SubgoalChosen) -> int | None:
    """Index in the plan of the placement to order in the latest state; None if there is none.

    A board on which the trial is over gets no more orders.
    """
    if state.status is not TrialStatus.BUILDING:
        return None
    seen = history(trial.spec.task.board, state.observations)
    progress = chosen.progress(trial.spec, seen)
    return progress.done if progress.is_open else None
