"""The part that chooses subgoals."""

from __future__ import annotations

from itertools import pairwise

import pytest
from parts import (
    ANSWERS,
    CHOSEN,
    FULL,
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
from blocks_planning.trials import selector
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import Remind, SearchAnswer, SearchRequest, WorldState
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


def test_selector_asks_about_every_candidate_and_then_decides() -> None:
    memory, requests = tell(selector, [START, STATES[0]])
    task = TRIAL.task
    queries = tuple(Query(0, task.rows(height)) for height in range(1, 7))
    assert requests == [SearchRequest(TRIAL.trial_id, queries)]
    for query in queries[:0:-1]:
        memory, said = tell(
            selector, [SearchAnswer(TRIAL.trial_id, query, answer(TRIAL, query))], memory
        )
        assert said == []
    last = SearchAnswer(TRIAL.trial_id, queries[0], answer(TRIAL, queries[0]))
    _, said = tell(selector, [last], memory)
    assert said == [CHOSEN[0]]


def test_selector_says_nothing_while_a_subgoal_is_executed() -> None:
    memory, _ = tell(selector, HEARD[: HEARD.index(CHOSEN[0])])
    assert memory.chosen == CHOSEN[0]
    execute = CHOSEN[1].sequence
    assert execute > 1
    memory, said = tell(selector, [*STATES[1:execute]], memory)
    assert said == []
    _, said = tell(selector, [STATES[execute]], memory)
    assert said
    assert all(isinstance(message, SearchRequest) for message in said)


def test_selector_decides_anew_where_a_plan_was_left() -> None:
    memory, _ = tell(selector, HEARD[: HEARD.index(CHOSEN[0])])
    elsewhere = seen(TRIAL, Placed(1, 2, 1, 0))
    after, said = tell(selector, [elsewhere], memory)
    # It covers cells that are no target: no region contains them.
    assert after.chosen is not None
    [chosen] = only(SubgoalChosen, said)
    assert chosen.subgoal is None
    assert chosen.sequence == 1


def test_selector_goes_on_to_the_next_subgoal_of_a_sequence() -> None:
    chosen: list[SubgoalChosen] = only(SubgoalChosen, heard(FULL))
    assert [message.index for message in chosen] == list(range(len(chosen)))
    assert len(chosen) > 2
    assert {len(message.decisions) for message in chosen} == {1}
    for before, after in pairwise(chosen):
        assert before.subgoal is not None
        assert before.subgoal.target == after.built
        assert after.sequence == before.sequence + before.subgoal.execute


@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_selector_that_has_forgotten_everything_asks_again(trial: TrialSpec) -> None:
    messages = heard(trial)
    chosen = only(SubgoalChosen, messages)
    for state in only(WorldState, messages):
        memory, said = tell(selector, [started(trial), state])
        announced = only(SubgoalChosen, said)
        while requests := only(SearchRequest, said):
            answers = [
                SearchAnswer(trial.trial_id, query, answer(trial, query))
                for request in requests
                for query in request.queries
            ]
            memory, said = tell(selector, list(answers), memory)
            announced += only(SubgoalChosen, said)
        over = state.status is not TrialStatus.BUILDING
        latest = [message for message in chosen if message.sequence <= state.sequence - over]
        assert announced == latest[-1:]
        assert memory.chosen == (latest[-1] if latest else None)


def test_selector_that_is_reminded_asks_what_is_unanswered() -> None:
    memory, requests = tell(selector, [START, STATES[0]])
    memory, _ = tell(selector, ANSWERS[:2], memory)
    [request] = only(SearchRequest, requests)
    rest = SearchRequest(TRIAL.trial_id, request.queries[2:])
    assert selector.step(memory, Remind(TRIAL.trial_id)) == (memory, (rest,))
