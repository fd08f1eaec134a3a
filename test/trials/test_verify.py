"""Records hold against the rules if they are true, and lies in them are found."""

from __future__ import annotations

import json
from collections.abc import Callable
from copy import deepcopy
from dataclasses import replace
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    EMPTY,
    FRAME,
    NEVER_SOLVED,
    NOTHING_FITS,
    ODD,
    PLANNERS,
    SQUARE,
    TOWERS,
    cancelled_record,
    planner_id,
    record,
    record_json,
    remade,
    spec,
)

from blocks_planning.errors import RecordError
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun

# What is true.


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_real_records_hold(planner: dict[str, Any]) -> None:
    for rows in TOWERS:
        real = record(rows, budget=300, **planner)
        assert list(contradictions(real)) == []
        assert list(differs_from_rerun(real)) == []


@pytest.mark.parametrize(
    ('rows', 'planner', 'status'),
    [
        (ARCH, {}, TrialStatus.SUCCESS),
        (EMPTY, {}, TrialStatus.SUCCESS),
        (NOTHING_FITS, {}, TrialStatus.STUCK),
        (ODD, {}, TrialStatus.STUCK),
        (ODD, {'strategy': 'none', 'budget': 10}, TrialStatus.STUCK),
        (NEVER_SOLVED, {}, TrialStatus.GAVE_UP),
        (FRAME, {'lam': 0.05, 'depth': 2}, TrialStatus.GAVE_UP),
    ],
)
def test_records_of_every_status_hold(
    rows: str, planner: dict[str, Any], status: TrialStatus
) -> None:
    real = record(rows, **planner)
    assert real.status is status
    assert list(contradictions(real)) == []


CANCELLED = [
    (CHAIR, {'lam': 0.2, 'depth': 2}),
    (CHAIR, {'commit': 'action', 'lam': 0.1, 'depth': 1}),
    (CHAIR, {'strategy': 'full', 'depth': 1}),
    (ARCH, {'strategy': 'none'}),
    (FRAME, {'lam': 0.05, 'depth': 2}),
    (NOTHING_FITS, {}),
    (EMPTY, {}),
]


@pytest.mark.parametrize(('rows', 'planner'), CANCELLED)
def test_cancelled_records_hold_wherever_they_end(rows: str, planner: dict[str, Any]) -> None:
    trial = spec(rows, **planner)
    messages: list[Message] = []
    whole = run_trial(trial, observe=messages.append)
    for number in range(1, len(messages) + 1):
        real = cancelled_record(trial, number)
        assert real.status in (TrialStatus.CANCELLED, whole.status)
        assert list(contradictions(real)) == []
        assert list(differs_from_rerun(real)) == []
        assert real.placements == whole.placements[: len(real.placements)]


@pytest.mark.parametrize('rows', TOWERS)
def test_trial_that_is_cancelled_before_it_begins_has_a_record(rows: str) -> None:
    cancel = CancelToken()
    cancel.cancel()
    real = run_trial(spec(rows), cancel)
    assert real.status is TrialStatus.CANCELLED
    assert (real.placements, real.decisions) == ((), ())
    assert list(contradictions(real)) == []


# What is not.


TRUE = {
    'scoping': record_json(CHAIR, lam=0.2, depth=2),
    'action': record_json(CHAIR, commit='action', lam=0.1, depth=1),
    'full': record_json(CHAIR, strategy='full', depth=1),
    'none': record_json(CHAIR, strategy='none', depth=2),
    'gave_up': record_json(FRAME, lam=0.05, depth=2),
    'stuck': record_json(ODD, lam=0.2, depth=2),
    'nothing': record_json(EMPTY),
    'cancelled': json.loads(cancelled_record(spec(CHAIR, lam=0.2, depth=2), 30).to_line()),
}


def found(data: dict[str, Any]) -> list[str]:
    """The contradictions of a record in which somebody lied, and then mended the sums."""
    try:
        return list(contradictions(record_from_json(remade(data), 'x')))
    except RecordError as error:
        return [str(error)]


Lie = Callable[[dict[str, Any]], object]


def put(*path: str | int, to: object) -> Lie:
    """A lie that puts something in the place of a part."""
    *above, last = path

    def lie(data: dict[str, Any]) -> None:
        part: Any = data
        for key in above:
            part = part[key]
        part[last] = to(part[last]) if callable(to) else to

    return lie


def both(*lies: Lie) -> Lie:
    """Several lies at once."""

    def lie(data: dict[str, Any]) -> None:
        for one in lies:
            one(data)

    return lie


def _without(*path: str | int) -> Lie:
    """A lie that leaves out one of some parts."""
    *above, index = path

    def rest(parts: list[Any]) -> list[Any]:
        left = list(parts)
        del left[int(index)]
        return left

    return put(*above, to=rest)


def _more(number: int) -> int:
    return number + 1


def _less(number: int) -> int:
    return number - 1


def _twice(index: int) -> Callable[[list[Any]], list[Any]]:
    return lambda parts: [*parts[: index + 1], deepcopy(parts[index]), *parts[index + 1 :]]


def _turned(parts: list[Any]) -> list[Any]:
    return parts[::-1]


def _and_landed(*block: int) -> Callable[[list[Any]], list[Any]]:
    more = {'ordered': [*block[:3]], 'landed': [[*block]], 'gone': []}
    return lambda seen: [*seen, more]


def _first_block(_: object) -> list[Any]:
    """The block that stands first in the record of a scoping trial."""
    return [TRUE['scoping']['placements'][0]]


def _in_decision(index: int, key: str, to: object) -> Lie:
    return put('decisions', index, key, to=to)


LIES: dict[str, tuple[str, Lie]] = {
    # Placements.
    'placement moved': ('scoping', put('observations', 1, 'landed', 0, 2, to=_more)),
    'row wrong': ('scoping', put('observations', 1, 'landed', 0, 3, to=_more)),
    'last row wrong': ('scoping', put('observations', -1, 'landed', 0, 3, to=_more)),
    'block off the board': ('scoping', put('observations', -1, 'landed', 0, 2, to=16)),
    'block exchanged': ('scoping', put('observations', -1, 'landed', 0, 0, to=2)),
    'block without width': ('scoping', put('observations', -1, 'landed', 0, 0, to=0)),
    'block without height': ('scoping', put('observations', -1, 'landed', 0, 1, to=0)),
    'first placement left out': ('scoping', _without('observations', 1)),
    'last placement left out': ('scoping', _without('observations', -1)),
    'placements in another order': (
        'scoping',
        put('observations', to=lambda seen: [seen[0], *seen[:0:-1]]),
    ),
    'placement added': ('scoping', put('observations', to=_and_landed(1, 2, 1, 4))),
    'placement added at the end': ('gave_up', put('observations', to=_and_landed(2, 2, 0, 4))),
    'nothing placed': ('scoping', put('observations', to=lambda seen: seen[:1])),
    'something placed on an empty silhouette': (
        'nothing',
        put('observations', to=_and_landed(1, 2, 0, 0)),
    ),
    'another order': ('scoping', put('observations', 1, 'ordered', 2, to=_more)),
    'nothing ordered': ('scoping', put('observations', 1, 'ordered', to=None)),
    'nothing landed': ('scoping', put('observations', 1, 'landed', to=[])),
    'landed twice': ('scoping', put('observations', 1, 'landed', to=_twice(0))),
    'gone, though glued': ('scoping', put('observations', 2, 'gone', to=_first_block)),
    'gone, though not there': ('scoping', put('observations', 1, 'gone', to=_first_block)),
    'found on the board': ('scoping', put('observations', 0, 'landed', to=_first_block)),
    'never seen': ('scoping', put('observations', to=[])),
    'block of no library': ('none', put('library', to='2x1')),
    # Status.
    'success as stuck': ('scoping', put('status', to='stuck')),
    'success as gave_up': ('scoping', put('status', to='gave_up')),
    'success as cancelled': ('scoping', put('status', to='cancelled')),
    'success as building': ('scoping', put('status', to='building')),
    'gave_up as success': ('gave_up', put('status', to='success')),
    'gave_up as stuck': ('gave_up', put('status', to='stuck')),
    'gave_up as cancelled': ('gave_up', put('status', to='cancelled')),
    'stuck as gave_up': ('stuck', put('status', to='gave_up')),
    'stuck as success': ('stuck', put('status', to='success')),
    'stuck as cancelled': ('stuck', put('status', to='cancelled')),
    'empty as stuck': ('nothing', put('status', to='stuck')),
    'cancelled as success': ('cancelled', put('status', to='success')),
    'cancelled as gave_up': ('cancelled', put('status', to='gave_up')),
    # Costs.
    'cost of a candidate': (
        'scoping',
        put('decisions', 0, 'candidates', 0, 'planning_cost', to=_more),
    ),
    'cost considered': ('scoping', _in_decision(0, 'subgoal_planning_cost', _more)),
    'cost considered, none': ('none', _in_decision(0, 'subgoal_planning_cost', _more)),
    'cost of a subgoal': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'planning_cost', to=_more),
    ),
    'cost of a subgoal, none': (
        'none',
        put('decisions', 0, 'subgoals', 0, 'planning_cost', to=_more),
    ),
    'cost of a subgoal, full': (
        'full',
        put('decisions', 0, 'subgoals', 1, 'planning_cost', to=_more),
    ),
    'cost of a candidate and considered': (
        'scoping',
        both(
            put('decisions', 0, 'candidates', 1, 'planning_cost', to=_more),
            _in_decision(0, 'subgoal_planning_cost', _more),
        ),
    ),
    'cost changed everywhere but in the value': (
        'scoping',
        both(
            put('decisions', 0, 'candidates', 2, 'planning_cost', to=_more),
            put('decisions', 0, 'subgoals', 0, 'planning_cost', to=_more),
            put('decisions', 0, 'subgoals', 0, 'solution_cost', to=_more),
            _in_decision(0, 'subgoal_planning_cost', _more),
        ),
    ),
    'solution dearer than planning': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'solution_cost', to=10**6),
    ),
    'plan without an attempt': ('scoping', put('decisions', 0, 'subgoals', 0, 'attempts', to=0)),
    # Decisions.
    'built': ('scoping', _in_decision(1, 'built', '0x1')),
    'sequence': ('scoping', _in_decision(1, 'sequence', _more)),
    'sequence, behind the end': ('scoping', _in_decision(1, 'sequence', 99)),
    'first decision left out': ('scoping', _without('decisions', 0)),
    'decision left out': ('scoping', _without('decisions', 1)),
    'last decision left out': ('scoping', _without('decisions', -1)),
    'last decision left out, full': ('full', _without('decisions', 0)),
    'no decision, none': ('none', put('decisions', to=[])),
    'giving up left out': ('gave_up', _without('decisions', -1)),
    'decision twice': ('scoping', put('decisions', to=_twice(1))),
    'decision twice, action': ('action', put('decisions', to=_twice(1))),
    'giving up twice': ('gave_up', put('decisions', to=_twice(1))),
    'decisions in another order': ('scoping', put('decisions', to=_turned)),
    'executed, none of it': ('scoping', _in_decision(0, 'executed', 0)),
    'executed, one less': ('full', _in_decision(0, 'executed', _less)),
    'executed, one more': ('full', _in_decision(0, 'executed', _more)),
    'executed, though gave up': ('gave_up', _in_decision(-1, 'executed', 1)),
    # Candidates.
    'value': ('scoping', put('decisions', 0, 'candidates', 1, 'value', to=lambda v: v + 1e-9)),
    'value of the best': ('scoping', put('decisions', 0, 'candidates', 2, 'value', to=99.5)),
    'value of an unsolved one': ('scoping', put('decisions', 0, 'candidates', 0, 'value', to=0.5)),
    'no value': ('scoping', put('decisions', 0, 'candidates', 1, 'value', to=None)),
    'value, none': ('none', put('decisions', 0, 'candidates', 0, 'value', to=1.0)),
    'value, full': ('full', put('decisions', 0, 'candidates', -1, 'value', to=1.0)),
    'cells': ('scoping', put('decisions', 0, 'candidates', 1, 'cells', to=_more)),
    'cells of an unsolved one': (
        'scoping',
        put('decisions', 0, 'candidates', 0, 'cells', to=_more),
    ),
    'cells, none': ('none', put('decisions', 0, 'candidates', 0, 'cells', to=_less)),
    'region': ('scoping', put('decisions', 0, 'candidates', 1, 'regions', to=[3])),
    'label': ('scoping', put('decisions', 0, 'regions', 1, 'label', to={'rows': 5})),
    'label of another kind': ('scoping', put('decisions', 0, 'regions', 1, 'label', to={'x': 2})),
    'cells of a region': ('scoping', put('decisions', 0, 'regions', 1, 'cells', to='0x1')),
    'probability': ('scoping', put('decisions', 0, 'candidates', 1, 'probability', to=0.5)),
    'sequences': ('scoping', _in_decision(0, 'sequences', _less)),
    'sequences, more': ('scoping', _in_decision(0, 'sequences', _more)),
    'no regions': ('scoping', put('decisions', 0, 'candidates', 1, 'regions', to=[])),
    'regions fall': ('full', put('decisions', 0, 'candidates', 21, 'regions', to=_turned)),
    'solved as unsolved': (
        'scoping',
        both(
            put('decisions', 0, 'candidates', 1, 'status', to='budget_exhausted'),
            put('decisions', 0, 'candidates', 1, 'value', to=None),
            put('decisions', 0, 'candidates', 2, 'status', to='budget_exhausted'),
            put('decisions', 0, 'candidates', 2, 'value', to=None),
        ),
    ),
    'candidate cancelled': (
        'scoping',
        put('decisions', 0, 'candidates', 0, 'status', to='cancelled'),
    ),
    'loser left out': (
        'scoping',
        both(
            _in_decision(
                0,
                'subgoal_planning_cost',
                lambda cost: (
                    cost - TRUE['scoping']['decisions'][0]['candidates'][-1]['planning_cost']
                ),
            ),
            _without('decisions', 0, 'candidates', -1),
        ),
    ),
    'no candidates': (
        'gave_up',
        both(_in_decision(-1, 'candidates', []), _in_decision(-1, 'subgoal_planning_cost', 0)),
    ),
    'chosen is not the best': ('scoping', _in_decision(0, 'chosen', 1)),
    'chosen is unsolved': ('scoping', _in_decision(0, 'chosen', 0)),
    'chosen is not there': ('scoping', _in_decision(0, 'chosen', 99)),
    'chosen is not there, full': ('full', _in_decision(0, 'chosen', 32)),
    'nothing chosen': ('scoping', _in_decision(0, 'chosen', None)),
    'chosen, though gave up': ('gave_up', _in_decision(-1, 'chosen', 0)),
    # Subgoals.
    'no subgoal': ('scoping', _in_decision(0, 'subgoals', [])),
    'subgoal left out': ('full', _without('decisions', 0, 'subgoals', 1)),
    'subgoal not executed left out': ('full', _without('decisions', 0, 'subgoals', -1)),
    'subgoals in another order': ('full', _in_decision(0, 'subgoals', _turned)),
    'plan in another order': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', to=_turned),
    ),
    'plan not followed': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', to=lambda p: [p[1], p[0], *p[2:]]),
    ),
    'plan cut': ('scoping', _without('decisions', 0, 'subgoals', 0, 'placements', -1)),
    'plan in the air': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', -1, 3, to=_more),
    ),
    'plan of nothing': ('scoping', put('decisions', 0, 'subgoals', 0, 'placements', to=[])),
    'rest of a plan': (
        'action',
        put('decisions', 0, 'subgoals', 0, 'placements', to=lambda p: [p[0], *p[:0:-1]]),
    ),
    'target': ('scoping', put('decisions', 0, 'subgoals', 0, 'target', to='0x1')),
    'region of a subgoal': ('scoping', put('decisions', 0, 'subgoals', 0, 'region', to=_more)),
    'execute less': ('scoping', put('decisions', 0, 'subgoals', 0, 'execute', to=_less)),
    'execute less at the end': (
        'scoping',
        put('decisions', -1, 'subgoals', 0, 'execute', to=_less),
    ),
    'execute more': ('scoping', put('decisions', 0, 'subgoals', 0, 'execute', to=_more)),
    'execute more, action': ('action', put('decisions', 0, 'subgoals', 0, 'execute', to=_more)),
    'execute nothing': ('scoping', put('decisions', 0, 'subgoals', 0, 'execute', to=0)),
}


@pytest.mark.parametrize('name', TRUE)
def test_what_is_lied_about_is_true_at_first(name: str) -> None:
    assert found(deepcopy(TRUE[name])) == []


@pytest.mark.parametrize('lie', LIES)
def test_lie_is_found(lie: str) -> None:
    name, tell = LIES[lie]
    data = deepcopy(TRUE[name])
    tell(data)
    assert data != TRUE[name]
    assert found(data)


@pytest.mark.parametrize(
    ('lie', 'sentence'),
    [
        ('row wrong', 'observation 1: the outcome differs'),
        ('gone, though not there', 'observation 1: block '),
        ('found on the board', 'observation 0 differs from the board'),
        ('gave_up as success', "status 'success', but"),
        ('built', 'decision 1: built is 0x1, which is not the state'),
        ('value', 'decision 0: candidate 1: expected value'),
        ('cells', 'decision 0: candidate 1: expected cells 4, got 5'),
        (
            'chosen is not the best',
            'decision 0: candidate 1 is chosen, but the strategy chooses 2',
        ),
        ('cost considered', 'decision 0: expected subgoal_planning_cost'),
        ('plan not followed', 'decision 0: subgoal 0: observation 1 has an order'),
    ],
)
def test_sentence_says_what_contradicts(lie: str, sentence: str) -> None:
    name, tell = LIES[lie]
    data = deepcopy(TRUE[name])
    tell(data)
    assert any(said.startswith(sentence) for said in found(data))


def test_tie_that_was_drawn_otherwise_is_found() -> None:
    drawn = {
        seed: record_json(SQUARE, strategy='full', search='random', library='1x1', seed=seed)
        for seed in range(8)
    }
    chosen = {seed: data['decisions'][0]['chosen'] for seed, data in drawn.items()}
    other = next(seed for seed in drawn if chosen[seed] != chosen[0])
    drawn[0]['seed'] = other
    assert found(drawn[0])


# Only a rerun can know.


@pytest.mark.parametrize(
    ('lie', 'keys'),
    [
        pytest.param(
            both(
                put('decisions', 0, 'candidates', 0, 'planning_cost', to=_more),
                put('decisions', 0, 'subgoals', 0, 'planning_cost', to=_more),
                put('decisions', 0, 'subgoals', 0, 'solution_cost', to=_more),
            ),
            {'action_planning_cost', 'solution_cost', 'decisions'},
            id='cost changed everywhere',
        ),
        pytest.param(
            put('seed', to=2), {'placements', 'observations', 'decisions'}, id='another seed'
        ),
    ],
)
def test_rerun_finds_what_is_consistent_but_not_true(lie: Lie, keys: set[str]) -> None:
    data = record_json(CHAIR, strategy='none', depth=2, seed=0)
    lie(data)
    lied = record_from_json(remade(data), 'x')
    assert list(contradictions(lied)) == []
    said = set(differs_from_rerun(lied))
    assert {f'a new run gives another value of {key}' for key in keys} <= said


def test_cancelled_record_is_not_run_again() -> None:
    cancelled = cancelled_record(spec(CHAIR), 5)
    assert list(differs_from_rerun(cancelled)) == []
    as_success = replace(cancelled, status=TrialStatus.SUCCESS)
    assert list(differs_from_rerun(as_success)) != []
