"""The four parts of a trial, and messages for them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from types import ModuleType
from typing import Any

from builders import CHAIR, EMPTY, FRAME, NEVER_SOLVED, NOTHING_FITS, ODD, planner_id, spec

from blocks_planning.board.blocks import Placed
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    SearchAnswer,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation

PARTS = {'world': world, 'selector': selector, 'searcher': searcher, 'scribe': scribe}
TRIAL = spec(CHAIR, lam=0.2, depth=2)
FOREIGN = spec(CHAIR, lam=0.2, depth=2, seed=1)
FULL = spec(CHAIR, strategy='full', depth=1)
PLANNERS: list[dict[str, Any]] = [
    {'strategy': 'scoping', 'lam': 0.2, 'depth': 2},
    {'strategy': 'scoping', 'commit': 'action', 'lam': 0.1, 'depth': 1},
    {'strategy': 'full', 'depth': 1},
    {'strategy': 'none', 'depth': 2},
    {'strategy': 'scoping', 'lam': 0.1, 'horizon': 2, 'choice': 'softmax', 'depth': 1},
]
ROWS = [CHAIR, FRAME, ODD, NEVER_SOLVED, NOTHING_FITS, EMPTY]
TRIALS = [spec(rows, budget=2000, **planner) for rows in ROWS for planner in PLANNERS]
IDS = [f'{rows}-{planner_id(planner)}' for rows in ROWS for planner in PLANNERS]


def tell(
    part: ModuleType, messages: Sequence[Message], memory: Any = None
) -> tuple[Any, list[Message]]:
    """What a part knows, and all that it has said, after some messages."""
    memory = part.Memory() if memory is None else memory
    said: list[Message] = []
    for message in messages:
        memory, more = part.step(memory, message)
        said.extend(more)
    return memory, said


def started(trial: TrialSpec) -> TrialStarted:
    """The message that begins a trial."""
    return TrialStarted(trial.trial_id, trial)


def heard(trial: TrialSpec) -> list[Message]:
    """Every message of an undisturbed trial, in order."""
    messages: list[Message] = []
    run_trial(trial, observe=messages.append)
    return messages


def only(kind: type[Any], messages: list[Message]) -> list[Any]:
    """The messages of a kind."""
    return [message for message in messages if isinstance(message, kind)]


def seen(trial: TrialSpec, *placements: Placed) -> WorldState:
    """The state after some orders that were carried out."""
    found = Observation()
    made = (Observation(placed.placement, (placed,)) for placed in placements)
    return observed(trial.trial_id, trial.task.board, (found, *made), TrialStatus.BUILDING)


@cache
def answer(trial: TrialSpec, query: Query) -> SolveResult:
    """What a solve gives."""
    return solve(Problem(trial.task, *query), trial.search, trial.seed, trial.budget)


START, FOREIGN_START = started(TRIAL), started(FOREIGN)
HEARD = heard(TRIAL)
STATES: list[WorldState] = only(WorldState, HEARD)
CHOSEN: list[SubgoalChosen] = only(SubgoalChosen, HEARD)
ANSWERS: list[SearchAnswer] = only(SearchAnswer, HEARD)
