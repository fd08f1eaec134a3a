"""The searcher: how a region is filled."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlanMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    Solve,
    SubgoalChosen,
    TrialEnded,
    TrialStarted,
    WorldState,
)

MOST_SOLVING = 512
"""No planner asks so much at once; who asks more is not answered, and asks again."""
MOST_KNOWN = 8192
"""No trial needs so many answers; the oldest are solved again."""


@dataclass(frozen=True)
class Memory:
    """What the searcher knows of the trial that runs.

    Attributes:
        trial: the trial.
        state: the latest.
        known: answered queries.
        solving: queries that are being solved.
        chosen: the subgoal to execute.
        planned: the subgoal whose plan was announced.
    """

    trial: TrialStarted | None = None
    state: WorldState | None = None
    known: Mapping[Query, SolveResult] = field(default_factory=dict)
    solving: frozenset[Query] = frozenset()
    chosen: SubgoalChosen | None = None
    planned: SubgoalChosen | None = None


def step(memory: Memory, message: Message) -> tuple[Memory, tuple[Message, ...]]:
    """Solve what is asked; send the placements of the subgoal, one for each state."""
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if isinstance(message, TrialStarted):
        same = trial is not None and trial.trial_id == message.trial_id
        return (memory if same else Memory(message)), ()
    if trial is None or trial.trial_id != message.trial_id:
        return memory, ()
    match message:
        case TrialEnded():
            return Memory(), ()
        case SearchRequest(trial_id, query):
            if query in memory.known:
                return memory, (SearchAnswer(trial_id, query, memory.known[query]),)
            return _solve(memory, trial_id, query)
        case SearchAnswer(_, query, result) if query not in memory.known:
            known, solving = {**memory.known, query: result}, memory.solving - {query}
            if len(known) > MOST_KNOWN:
                del known[next(iter(known))]
            return _act(replace(memory, known=known, solving=solving), only_for=query)
        case WorldState() if state is None or message.sequence > state.sequence:
            return _act(replace(memory, state=message))
        case SubgoalChosen() if chosen is None or message.sequence > chosen.sequence:
            return _act(replace(memory, chosen=message))
        case Remind():
            return _act(memory)
    return memory, ()


def _solve(memory: Memory, trial_id: str, query: Query) -> tuple[Memory, tuple[Message, ...]]:
    if query in memory.solving or len(memory.solving) >= MOST_SOLVING:
        return memory, ()
    return replace(memory, solving=memory.solving | {query}), (Solve(trial_id, query),)


def _act(memory: Memory, only_for: Query | None = None) -> tuple[Memory, tuple[Message, ...]]:
    """Send the placement that the latest state calls for, if the subgoal leads on from it."""
    trial, state, chosen = memory.trial, memory.state, memory.chosen
    if trial is None or state is None or chosen is None or chosen.subgoal is None:
        return memory, ()
    query = Query(chosen.built, chosen.subgoal.region)
    if only_for not in (None, query):
        return memory, ()
    if query not in memory.known:
        return _solve(memory, trial.trial_id, query)
    plan = memory.known[query].placements
    said: tuple[Message, ...] = ()
    if memory.planned != chosen:
        execute = chosen.subgoal.execute
        said = (PlanMade(trial.trial_id, chosen.sequence, query.region, execute, plan),)
    done = state.sequence - chosen.sequence
    underway = 0 <= done < min(chosen.subgoal.execute, len(plan))
    if underway and state.built == chosen.way(trial.spec.task.board)[done]:
        said += (PlaceBlock(trial.trial_id, state.sequence, plan[done].placement),)
    return replace(memory, planned=chosen), said
