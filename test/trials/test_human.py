"""Trials in which a person scopes: their records hold, and can be replayed."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from builders import ARCH, CHAIR, FRAME, SQUARE, remade
from hypothesis import given
from hypothesis import strategies as st
from persons import BUILD, GIVE_UP, WITHDRAWN, Person, human_record, human_spec, rows_of
from strategies import solvable_tasks

from blocks_planning.board.task import Task
from blocks_planning.errors import RecordError
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials import selector
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchAnswer,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun
from blocks_planning.view.scene import last_scene

SPEC = human_spec(CHAIR, depth=2)
NO_WAY = SPEC.task.rows(2) | SPEC.task.board.mask([(0, 2)])
"""The lower posts and a single cell on one of them."""


def test_person_who_goes_row_by_row_succeeds() -> None:
    said = rows_of(SPEC, 2, 4, 6)
    record = run_trial(SPEC, proposals=said)
    assert record.status is TrialStatus.SUCCESS
    assert record.subgoals == 3
    assert record.proposals == tuple(said)
    assert [entry.decision.chosen for entry in record.decisions] == [0, 0, 0]
    assert record.subgoal_planning_cost == record.action_planning_cost > 0
    assert list(contradictions(record)) == []


def test_everything_that_was_said_is_in_the_record() -> None:
    words = [
        Proposal(0, 0, WITHDRAWN, SPEC.task.rows(1), 2.5),
        Proposal(0, 1, BUILD, NO_WAY, 1.25),
        Proposal(0, 2, GIVE_UP, 0, 9.0),
    ]
    record = run_trial(SPEC, proposals=words)
    assert record.status is TrialStatus.GAVE_UP
    assert record.proposals == tuple(words)
    (entry,) = record.decisions
    assert [c.status.value for c in entry.decision.candidates] == ['budget_exhausted']
    assert record.subgoal_planning_cost == entry.decision.candidates[0].planning_cost > 0
    assert record.action_planning_cost == 0
    data = json.loads(record.to_line())
    assert data['strategy_settings'] == {'participant': 'P01', 'costs': 'shown'}
    assert data['proposals'][0] == {
        'sequence': 0,
        'number': 0,
        'kind': 'withdrawn',
        'region': hex(SPEC.task.rows(1)),
        'thinking_s': 2.5,
    }


def test_person_who_says_no_more_is_not_waited_for() -> None:
    record = run_trial(SPEC, proposals=rows_of(SPEC, 2, 4)[:2])
    assert record.status is TrialStatus.CANCELLED
    assert record.subgoals == 2
    assert list(contradictions(record)) == []


@given(
    solvable_tasks(most=6, most_blocks=10),
    st.integers(0, 2**32),
    st.sampled_from(['bfs', 'random', 'exact']),
)
def test_records_of_any_person_hold_and_are_replayed(task: Task, seed: int, search: str) -> None:
    spec = TrialSpec('any', task, Human(), make_search(search, {}), seed % 5, 500)
    person = Person(spec, seed)
    record = run_trial(spec, observe=person.observe, proposals=person)
    again = record_from_json(json.loads(record.to_line()), 'test')
    assert again == record
    assert list(contradictions(again)) == []
    assert list(differs_from_rerun(again)) == []
    assert last_scene(record).record == record


@pytest.mark.parametrize('rows', [ARCH, FRAME, SQUARE, CHAIR])
@pytest.mark.parametrize('seed', range(3))
def test_selector_that_comes_late_decides_as_before(rows: str, seed: int) -> None:
    """From the trial, the latest state and all proposals, in any order among topics."""
    spec = human_spec(rows, depth=2)
    person = Person(spec, seed)
    heard: list[Message] = []

    def observe(message: Message) -> None:
        person.observe(message)
        heard.append(message)

    run_trial(spec, observe=observe, proposals=person)
    chosen = [m for m in heard if isinstance(m, SubgoalChosen)]
    for last in chosen:
        until = heard.index(last)
        states = [m for m in heard[:until] if isinstance(m, WorldState)]
        proposals = [m for m in heard[:until] if isinstance(m, ProposalMade)]
        answers = [m for m in heard[:until] if isinstance(m, SearchAnswer)]
        orders: tuple[list[Message], ...] = ([states[-1], *proposals], [*proposals, states[-1]])
        for order in orders:
            assert last in told([TrialStarted(spec.trial_id, spec), *order, *answers])


def told(messages: list[Message]) -> list[Message]:
    """What a new selector says to some messages; answers are given again as often as asked."""
    memory = selector.Memory()
    all_said: list[Message] = []
    answers = [m for m in messages if isinstance(m, SearchAnswer)]
    for message in [*messages, *answers, *answers]:
        memory, said = selector.step(memory, message)
        all_said += said
    return all_said


def test_selector_ignores_what_is_doubled_or_out_of_order() -> None:
    first, second = (
        ProposalMade(SPEC.trial_id, Proposal(0, number, BUILD, SPEC.task.rows(number + 1), 1.0))
        for number in range(2)
    )
    memory, _ = selector.step(selector.Memory(), TrialStarted(SPEC.trial_id, SPEC))
    for ignored in (second, replace(first, trial_id='another')):
        assert selector.step(memory, ignored) == (memory, ())
    memory, _ = selector.step(memory, first)
    assert memory.proposals == (first.proposal,)
    assert selector.step(memory, first) == (memory, ())
    memory, _ = selector.step(memory, second)
    assert memory.proposals == (first.proposal, second.proposal)


def test_planner_does_not_listen_to_people() -> None:
    spec = replace(SPEC, strategy=Human())
    planner = human_record(CHAIR).spec
    planner = TrialSpec('small', planner.task, _scoping(), planner.search, 0, 2000)
    memory, _ = selector.step(selector.Memory(), TrialStarted(planner.trial_id, planner))
    word = ProposalMade(planner.trial_id, Proposal(0, 0, BUILD, spec.task.rows(1), 1.0))
    assert selector.step(memory, word) == (memory, ())


def _scoping() -> Any:
    from blocks_planning.subgoals.scoping import Scoping

    return Scoping()


SAMPLE = json.loads(
    run_trial(
        SPEC,
        proposals=[
            Proposal(0, 0, WITHDRAWN, SPEC.task.rows(1), 2.5),
            Proposal(0, 1, BUILD, NO_WAY, 1.5),
            *(
                replace(p, number=p.number + 2) if p.sequence == 0 else p
                for p in rows_of(SPEC, 2, 4, 6)
            ),
        ],
    ).to_line()
)


def drop_first(data: dict[str, Any]) -> None:
    data['proposals'] = data['proposals'][1:]


def drop_all(data: dict[str, Any]) -> None:
    data['proposals'] = []


def swap(data: dict[str, Any]) -> None:
    data['proposals'][:2] = data['proposals'][1::-1]


def say_more(data: dict[str, Any]) -> None:
    data['proposals'].append({**data['proposals'][-1], 'sequence': 99})


def draw_another(data: dict[str, Any]) -> None:
    data['proposals'][1]['region'] = '0x1'


def let_go(data: dict[str, Any]) -> None:
    data['proposals'][2]['kind'] = 'withdrawn'


def give_up(data: dict[str, Any]) -> None:
    data['proposals'][2]['kind'] = 'give_up'


def test_sample_holds() -> None:
    assert list(contradictions(record_from_json(SAMPLE, 'x'))) == []
    assert SAMPLE['status'] == 'success'
    assert len(SAMPLE['proposals']) == 5


@pytest.mark.parametrize(
    'change', [drop_first, drop_all, swap, say_more, draw_another, let_go, give_up]
)
def test_proposals_that_do_not_lead_to_the_decisions_are_found(
    change: Callable[[dict[str, Any]], None],
) -> None:
    data = json.loads(json.dumps(SAMPLE))
    change(data)
    assert list(contradictions(record_from_json(remade(data), 'x')))


@pytest.mark.parametrize(
    ('key', 'value', 'what'),
    [
        ('thinking_s', -1.0, 'thinking_s must be a finite number'),
        ('thinking_s', 'long', 'thinking_s must be of type float'),
        ('kind', 'maybe', 'kind must be one of build, withdrawn, give_up'),
        ('region', '#', 'region must be a hexadecimal mask'),
        ('number', -1, 'number must be from 0'),
    ],
)
def test_proposals_that_can_not_be_are_refused(key: str, value: object, what: str) -> None:
    data = json.loads(json.dumps(SAMPLE))
    data['proposals'][1][key] = value
    with pytest.raises(RecordError, match=what):
        record_from_json(data, 'x')


def test_what_is_proposed_again_is_answered_again() -> None:
    heard: list[Message] = []
    words = [Proposal(0, number, BUILD, NO_WAY, 1.0) for number in range(3)]
    record = run_trial(
        SPEC, observe=heard.append, proposals=[*words, Proposal(0, 3, GIVE_UP, 0, 1)]
    )
    assert len([m for m in heard if isinstance(m, SearchAnswer)]) == 3
    (entry,) = record.decisions
    first, *others = [c.planning_cost for c in entry.decision.candidates]
    assert others == [first, first]
    assert record.subgoal_planning_cost == 3 * first > 0
