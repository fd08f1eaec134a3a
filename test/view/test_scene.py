from __future__ import annotations

from functools import reduce

import pytest
from builders import CHAIR, NEVER_SOLVED, cancelled_record, spec
from hypothesis import given, settings
from hypothesis import strategies as st

from blocks_planning.board.blocks import PAPER_LIBRARY, Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.registry import STRATEGIES, make_strategy
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, TrialEnded, TrialStarted, WorldState
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.scene import (
    Scene,
    first_scene,
    last_scene,
    scene_after,
    scene_of,
    scenes_of,
)

OWN_STRATEGIES = sorted(name for name, cls in STRATEGIES.items() if not cls.is_external)


def watched(spec: TrialSpec) -> tuple[list[Message], list[Scene], TrialRecord]:
    """The messages of a trial, the scene after each, and the record."""
    messages: list[Message] = []
    scenes: list[Scene] = []

    def observe(message: Message) -> None:
        messages.append(message)
        scenes.append(scene_after(scenes[-1] if scenes else scene_of(spec), message))

    return messages, scenes, run_trial(spec, observe=observe)


def at_placements(scenes: list[Scene]) -> list[Scene]:
    before = [scenes[0], *scenes]
    return [
        scene
        for last, scene in zip(before, scenes, strict=False)
        if len(scene.placements) > len(last.placements)
    ]


def assert_replay_agrees(spec: TrialSpec) -> None:
    _, live, record = watched(spec)
    replayed = list(scenes_of(record))
    assert at_placements(replayed) == at_placements(live)
    assert len(at_placements(replayed)) == record.blocks
    assert replayed[-1] == live[-1]


@pytest.mark.parametrize('number', [2, 5, 9])
@pytest.mark.parametrize('search', ['bfs', 'random'])
@pytest.mark.parametrize('strategy', OWN_STRATEGIES)
def test_replay_agrees_with_what_was_seen(tower_spec, strategy, search, number):
    assert_replay_agrees(tower_spec(number, strategy, search))


def test_replay_agrees_if_every_action_is_decided_anew(tower_spec):
    assert_replay_agrees(tower_spec(commit='action'))


@settings(max_examples=60, deadline=None)
@given(
    data=st.data(),
    width=st.integers(1, 6),
    height=st.integers(1, 6),
    strategy=st.sampled_from(OWN_STRATEGIES),
    library=st.sampled_from([PAPER_LIBRARY, (Block(1, 1), *PAPER_LIBRARY)]),
)
def test_replay_agrees_on_any_silhouette(data, width, height, strategy, library):
    board = Board(width, height)
    task = Task(board, data.draw(st.integers(0, board.full)), library)
    search = make_search('random', {})
    assert_replay_agrees(TrialSpec('any', task, make_strategy(strategy, {}), search, budget=50))


@pytest.mark.parametrize('strategy', OWN_STRATEGIES)
def test_last_scene_has_the_sums_of_the_record(tower_spec, recorded, strategy):
    record = recorded(tower_spec(5, strategy))
    scene = last_scene(record)
    assert [block.placed for block in scene.blocks] == list(record.placements)
    assert scene.record == record
    assert scene.subgoal is None
    assert scene.region == 0


def test_blocks_belong_to_the_subgoal_that_planned_them(tower_spec, recorded):
    record = recorded(tower_spec(14, 'full'))
    planned = [
        index
        for index, subgoal in enumerate(record.executed_subgoals())
        for _ in range(subgoal.execute)
    ]
    assert record.status is TrialStatus.SUCCESS
    assert record.subgoals > 2
    assert [block.subgoal for block in last_scene(record).blocks] == planned


def test_there_is_a_scene_for_everything_that_happens(tower_spec, recorded):
    record = recorded(tower_spec(9, 'scoping'))
    scenes = list(scenes_of(record))
    assert scenes[0] == scene_of(record.spec)
    assert len(scenes) == 1 + record.subgoals + record.blocks + 1
    assert all(scene.status is TrialStatus.BUILDING for scene in scenes[:-2])
    regions = [scene.subgoal.target for scene in scenes if scene.subgoal]
    assert set(regions) == {subgoal.target for subgoal in record.executed_subgoals()}


def test_giving_up_is_a_scene(recorded):
    record = recorded(spec(NEVER_SOLVED))
    assert record.status is TrialStatus.GAVE_UP
    scenes = list(scenes_of(record))
    assert [scene.decision is None for scene in scenes] == [True, False, False]
    assert scenes[-1].blocks == ()


def test_region_is_what_the_subgoal_has_left_to_fill(tower_spec, recorded):
    record = recorded(tower_spec())
    for scene in scenes_of(record):
        if scene.subgoal:
            assert scene.region & scene.built == 0
            assert scene.region | scene.built == scene.subgoal.target | scene.built
        assert scene.built & ~scene.task.silhouette == 0


@pytest.mark.parametrize('strategy', ['scoping', 'full'])
def test_replay_of_a_trial_that_was_cancelled_anywhere_gives_its_record(strategy):
    trial = spec(CHAIR, strategy=strategy)
    messages, _, whole = watched(trial)
    for count in range(1, len(messages)):
        record = cancelled_record(trial, count)
        # Who cancels when the last block lies is too late.
        over = record.placements == whole.placements
        assert record.status is (whole.status if over else TrialStatus.CANCELLED)
        assert last_scene(record).record == record


def test_what_is_doubled_stale_or_foreign_changes_nothing(tower_spec):
    messages, scenes, _ = watched(tower_spec())
    _, _, other = watched(tower_spec(5))
    foreign = SubgoalChosen(other.spec.trial_id, 99, other.decisions)
    stale = next(one for one in messages if isinstance(one, WorldState) and one.sequence == 1)
    for message, scene in zip(messages, scenes, strict=True):
        assert scene_after(scene, message) is scene
        if scene.placements:
            assert scene_after(scene, stale) is scene
        assert scene_after(scene, foreign) is scene
        assert scene_after(scene, TrialEnded(other.spec.trial_id, other.status)) is scene


def test_another_trial_clears_the_scene(tower_spec):
    _, scenes, record = watched(tower_spec())
    again = TrialStarted('a second run', record.spec)
    assert scene_after(scenes[-1], again) == first_scene(again)


def test_the_order_of_states_and_subgoals_does_not_matter(tower_spec):
    """Messages of different kinds may overtake one another, and some may get lost."""
    messages, scenes, record = watched(tower_spec())
    states = [message for message in messages if isinstance(message, WorldState)]
    chosen = [message for message in messages if isinstance(message, SubgoalChosen)]
    orders: list[list[Message]] = [
        [*chosen, *states],
        [*states, *chosen],
        [states[-1], chosen[-1]],
    ]
    for some in orders:
        scene = reduce(scene_after, [*some, messages[-1]], scene_of(record.spec))
        assert scene == scenes[-1]
        assert scene.blocks == scenes[-1].blocks
