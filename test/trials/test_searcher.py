"""The part that plans how to fill a region, and orders placements."""

from __future__ import annotations

from dataclasses import replace

import pytest
from builders import NEVER_SOLVED, spec
from parts import (
    ANSWERS,
    CHOSEN,
    HEARD,
    IDS,
    START,
    STATES,
    TRIAL,
    TRIALS,
    answer,
    heard,
    only,
    seen,
    started,
    tell,
)

from blocks_planning.board.blocks import Placed
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials import searcher
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    PlaceBlock,
    PlanMade,
    Remind,
    SearchAnswer,
    SearchRequest,
    Solve,
    WorldState,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


def test_searcher_solves_what_is_asked_once() -> None:
    query = ANSWERS[0].query
    request = SearchRequest(TRIAL.trial_id, (query,))
    memory, said = tell(searcher, [START, request])
    assert said == [Solve(TRIAL.trial_id, query)]
    memory, said = tell(searcher, [ANSWERS[0]], memory)
    assert said == []
    _, said = tell(searcher, [request], memory)
    assert said == [ANSWERS[0]]


def test_searcher_solves_no_query_twice_at_a_time() -> None:
    request = SearchRequest(TRIAL.trial_id, (ANSWERS[0].query,))
    _, said = tell(searcher, [START, request, request])
    assert said == [Solve(TRIAL.trial_id, ANSWERS[0].query)]


def test_searcher_sends_one_placement_for_each_state() -> None:
    memory, sent = tell(searcher, [START, STATES[0], *ANSWERS[:6], CHOSEN[0]])
    plan = CHOSEN[0].subgoal
    assert plan is not None
    for state in STATES[1 : plan.execute + 1]:
        memory, said = tell(searcher, [state], memory)
        sent += said
    assert sent == [
        PlanMade(TRIAL.trial_id, 0, plan.target, plan.execute, plan.placements),
        *(
            PlaceBlock(TRIAL.trial_id, number, placed.placement)
            for number, placed in enumerate(plan.placements)
        ),
    ]
    assert only(PlaceBlock, HEARD)[: len(sent) - 1] == sent[1:]


@pytest.mark.parametrize('order', ['state first', 'subgoal first'])
@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_searcher_that_has_forgotten_everything_goes_on(trial: TrialSpec, order: str) -> None:
    messages = heard(trial)
    chosen = only(SubgoalChosen, messages)
    placed = {message.sequence: message for message in only(PlaceBlock, messages)}
    for state in only(WorldState, messages):
        if state.sequence not in placed:
            continue
        latest = [message for message in chosen if message.sequence <= state.sequence][-1]
        latched = [state, latest] if order == 'state first' else [latest, state]
        memory, said = tell(searcher, [started(trial), *latched])
        query = Query(latest.built, latest.subgoal.target)
        assert said == [Solve(trial.trial_id, query)]
        result = SearchAnswer(trial.trial_id, query, answer(trial, query))
        _, said = tell(searcher, [result], memory)
        assert only(PlaceBlock, said) == [placed[state.sequence]]
        assert [message.sequence for message in only(PlanMade, said)] == [latest.sequence]


def test_searcher_that_is_reminded_sends_its_placement_again() -> None:
    memory, said = tell(searcher, [START, STATES[0], *ANSWERS[:6], CHOSEN[0]])
    assert searcher.step(memory, Remind(TRIAL.trial_id)) == (memory, tuple(only(PlaceBlock, said)))


def test_searcher_orders_nothing_on_a_board_that_has_collapsed() -> None:
    """Its blocks may stand as the plan expects: what fell is not among them."""
    collapsed = replace(STATES[0], status=TrialStatus.COLLAPSED)
    _, said = tell(searcher, [START, collapsed, *ANSWERS[:6], CHOSEN[0]])
    assert only(PlaceBlock, said) == []


def test_searcher_places_nothing_where_no_subgoal_leads_on() -> None:
    memory, _ = tell(searcher, [START, *ANSWERS[:6], CHOSEN[0]])
    for state in STATES[CHOSEN[1].sequence :]:
        _, said = tell(searcher, [state], memory)
        assert only(PlaceBlock, said) == []
    _, said = tell(searcher, [seen(TRIAL, Placed(1, 2, 1, 0))], memory)
    assert only(PlaceBlock, said) == []


def test_searcher_does_nothing_when_the_planner_gives_up() -> None:
    messages = heard(spec(NEVER_SOLVED))
    assert only(SubgoalChosen, messages)[0].subgoal is None
    assert only(PlaceBlock, messages) == []
