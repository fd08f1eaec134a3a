"""What the page gets to see."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import reduce
from itertools import groupby
from typing import Any

import pytest
from builders import CHAIR, NEVER_SOLVED, spec
from heard_trials import Heard, heard, human_spec, person_says

from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import ProposalMade, TrialStarted
from blocks_planning.view.scene import last_scene, scenes_of
from blocks_planning.view.web import pictures
from blocks_planning.view.web.frame import Seen, frame_json
from blocks_planning.view.web.health import NOTHING, health_after
from blocks_planning.view.web.queue import Queue
from blocks_planning.view.web.session import Past, Session, session_after

COSTLY = {
    'action_cost',
    'subgoal_cost',
    'cost',
    'value',
    'candidates',
    'decision',
    'decisions',
    'curve',
}
"""Keys that say something of what was evaluated."""


def frames_of(trial: Heard) -> list[Any]:
    """What the page gets after each message."""
    session, found = Session(), []
    for message in trial.messages:
        session = session_after(session, message)
        found.append(json.loads(json.dumps(frame_json(Seen(session), 0.0), allow_nan=False)))
    return found


def replay_of(trial: Heard) -> Any:
    past = Past(0, last_scene(trial.record))
    return json.loads(json.dumps(pictures.replay_json(past, hidden=False), allow_nan=False))


def told(json_value: Any) -> set[str]:
    """The keys, anywhere, that have something to say."""
    if isinstance(json_value, dict):
        own = {key for key, value in json_value.items() if value not in (None, [], {})}
        return own.union(*map(told, json_value.values())) if json_value else own
    if isinstance(json_value, list):
        return set().union(*map(told, json_value))
    return set()


def numbers(json_value: Any) -> set[float]:
    """All numbers, anywhere."""
    if isinstance(json_value, dict):
        return set().union(*map(numbers, json_value.values()))
    if isinstance(json_value, list):
        return set().union(*map(numbers, json_value))
    is_number = isinstance(json_value, (int, float)) and not isinstance(json_value, bool)
    return {json_value} if is_number else set()


@pytest.mark.parametrize('name', ['scoped', 'by_person'])
def test_replay_has_every_scene(name: str, request: pytest.FixtureRequest) -> None:
    trial: Heard = request.getfixturevalue(name)
    replay, board = replay_of(trial), trial.spec.task.board
    scenes = list(scenes_of(trial.record))
    assert len(replay['steps']) == len(scenes)
    assert len(replay['all_blocks']) == trial.record.blocks
    for step, scene in zip(replay['steps'], scenes, strict=True):
        assert step['sequence'] == len(scene.placements)
        assert step['standing'] == list(range(len(scene.placements)))
        region = 0 if step['region'] is None else board.parse(step['region'])
        assert region == scene.region
        planned = board.mask(
            (column + x, row + y)
            for width, height, column, row in step['planned']
            for x in range(width)
            for y in range(height)
        )
        assert planned == scene.region
        assert step['action_cost'] == scene.record.action_planning_cost
        assert step['subgoal_cost'] == scene.record.subgoal_planning_cost
        if scene.decision is not None:
            shown = replay['decisions'][step['entry']]
            assert [one['cost'] for one in shown['candidates']] == [
                one.planning_cost for one in scene.decision.candidates
            ]
    assert replay['curve'][-1][1:] == [
        trial.record.action_planning_cost,
        trial.record.subgoal_planning_cost,
    ]


def test_live_and_replay_show_the_same(scoped: Heard) -> None:
    """Every step of the replay was seen live."""
    live = [frame['step'] for frame in frames_of(scoped)]
    assert all(step in live for step in replay_of(scoped)['steps'])
    assert frames_of(scoped)[-1]['all_blocks'] == replay_of(scoped)['all_blocks']


def test_what_was_weighed_is_told_with_its_winner(scoped: Heard) -> None:
    decision = scoped.record.decisions[0].decision
    shown = pictures.decision_json(decision, hidden=False)
    assert shown is not None
    assert shown['total'] == len(decision.candidates)
    assert [one['value'] for one in shown['candidates']] == [
        one.value for one in decision.candidates
    ]
    assert [one['chosen'] for one in shown['candidates']].index(True) == decision.chosen


def test_a_planner_that_gives_up_is_shown() -> None:
    trial = heard(spec(NEVER_SOLVED))
    last = frames_of(trial)[-1]
    assert last['step']['word'] == 'gave up'
    assert last['step']['region'] is None
    assert not any(one['chosen'] for one in last['decision']['candidates'])


def test_phases(by_person: Heard) -> None:
    frames = frames_of(by_person)
    assert frame_json(Seen(), 0.0)['phase'] == 'waiting'
    assert {frame['phase'] for frame in frames[:-1]} == {'running'}
    assert (frames[-1]['phase'], frames[-1]['past']) == ('between', 1)


def test_what_became_of_each_proposal_is_told(by_person: Heard) -> None:
    outcomes = [[one['outcome'] for one in frame['proposals']] for frame in frames_of(by_person)]
    distinct = [one for one, _ in groupby(outcomes)]
    assert distinct == [
        [],
        ['withdrawn'],
        ['withdrawn', 'searching'],
        ['withdrawn', 'failed'],
        ['withdrawn', 'failed', 'searching'],
        ['withdrawn', 'failed', 'built'],
        ['withdrawn', 'failed', 'built', 'searching'],
        ['withdrawn', 'failed', 'built', 'built'],
    ]
    said = frames_of(by_person)[-1]['proposals']
    assert [one['cells'] for one in said] == [16, 1, 12, 4]
    assert all(one['cost'] >= 0 for one in said[1:])


def test_what_was_proposed_before_the_page_was_there_is_told(by_person: Heard) -> None:
    """From the decisions that it led to."""
    seen = [m for m in by_person.messages if isinstance(m, (TrialStarted, SubgoalChosen))]
    frame = frame_json(Seen(reduce(session_after, seen, Session())), 0.0)
    assert [one['outcome'] for one in frame['proposals']] == [
        'withdrawn',
        'failed',
        'built',
        'built',
    ]


# Costs that a person must not see


def test_hidden_costs_are_in_nothing_that_is_sent(hidden: Heard, by_person: Heard) -> None:
    """By key, and by number: those that the same trial shows if they are not hidden."""
    health = health_after(NOTHING, 'action_searcher', 0, '5 states', [('evaluated', '5')], 0.0)
    session = reduce(session_after, hidden.messages, Session())
    sent = [
        *frames_of(hidden),
        replay_of(hidden),
        pictures.summary_json(Past(0, last_scene(hidden.record)), hidden=False),
        frame_json(Seen(session, health), 0.0),
    ]
    shown = [*frames_of(by_person), replay_of(by_person)]
    assert told(shown) >= COSTLY - {'value'}
    assert not told(sent) & COSTLY
    costs = {
        by_person.record.action_planning_cost,
        by_person.record.subgoal_planning_cost,
        *(e.decision.subgoal_planning_cost for e in by_person.record.decisions),
    }
    assert costs <= numbers(shown)
    large = {cost for cost in costs if cost > 24}
    assert large
    assert not large & numbers(sent)
    assert '5 states' not in json.dumps(sent)
    assert 'evaluated' not in json.dumps(sent)


def test_other_trials_hide_their_costs_too_while_one_does(scoped: Heard) -> None:
    past = Past(0, last_scene(scoped.record))
    assert told(pictures.summary_json(past, hidden=False)) & COSTLY
    assert not told(pictures.summary_json(past, hidden=True)) & COSTLY
    assert not told(pictures.replay_json(past, hidden=True)) & COSTLY


def test_a_name_is_sent_as_it_is() -> None:
    """The page shows it as text; nothing is made of it on the way."""
    name = '<img src=x onerror=alert(1)>'
    trial = spec(CHAIR, stimulus=name)
    assert pictures.trial_json(trial, 'x')['stimulus'] == name


# The queue


def test_place_in_a_script() -> None:
    specs = [spec(CHAIR, seed=seed) for seed in range(8)]
    queue = Queue(specs)
    assert queue.place_of(None) == (None, 8, tuple(specs[:5]))
    assert queue.place_of(specs[0].trial_id) == (0, 8, tuple(specs[1:6]))
    assert queue.place_of(specs[6].trial_id) == (6, 8, (specs[7],))
    assert queue.place_of('a goal') == (None, 8, tuple(specs[6:]))
    assert queue.place_of(specs[1].trial_id) == (1, 8, tuple(specs[2:7]))
    assert Queue().place_of('x') == (None, 0, ())


def test_place_is_in_the_frame(scoped: Heard) -> None:
    other = replace(scoped.spec, seed=9)
    place = Queue([scoped.spec, other]).place_of(scoped.spec.trial_id)
    session = reduce(session_after, scoped.messages, Session())
    frame = frame_json(Seen(session, NOTHING, place), 0.0)
    assert (frame['index'], frame['total']) == (0, 2)
    assert [one['stimulus'] for one in frame['coming']] == [other.stimulus]


def test_a_trial_of_a_person_says_who_it_is() -> None:
    trial = human_spec(participant='P07', costs='hidden')
    shown = pictures.trial_json(trial, 'x')
    assert (shown['person'], shown['participant'], shown['costs_hidden']) == (True, 'P07', True)
    assert not pictures.trial_json(spec(CHAIR), 'x')['person']


def test_proposals_are_in_the_replay(by_person: Heard) -> None:
    board = by_person.spec.task.board
    said = [m.proposal for m in by_person.messages if isinstance(m, ProposalMade)]
    assert said == list(person_says(by_person.spec))
    shown = replay_of(by_person)['proposals']
    assert [board.parse(one['region']) for one in shown] == [p.region for p in said]
    assert [one['thinking'] for one in shown] == [p.thinking_s for p in said]
