"""Every node by itself, with a peer in another context that talks to it and listens."""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from builders import ended
from part_nodes import (
    FIRST_ASKED,
    FOREIGN,
    HEARD,
    PART_IDS,
    PARTS,
    RECORD,
    TRIAL_SPEC,
    WITHOUT_REMINDERS,
    bench,
    by_topic,
    each_part,
    for_node,
    foreign,
    of_node,
    started,
)
from peers import Bench, Graph, Peer
from rclpy.parameter import Parameter

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.wire.graph import ACTION_SEARCHER, SUBGOAL_SELECTOR, WORLD, NodeTopics
from blocks_planning.ros.wire.topics import (
    ACTION,
    HOLD,
    OUTCOME,
    SEARCH_REQUEST,
    STATE,
    TOPICS,
    TRIAL,
)
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import PlaceBlock, SearchAnswer, SearchRequest, WorldState

KINDS = {topic.kind: topic for topic in TOPICS}


# What it says to what it hears


@each_part
def test_says_what_its_part_says(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    on = bench(graph, topics, make_node)
    on.tell(*for_node(topics))
    expected = of_node(topics)
    assert by_topic(on.hear(len(expected))) == by_topic(expected)


@each_part
def test_ignores_what_is_stale_doubled_or_foreign(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    """A question that is asked again is answered again, and just that."""
    on = bench(graph, topics, make_node)
    heard, expected = for_node(topics), of_node(topics)
    on.tell(*heard)
    on.hear(len(expected))
    memory = on.node.memory
    again = [message for message in heard if not isinstance(message, SearchRequest)]
    on.tell(*again, *map(foreign, heard[1:]), *reversed(again))
    assert on.node.memory == memory
    assert by_topic(on.hear(len(expected))) == by_topic(expected)
    if topics is ACTION_SEARCHER:
        asked = [message for message in heard if isinstance(message, SearchRequest)]
        on.tell(*asked)
        count = sum(len(request.queries) for request in asked)
        answers = on.hear(2 * count, SearchAnswer)
        assert by_topic(answers[count:]) == by_topic(answers[:count])


@each_part
def test_is_done_when_the_trial_is_over(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    on = bench(graph, topics, make_node)
    heard = for_node(topics)
    on.tell(*heard[: len(heard) // 2])
    outcome = OUTCOME.to_ros(None, ended(TRIAL_SPEC.trial_id, RECORD))
    on.peer.outlets[OUTCOME].publish(outcome)
    on.fence(OUTCOME)
    memory, said = on.node.memory, list(on.peer.heard)
    on.tell(*heard[1:])
    assert on.node.memory == memory
    assert len(on.peer.heard) <= len(said) + 1  # an answer may have been on its way


@each_part
def test_next_trial_begins_from_nothing(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    on = bench(graph, topics, make_node)
    heard, expected = for_node(topics), of_node(topics)
    on.tell(started(FOREIGN))
    on.tell(*heard)
    said = [message for message in expected if message.trial_id == TRIAL_SPEC.trial_id]
    graph.spin_until(
        lambda: len([m for m in on.peer.heard if m.trial_id == TRIAL_SPEC.trial_id]) >= len(said)
    )
    of_this = [m for m in on.peer.heard if m.trial_id == TRIAL_SPEC.trial_id]
    assert by_topic(of_this) == by_topic(said)


@each_part
def test_what_comes_before_its_trial_is_not_lost(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    """Topics are not ordered among each other."""
    on = bench(graph, topics, make_node)
    first, *rest = for_node(topics)
    for message in rest:
        on.peer.say(message)
    waiting = on.node._inbox._held
    graph.spin_until(lambda: sum(map(len, waiting.values())) == len(rest))
    assert on.peer.heard == []
    on.peer.say(first)
    said = by_topic(of_node(topics))
    expected = said
    if topics is WORLD:  # of states that come all at once the latest holds
        expected = {**said, WorldState: said[WorldState][-1:]}
    elif topics is SUBGOAL_SELECTOR:
        expected = {SearchRequest: list(FIRST_ASKED)}
    elif topics is ACTION_SEARCHER:  # of the placements only the last is still called for
        expected = {SearchAnswer: said[SearchAnswer]}
    wanted = {str(message) for messages in expected.values() for message in messages}
    graph.spin_until(lambda: wanted <= {str(m) for m in on.peer.only(*expected)})
    everything = {str(message) for messages in said.values() for message in messages}
    assert {str(message) for message in on.peer.heard} <= everything


@each_part
def test_finds_what_holds_when_it_comes_late(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    peer = graph.add(Peer, TRIAL_SPEC, topics.listens, topics.says)
    for message in HEARD[: len(HEARD) // 2]:
        topic = KINDS.get(type(message))
        if topic is not None and topic.latched and topic in topics.listens:
            peer.say(message)
    node = graph.add(make_node, **WITHOUT_REMINDERS)
    graph.spin_until(lambda: peer.heard)
    assert node.trial == started(TRIAL_SPEC)
    assert node.refused == 0


def test_world_shows_the_latest_board_to_who_comes_late(graph: Graph) -> None:
    on = bench(graph, WORLD, world.make_node)
    on.tell(*for_node(WORLD))
    states = on.hear(len(RECORD.placements) + 1, WorldState)
    late = graph.add(Peer, TRIAL_SPEC, (), (STATE,), name='late')
    graph.spin_until(lambda: late.heard)
    assert late.heard == states[-1:]


def test_world_says_why_a_block_can_not_be_placed(graph: Graph) -> None:
    on = bench(graph, WORLD, world.make_node)
    on.tell(started(TRIAL_SPEC), PlaceBlock(TRIAL_SPEC.trial_id, 0, Placement(Block(4, 2), 1)))
    state, outcome = on.hear(2)
    if isinstance(outcome, WorldState):
        state, outcome = outcome, state
    assert state.sequence == 0
    assert outcome.placed is None
    assert 'block 4x2 in column 1' in outcome.reason


def test_world_that_was_killed_finds_its_board(graph: Graph, tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    journal.begin(TRIAL_SPEC.trial_id)
    for seen in RECORD.observations[1:-1]:
        journal.append(seen)
    journal.release()
    overrides = [Parameter('journal_dir', value=str(tmp_path))]
    node = graph.add(world.make_node, parameter_overrides=overrides)
    on = Bench(graph, WORLD, node, TRIAL_SPEC)
    on.tell(started(TRIAL_SPEC))
    graph.spin_until(lambda: node.memory.state is not None)
    assert node.memory.state.placements == RECORD.placements[:-1]
    last = len(RECORD.placements) - 1
    on.tell(PlaceBlock(TRIAL_SPEC.trial_id, last, RECORD.placements[-1].placement))
    graph.spin_until(lambda: node.memory.state.sequence == last + 1)
    (path,) = tmp_path.glob('*.journal')
    again = Journal(tmp_path / 'copy')
    (tmp_path / 'copy' / path.name).write_bytes(path.read_bytes())
    assert again.begin(TRIAL_SPEC.trial_id) == (list(RECORD.observations[1:]), '')
    again.release()


def test_world_takes_its_time_to_place_a_block(graph: Graph) -> None:
    overrides = [Parameter('placing_s', value=0.2)]
    node = graph.add(world.make_node, parameter_overrides=overrides)
    on = Bench(graph, WORLD, node, TRIAL_SPEC)
    began = time.monotonic()
    on.tell(
        started(TRIAL_SPEC), PlaceBlock(TRIAL_SPEC.trial_id, 0, RECORD.placements[0].placement)
    )
    graph.spin_until(lambda: node.memory.state is not None and node.memory.state.sequence == 1)
    assert time.monotonic() - began >= 0.2
    assert node.memory.state.placements == RECORD.placements[:1]


def test_selector_asks_again_who_was_not_there(graph: Graph) -> None:
    """Not by the clock: it sees the listener come."""
    speaker = graph.add(Peer, TRIAL_SPEC, SUBGOAL_SELECTOR.listens, (), name='speaker')
    node = graph.add(subgoal_selector.make_node, **WITHOUT_REMINDERS)
    for message in for_node(SUBGOAL_SELECTOR)[:2]:
        speaker.say(message)
    graph.spin_until(lambda: node.memory.asked)
    listener = graph.add(Peer, TRIAL_SPEC, (), (SEARCH_REQUEST,), name='listener')
    graph.spin_until(lambda: len(listener.heard) >= len(FIRST_ASKED))
    assert listener.heard == FIRST_ASKED


@pytest.mark.parametrize('topics', [SUBGOAL_SELECTOR, ACTION_SEARCHER], ids=lambda t: t.name)
def test_says_again_what_nobody_answers(graph: Graph, topics: NodeTopics) -> None:
    make_node = dict(zip(PART_IDS, (make for _, make in PARTS), strict=True))[topics.name]
    quick = {'parameter_overrides': [Parameter('remind_period_s', value=0.05)]}
    on = Bench(graph, topics, graph.add(make_node, **quick), TRIAL_SPEC)
    kind: type[Any]
    if topics is SUBGOAL_SELECTOR:
        kind, told = SearchRequest, for_node(topics)[:2]
    else:
        first = next(m for m in HEARD if isinstance(m, SubgoalChosen))
        kind, told = PlaceBlock, [*for_node(WORLD)[:1], *by_topic(HEARD)[WorldState][:1], first]
    on.tell(*told)
    said = on.hear(3 * len(FIRST_ASKED), kind)
    assert all(said.count(message) >= 2 for message in said)


# What it refuses


@each_part
def test_refuses_what_can_not_be_and_nothing_else_changes(
    graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]
) -> None:
    on = bench(graph, topics, make_node)
    heard = for_node(topics)
    on.tell(*heard[: len(heard) // 2])
    memory, refused = on.node.memory, on.node.refused
    can_be_wrong = [topic for topic in topics.listens if topic is not HOLD]
    for count, topic in enumerate(can_be_wrong, start=1):
        trial_id = '' if topic is TRIAL else TRIAL_SPEC.trial_id
        on.peer.outlets[topic].publish(topic.ros_type(trial_id=trial_id))
        wait_for_refusals(on, refused + count)
        assert on.node.memory == memory
    on.tell(*heard[len(heard) // 2 :])
    assert by_topic(on.hear(len(of_node(topics)))) == by_topic(of_node(topics))


def wait_for_refusals(on: Bench, count: int) -> None:
    """Spin until a node has refused so many messages."""
    on.graph.spin_until(lambda: on.node.refused == count)


def test_warns_of_what_it_refuses(graph: Graph, capfd: pytest.CaptureFixture[str]) -> None:
    on = bench(graph, WORLD, world.make_node)
    on.tell(started(TRIAL_SPEC))
    on.fence(ACTION)
    assert (
        "refused a message on trial: trial_id: expected a name of up to 200 characters, got ''"
        in capfd.readouterr().err
    )
