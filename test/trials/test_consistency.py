"""What does not fit a trial is told from what does."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from builders import CHAIR, PLANNERS, TOWERS, planner_id, spec

from blocks_planning.board.blocks import Placed
from blocks_planning.subgoals.decision import Query
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.consistency import Consistency, Contradiction
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, SearchAnswer, SearchRequest, WorldState
from blocks_planning.trials.status import TrialStatus

TRIAL = spec(CHAIR, lam=0.2, depth=2, commit='action')
HEARD: list[Message] = []
RECORD = run_trial(TRIAL, observe=HEARD.append)
STATES = [message for message in HEARD if isinstance(message, WorldState)]
CHOSEN = [message for message in HEARD if isinstance(message, SubgoalChosen)]
STRANGE = Placed(3, 3, 0, 0)


def after(*messages: Message) -> Consistency:
    """A trial in which this was said."""
    fits = Consistency(TRIAL)
    for message in messages:
        fits.check(message)
    return fits


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@pytest.mark.parametrize('rows', TOWERS)
def test_all_that_is_said_in_a_trial_fits(rows: str, planner: dict[str, Any]) -> None:
    """In order, twice, and by somebody who begins again."""
    trial = spec(rows, **planner)
    heard: list[Message] = []
    run_trial(trial, observe=heard.append)
    fits = Consistency(trial)
    for message in [m for m in heard for _ in range(2)] + heard:
        fits.check(message)
    late = Consistency(trial)
    for message in reversed(heard):
        late.check(message)


def test_state_goes_on_from_the_one_before() -> None:
    other = next(
        state
        for seed in range(1, 20)
        for state in _states_of(seed)
        if state.sequence == 2 and state.placements[0] != STATES[1].placements[0]
    )
    Consistency(TRIAL).check(other)
    fits = after(STATES[1])
    with pytest.raises(Contradiction, match='observations: do not continue'):
        fits.check(other)
    fits.check(STATES[2])


def _states_of(seed: int) -> list[WorldState]:
    heard: list[Message] = []
    run_trial(replace(TRIAL, seed=seed), observe=heard.append)
    return [message for message in heard if isinstance(message, WorldState)]


@pytest.mark.parametrize(
    ('state', 'status'),
    [
        (STATES[1], TrialStatus.SUCCESS),
        (STATES[1], TrialStatus.STUCK),
        (STATES[-1], TrialStatus.BUILDING),
        (STATES[-1], TrialStatus.STUCK),
    ],
)
def test_status_is_what_the_placements_lead_to(state: WorldState, status: TrialStatus) -> None:
    with pytest.raises(Contradiction, match='status: '):
        after(replace(state, status=status))


def _forget(chosen: SubgoalChosen) -> SubgoalChosen:
    return replace(chosen, decisions=chosen.decisions[1:])


def _cheaper(chosen: SubgoalChosen) -> SubgoalChosen:
    first, *rest = chosen.decisions
    decision = replace(first.decision, subgoal_planning_cost=1)
    return replace(chosen, decisions=(replace(first, decision=decision), *rest))


def _elsewhere(chosen: SubgoalChosen) -> SubgoalChosen:
    *before, last = chosen.decisions
    decision = replace(last.decision, built=last.decision.built ^ 1)
    return replace(chosen, decisions=(*before, replace(last, decision=decision)))


def _doubled(chosen: SubgoalChosen) -> SubgoalChosen:
    return replace(chosen, decisions=chosen.decisions + chosen.decisions[-1:])


def _later(chosen: SubgoalChosen) -> SubgoalChosen:
    return replace(chosen, sequence=chosen.sequence + 1)


def _of_a_person(chosen: SubgoalChosen) -> SubgoalChosen:
    return replace(chosen, proposals=(Proposal(0, 0, ProposalKind.BUILD, 1, 0.0),))


def _of_strange_blocks(chosen: SubgoalChosen) -> SubgoalChosen:
    *before, last = chosen.decisions
    subgoal = replace(last.decision.subgoals[0], placements=(STRANGE,))
    decision = replace(last.decision, subgoals=(subgoal,))
    return replace(chosen, decisions=(*before, replace(last, decision=decision)))


def _after_giving_up(chosen: SubgoalChosen) -> SubgoalChosen:
    first, *rest = chosen.decisions
    decision = replace(first.decision, subgoals=(), chosen=None)
    return replace(chosen, decisions=(replace(first, decision=decision), *rest))


@pytest.mark.parametrize(
    'change',
    [
        _forget,
        _cheaper,
        _elsewhere,
        _doubled,
        _later,
        _of_a_person,
        _of_strange_blocks,
        _after_giving_up,
    ],
)
def test_subgoal_that_contradicts_is_told_from_the_real_one(
    change: Callable[[SubgoalChosen], SubgoalChosen],
) -> None:
    fits = after(*STATES[:3], *CHOSEN[:2])
    with pytest.raises(Contradiction):
        fits.check(change(CHOSEN[2]))
    fits.check(CHOSEN[2])


def test_answer_of_strange_blocks_or_costs_is_refused() -> None:
    answer = next(message for message in HEARD if isinstance(message, SearchAnswer))
    fits = after(answer)
    with pytest.raises(Contradiction, match='block 3x3 is not in the library'):
        fits.check(replace(answer, result=replace(answer.result, placements=(STRANGE,))))
    dear = replace(answer.result, solution_cost=answer.result.planning_cost + 1)
    with pytest.raises(Contradiction, match='solution_cost'):
        fits.check(replace(answer, result=dear))


def test_request_for_cells_that_are_not_to_be_filled_is_refused() -> None:
    full = TRIAL.task.board.full
    after(SearchRequest(TRIAL.trial_id, (Query(0, TRIAL.task.silhouette),)))
    with pytest.raises(Contradiction, match='queries'):
        after(SearchRequest(TRIAL.trial_id, (Query(0, full),)))
    after(SearchRequest(TRIAL.trial_id, (Query(full, full),)))
