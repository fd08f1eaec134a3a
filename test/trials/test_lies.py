"""Lies in records are found."""

from __future__ import annotations

from copy import deepcopy

import pytest
from builders import SQUARE, record_json
from lies import (
    TRUE,
    Lie,
    and_landed,
    both,
    first_block,
    found,
    in_decision,
    one_less,
    one_more,
    put,
    turned,
    twice,
    without,
)

LIES: dict[str, tuple[str, Lie]] = {
    # Placements.
    'placement moved': ('scoping', put('observations', 1, 'landed', 0, 2, to=one_more)),
    'row wrong': ('scoping', put('observations', 1, 'landed', 0, 3, to=one_more)),
    'last row wrong': ('scoping', put('observations', -1, 'landed', 0, 3, to=one_more)),
    'block off the board': ('scoping', put('observations', -1, 'landed', 0, 2, to=16)),
    'block exchanged': ('scoping', put('observations', -1, 'landed', 0, 0, to=2)),
    'block without width': ('scoping', put('observations', -1, 'landed', 0, 0, to=0)),
    'block without height': ('scoping', put('observations', -1, 'landed', 0, 1, to=0)),
    'first placement left out': ('scoping', without('observations', 1)),
    'last placement left out': ('scoping', without('observations', -1)),
    'placements in another order': (
        'scoping',
        put('observations', to=lambda seen: [seen[0], *seen[:0:-1]]),
    ),
    'placement added': ('scoping', put('observations', to=and_landed(1, 2, 1, 4))),
    'placement added at the end': ('gave_up', put('observations', to=and_landed(2, 2, 0, 4))),
    'nothing placed': ('scoping', put('observations', to=lambda seen: seen[:1])),
    'something placed on an empty silhouette': (
        'nothing',
        put('observations', to=and_landed(1, 2, 0, 0)),
    ),
    'another order': ('scoping', put('observations', 1, 'ordered', 2, to=one_more)),
    'nothing ordered': ('scoping', put('observations', 1, 'ordered', to=None)),
    'nothing landed': ('scoping', put('observations', 1, 'landed', to=[])),
    'landed twice': ('scoping', put('observations', 1, 'landed', to=twice(0))),
    'gone, though glued': ('scoping', put('observations', 2, 'gone', to=first_block)),
    'gone, though not there': ('scoping', put('observations', 1, 'gone', to=first_block)),
    'found on the board': ('scoping', put('observations', 0, 'landed', to=first_block)),
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
        put('decisions', 0, 'candidates', 0, 'planning_cost', to=one_more),
    ),
    'cost considered': ('scoping', in_decision(0, 'subgoal_planning_cost', one_more)),
    'cost considered, none': ('none', in_decision(0, 'subgoal_planning_cost', one_more)),
    'cost of a subgoal': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'planning_cost', to=one_more),
    ),
    'cost of a subgoal, none': (
        'none',
        put('decisions', 0, 'subgoals', 0, 'planning_cost', to=one_more),
    ),
    'cost of a subgoal, full': (
        'full',
        put('decisions', 0, 'subgoals', 1, 'planning_cost', to=one_more),
    ),
    'cost of a candidate and considered': (
        'scoping',
        both(
            put('decisions', 0, 'candidates', 1, 'planning_cost', to=one_more),
            in_decision(0, 'subgoal_planning_cost', one_more),
        ),
    ),
    'cost changed everywhere but in the value': (
        'scoping',
        both(
            put('decisions', 0, 'candidates', 2, 'planning_cost', to=one_more),
            put('decisions', 0, 'subgoals', 0, 'planning_cost', to=one_more),
            put('decisions', 0, 'subgoals', 0, 'solution_cost', to=one_more),
            in_decision(0, 'subgoal_planning_cost', one_more),
        ),
    ),
    'solution dearer than planning': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'solution_cost', to=10**6),
    ),
    'plan without an attempt': ('scoping', put('decisions', 0, 'subgoals', 0, 'attempts', to=0)),
    # Decisions.
    'built': ('scoping', in_decision(1, 'built', '0x1')),
    'sequence': ('scoping', in_decision(1, 'sequence', one_more)),
    'sequence, behind the end': ('scoping', in_decision(1, 'sequence', 99)),
    'first decision left out': ('scoping', without('decisions', 0)),
    'decision left out': ('scoping', without('decisions', 1)),
    'last decision left out': ('scoping', without('decisions', -1)),
    'last decision left out, full': ('full', without('decisions', 0)),
    'no decision, none': ('none', put('decisions', to=[])),
    'giving up left out': ('gave_up', without('decisions', -1)),
    'decision twice': ('scoping', put('decisions', to=twice(1))),
    'decision twice, action': ('action', put('decisions', to=twice(1))),
    'giving up twice': ('gave_up', put('decisions', to=twice(1))),
    'decisions in another order': ('scoping', put('decisions', to=turned)),
    'executed, none of it': ('scoping', in_decision(0, 'executed', 0)),
    'executed, one less': ('full', in_decision(0, 'executed', one_less)),
    'executed, one more': ('full', in_decision(0, 'executed', one_more)),
    'executed, though gave up': ('gave_up', in_decision(-1, 'executed', 1)),
    # Candidates.
    'value': ('scoping', put('decisions', 0, 'candidates', 1, 'value', to=lambda v: v + 1e-9)),
    'value of the best': ('scoping', put('decisions', 0, 'candidates', 2, 'value', to=99.5)),
    'value of an unsolved one': ('scoping', put('decisions', 0, 'candidates', 0, 'value', to=0.5)),
    'no value': ('scoping', put('decisions', 0, 'candidates', 1, 'value', to=None)),
    'value, none': ('none', put('decisions', 0, 'candidates', 0, 'value', to=1.0)),
    'value, full': ('full', put('decisions', 0, 'candidates', -1, 'value', to=1.0)),
    'cells': ('scoping', put('decisions', 0, 'candidates', 1, 'cells', to=one_more)),
    'cells of an unsolved one': (
        'scoping',
        put('decisions', 0, 'candidates', 0, 'cells', to=one_more),
    ),
    'cells, none': ('none', put('decisions', 0, 'candidates', 0, 'cells', to=one_less)),
    'region': ('scoping', put('decisions', 0, 'candidates', 1, 'regions', to=[3])),
    'label': ('scoping', put('decisions', 0, 'regions', 1, 'label', to={'rows': 5})),
    'label of another kind': ('scoping', put('decisions', 0, 'regions', 1, 'label', to={'x': 2})),
    'cells of a region': ('scoping', put('decisions', 0, 'regions', 1, 'cells', to='0x1')),
    'probability': ('scoping', put('decisions', 0, 'candidates', 1, 'probability', to=0.5)),
    'sequences': ('scoping', in_decision(0, 'sequences', one_less)),
    'sequences, more': ('scoping', in_decision(0, 'sequences', one_more)),
    'no regions': ('scoping', put('decisions', 0, 'candidates', 1, 'regions', to=[])),
    'regions fall': ('full', put('decisions', 0, 'candidates', 21, 'regions', to=turned)),
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
            in_decision(
                0,
                'subgoal_planning_cost',
                lambda cost: (
                    cost - TRUE['scoping']['decisions'][0]['candidates'][-1]['planning_cost']
                ),
            ),
            without('decisions', 0, 'candidates', -1),
        ),
    ),
    'no candidates': (
        'gave_up',
        both(in_decision(-1, 'candidates', []), in_decision(-1, 'subgoal_planning_cost', 0)),
    ),
    'chosen is not the best': ('scoping', in_decision(0, 'chosen', 1)),
    'chosen is unsolved': ('scoping', in_decision(0, 'chosen', 0)),
    'chosen is not there': ('scoping', in_decision(0, 'chosen', 99)),
    'chosen is not there, full': ('full', in_decision(0, 'chosen', 32)),
    'nothing chosen': ('scoping', in_decision(0, 'chosen', None)),
    'chosen, though gave up': ('gave_up', in_decision(-1, 'chosen', 0)),
    # Subgoals.
    'no subgoal': ('scoping', in_decision(0, 'subgoals', [])),
    'subgoal left out': ('full', without('decisions', 0, 'subgoals', 1)),
    'subgoal not executed left out': ('full', without('decisions', 0, 'subgoals', -1)),
    'subgoals in another order': ('full', in_decision(0, 'subgoals', turned)),
    'plan in another order': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', to=turned),
    ),
    'plan not followed': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', to=lambda p: [p[1], p[0], *p[2:]]),
    ),
    'plan cut': ('scoping', without('decisions', 0, 'subgoals', 0, 'placements', -1)),
    'plan in the air': (
        'scoping',
        put('decisions', 0, 'subgoals', 0, 'placements', -1, 3, to=one_more),
    ),
    'plan of nothing': ('scoping', put('decisions', 0, 'subgoals', 0, 'placements', to=[])),
    'rest of a plan': (
        'action',
        put('decisions', 0, 'subgoals', 0, 'placements', to=lambda p: [p[0], *p[:0:-1]]),
    ),
    'target': ('scoping', put('decisions', 0, 'subgoals', 0, 'target', to='0x1')),
    'region of a subgoal': ('scoping', put('decisions', 0, 'subgoals', 0, 'region', to=one_more)),
    'execute less': ('scoping', put('decisions', 0, 'subgoals', 0, 'execute', to=one_less)),
    'execute less at the end': (
        'scoping',
        put('decisions', -1, 'subgoals', 0, 'execute', to=one_less),
    ),
    'execute more': ('scoping', put('decisions', 0, 'subgoals', 0, 'execute', to=one_more)),
    'execute more, action': ('action', put('decisions', 0, 'subgoals', 0, 'execute', to=one_more)),
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
