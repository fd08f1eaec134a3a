"""Every node by itself, with a peer in another context that talks to it and listens."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml
from blocks_planning_msgs.action import RunTrial
from builders import CHAIR, EMPTY, NEVER_SOLVED, ended, spec
from carried import sent
from graphs import NODES
from peers import Bench, Graph, Peer
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.node import Node
from rclpy.parameter import Parameter
from source_imports import ROOT

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.nodes.marker_publisher import MarkerPublisher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.nodes.trial_view import TrialView
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.graph import (
    ACTION_SEARCHER,
    GRAPH,
    SUBGOAL_SELECTOR,
    TRIAL_ORCHESTRATOR,
    WORLD,
    NodeTopics,
)
from blocks_planning.ros.wire.topics import (
    ACTION,
    OUTCOME,
    SEARCH_REQUEST,
    STATE,
    SUBGOAL,
    TOPICS,
    TRIAL,
)
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    SearchAnswer,
    SearchRequest,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

TRIAL_SPEC = spec(CHAIR, lam=0.2, depth=2)
FOREIGN = spec(CHAIR, lam=0.2, depth=2, seed=1)
LONG = spec('/'.join(['#' * 16] * 16), strategy='none', depth=12, budget=10**15)
"""A search that takes days."""
HEARD: list[Message] = []
RECORD = run_trial(TRIAL_SPEC, observe=HEARD.append)
KINDS = {topic.kind: topic for topic in TOPICS}
FIRST_ASKED = [
    m
    for m in HEARD
    if isinstance(m, SearchRequest) and all(query.built == 0 for query in m.queries)
]
PARTS: list[tuple[NodeTopics, Callable[..., Any]]] = [
    (WORLD, world.make_node),
    (SUBGOAL_SELECTOR, subgoal_selector.make_node),
    (ACTION_SEARCHER, ActionSearcher),
]
PART_IDS = [topics.name for topics, _ in PARTS]
WITHOUT_REMINDERS = {'parameter_overrides': [Parameter('remind_period_s', value=3600.0)]}
each_part = pytest.mark.parametrize(('topics', 'make_node'), PARTS, ids=PART_IDS)


def started(trial: TrialSpec) -> TrialStarted:
    """The message that begins a trial."""
    return TrialStarted(trial.trial_id, trial)


def foreign(message: Message) -> Message:
    """The same, said about another trial."""
    return replace(message, trial_id=FOREIGN.trial_id)


def make_orchestrator(folder: Path, **options: Any) -> TrialOrchestrator:
    """The orchestrator, with its records in a folder."""
    overrides = [Parameter('out_dir', value=str(folder)), Parameter('wait_for', value=['peer'])]
    return TrialOrchestrator(threading.Event(), parameter_overrides=overrides, **options)


def bench(graph: Graph, topics: NodeTopics, make_node: Callable[..., Any]) -> Bench:
    """A node that does not remind by itself, with its peer."""
    return Bench(graph, topics, graph.add(make_node, **WITHOUT_REMINDERS), TRIAL_SPEC)


def for_node(topics: NodeTopics) -> list[Message]:
    """What a node hears of an undisturbed trial, but its end."""
    kinds = tuple(topic.kind for topic in topics.listens if topic is not OUTCOME)
    return [message for message in HEARD if isinstance(message, kinds)]


def of_node(topics: NodeTopics) -> list[Message]:
    """What a node says in an undisturbed trial."""
    kinds = tuple(topic.kind for topic in topics.says)
    return [message for message in HEARD if isinstance(message, kinds)]


def by_topic(messages: list[Message]) -> dict[type, list[Message]]:
    """Messages by kind. Topics are not ordered among each other, and answers may overtake."""
    found: dict[type, list[Message]] = {}
    for message in messages:
        found.setdefault(type(message), []).append(message)
    found.get(SearchAnswer, []).sort(key=str)
    return found


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
    for count, topic in enumerate(topics.listens, start=1):
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


# The orchestrator


def test_orchestrator_gives_feedback_and_a_result(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    feedback: list[Any] = []
    sending = client.send_goal_async(
        RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)), feedback_callback=feedback.append
    )
    graph.spin_until(sending.done)
    (trial,) = on.hear(1, TrialStarted)
    assert trial.spec == TRIAL_SPEC
    assert trial.trial_id.startswith(TRIAL_SPEC.trial_id)
    followed = [m for m in HEARD if isinstance(m, (WorldState, SubgoalChosen))]
    for message in followed:
        on.peer.say(replace(message, trial_id=trial.trial_id))
    result = sending.result().get_result_async()
    graph.spin_until(result.done)
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED
    outcome = result.result().result.outcome
    assert outcome.status == 'success'
    assert outcome.action_planning_cost == RECORD.action_planning_cost
    assert outcome.subgoal_planning_cost == RECORD.subgoal_planning_cost
    graph.spin_until(lambda: len(feedback) >= len(followed) - 1)
    costs = [f.feedback.action_planning_cost for f in feedback]
    assert costs == sorted(costs)
    assert on.hear(1, TrialEnded) == [TrialEnded(trial.trial_id, TrialStatus.SUCCESS)]
    assert (tmp_path / 'trials.jsonl').read_text() == RECORD.to_line() + '\n'


def test_goal_that_cannot_be_run_is_aborted_with_the_reason(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    changes: list[tuple[Callable[[Any], None], str]] = [
        (lambda trial: setattr(trial.silhouette, 'width', 0), 'silhouette.width: '),
        (lambda trial: setattr(trial.planner, 'strategy', 'luck'), 'planner.strategy: '),
        (
            lambda trial: setattr(
                trial.planner.strategy_settings[0], 'double_value', float('nan')
            ),
            'planner.strategy: lambda must be ',
        ),
        (lambda trial: setattr(trial, 'library', []), 'library: '),
    ]
    for count, (change, reason) in enumerate(changes, start=1):
        trial = sent(spec_to_ros('', TRIAL_SPEC))
        change(trial)
        ended = end_of(graph, client, trial)
        assert ended.status == GoalStatus.STATUS_ABORTED
        outcome = ended.result.outcome
        assert (outcome.status, outcome.code) == ('refused', outcome.CODE_REFUSED)
        assert outcome.reason.startswith(reason)
        assert on.node.refused == count
    assert on.peer.only(TrialStarted) == []


def test_orchestrator_runs_one_goal_at_a_time(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    first = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
    graph.spin_until(first.done)
    second = end_of(graph, client, spec_to_ros('', FOREIGN))
    assert second.status == GoalStatus.STATUS_ABORTED
    assert second.result.outcome.reason == 'a trial is running'
    assert len(on.hear(1, TrialStarted)) == 1
    first.result().cancel_goal_async()
    ended = first.result().get_result_async()
    graph.spin_until(ended.done)
    assert ended.result().status == GoalStatus.STATUS_CANCELED


def test_orchestrator_ignores_what_is_stale_or_foreign(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
    graph.spin_until(sending.done)
    (trial,) = on.hear(1, TrialStarted)
    states = [replace(m, trial_id=trial.trial_id) for m in by_topic(HEARD)[WorldState]]
    on.peer.say(states[1])
    on.peer.say(states[0])
    on.peer.say(foreign(states[2]))
    on.peer.outlets[STATE].publish(STATE.ros_type(trial_id=trial.trial_id))
    graph.spin_until(lambda: on.node.refused == 1)
    assert on.node.memory.state == states[1]
    on.peer.outlets[SUBGOAL].publish(SUBGOAL.ros_type(trial_id=trial.trial_id))
    graph.spin_until(lambda: on.node.refused == 2)
    assert on.node.memory.chosen is None


def test_orchestrator_ends_a_trial_that_needs_nothing(graph: Graph, tmp_path: Path) -> None:
    """The target is complete before anything is decided."""
    everybody(graph, tmp_path)
    client = graph.add(Caller).client
    graph.spin_until(client.server_is_ready)
    assert outcome_of(graph, client, spec(EMPTY)).status == 'success'
    ended = end_of(graph, client, spec_to_ros('', spec(NEVER_SOLVED)))
    assert ended.status == GoalStatus.STATUS_ABORTED  # its tower was not built
    outcome = ended.result.outcome
    assert (outcome.status, outcome.code) == ('gave_up', outcome.CODE_GAVE_UP)
    assert outcome.reason == 'no subgoal could be solved'
    assert outcome_of(graph, client, TRIAL_SPEC).status == 'success'


def test_cancel_ends_a_long_search_at_once(graph: Graph, tmp_path: Path) -> None:
    """And everything is usable again."""
    _, searching = everybody(graph, tmp_path)
    client = graph.add(Caller).client
    graph.spin_until(client.server_is_ready)
    for _ in range(2):
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', LONG)))
        graph.spin_until(sending.done)
        graph.spin_until(lambda: searching.memory.solving)
        cancelling = sending.result().cancel_goal_async()
        result = sending.result().get_result_async()
        graph.spin_until(result.done, deadline_s=2.0)
        graph.spin_until(cancelling.done)
        assert len(cancelling.result().goals_canceling) == 1
        assert result.result().status == GoalStatus.STATUS_CANCELED
        assert result.result().result.outcome.status == 'cancelled'
        assert outcome_of(graph, client, TRIAL_SPEC).status == 'success'
    statuses = [
        re.search(r'"status":"(\w+)"', line)[1]  # type: ignore[index]
        for line in (tmp_path / 'trials.jsonl').read_text().splitlines()
    ]
    assert statuses == ['cancelled', 'success'] * 2


def test_orchestrator_cancels_a_goal_that_nobody_works_on(graph: Graph, tmp_path: Path) -> None:
    _, client = with_client(graph, tmp_path)
    for _ in range(3):
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
        graph.spin_until(sending.done)
        assert sending.result().accepted
        result = sending.result().get_result_async()
        sending.result().cancel_goal_async()
        graph.spin_until(result.done, deadline_s=2.0)
        assert result.result().status == GoalStatus.STATUS_CANCELED


class Caller(Node):
    """A node that asks for trials."""

    def __init__(self, **options: Any) -> None:
        super().__init__('caller', **options)
        self.client = ActionClient(self, RunTrial, 'run_trial')


def everybody(graph: Graph, folder: Path) -> tuple[TrialOrchestrator, ActionSearcher]:
    """All nodes of the graph."""
    for make_node in (world.make_node, subgoal_selector.make_node):
        graph.add(make_node)
    searching = graph.add(ActionSearcher)
    return graph.add(make_orchestrator, folder), searching


def with_client(graph: Graph, folder: Path) -> tuple[Bench, ActionClient]:
    """The orchestrator with its peer, and somebody who asks for trials."""
    on = Bench(graph, TRIAL_ORCHESTRATOR, graph.add(make_orchestrator, folder), TRIAL_SPEC)
    client = ActionClient(on.peer, RunTrial, 'run_trial')
    graph.spin_until(client.server_is_ready)
    return on, client


def end_of(graph: Graph, client: ActionClient, trial: Any) -> Any:
    """Status and result of a goal."""
    sending = client.send_goal_async(RunTrial.Goal(trial=trial))
    graph.spin_until(sending.done)
    assert sending.result().accepted
    ending = sending.result().get_result_async()
    graph.spin_until(ending.done)
    return ending.result()


def outcome_of(graph: Graph, client: ActionClient, trial: TrialSpec) -> Any:
    """The outcome of a goal."""
    return end_of(graph, client, spec_to_ros('', trial)).result.outcome


# Parameters, and what is written about nodes

EVERY_NODE = [name for name in GRAPH if name != 'watcher']
each_node = pytest.mark.parametrize('name', EVERY_NODE)


@pytest.fixture
def make(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, graph: Graph) -> Callable[..., Any]:
    """Makes a node by its name, in an empty working directory."""
    monkeypatch.chdir(tmp_path)
    makers: dict[str, Callable[..., Any]] = {
        **dict(zip(PART_IDS, (make_node for _, make_node in PARTS), strict=True)),
        'trial_orchestrator': lambda **options: TrialOrchestrator(threading.Event(), **options),
        'bag_recorder': BagRecorder,
        'marker_publisher': MarkerPublisher,
        'trial_view': TrialView,
    }

    def call(name: str, **parameters: Any) -> Any:
        overrides = [Parameter(key, value=value) for key, value in parameters.items()]
        return graph.add(makers[name], parameter_overrides=overrides)

    return call


def own_parameters(node: Node) -> dict[str, Any]:
    """The parameters of a node that are not those of every node."""
    names = node.list_parameters([], 0).names
    own = [n for n in names if not n.startswith(('use_sim_time', 'start_type', 'qos_overrides'))]
    return {name: node.get_parameter(name).value for name in own}


@each_node
def test_configuration_lists_what_is_declared(name: str, make: Callable[..., Any]) -> None:
    """No parameter less, none more, each with its default."""
    path = ROOT / 'config' / 'nodes.yaml'
    listed = yaml.safe_load(path.read_text(encoding='utf-8'))[f'/**/{name}']['ros__parameters']
    declared = own_parameters(make(name))
    assert listed == declared
    assert {key: type(value) for key, value in listed.items()} == {
        key: type(value) for key, value in declared.items()
    }


def test_configuration_lists_every_node() -> None:
    path = ROOT / 'config' / 'nodes.yaml'
    listed = yaml.safe_load(path.read_text(encoding='utf-8'))
    assert list(listed) == [f'/**/{name}' for name in EVERY_NODE]


@each_node
def test_parameters_are_described_and_can_not_be_changed(
    name: str, make: Callable[..., Any]
) -> None:
    node = make(name)
    for parameter in own_parameters(node):
        descriptor = node.describe_parameter(parameter)
        assert descriptor.description.endswith(('.', ']'))
        assert descriptor.read_only
        is_number = type(node.get_parameter(parameter).value) in (int, float)
        ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
        assert len(ranges) == int(is_number)
        result = node.set_parameters([Parameter(parameter, value=7)])[0]
        assert not result.successful


@each_node
def test_unknown_parameters_are_refused(name: str, make: Callable[..., Any]) -> None:
    with pytest.raises(ConfigurationError, match=rf"{name} has no parameter 'spped'"):
        make(name, spped=1)


@each_node
def test_parameters_of_a_wrong_type_or_value_are_refused(
    name: str, make: Callable[..., Any]
) -> None:
    for parameter, default in own_parameters(make(name)).items():
        wrong: list[Any] = [True, [1, 2], 12 if not isinstance(default, int) else 1.5]
        if isinstance(default, (int, float)):
            wrong += ['much', type(default)(-1), type(default)(2**62)]
        for value in wrong:
            with pytest.raises(ConfigurationError) as refused:
                make(name, **{parameter: value})
            assert f'parameter {parameter} ' in str(refused.value)
            shown = re.escape(str(value).strip('[]'))
            assert re.search(rf'got .*{shown}', str(refused.value))


@pytest.mark.parametrize(
    ('name', 'parameter', 'said'),
    [
        ('world', 'remind_period_s:=0.0', 'parameter remind_period_s must be'),
        ('subgoal_selector', 'colour:=red', "has no parameter 'colour'"),
        ('action_searcher', 'workers:=many', 'parameter workers must be'),
        ('trial_orchestrator', 'script:=nowhere.yaml', 'nowhere.yaml: cannot be read'),
        ('bag_recorder', 'flush_period_s:=1e9', 'parameter flush_period_s must be'),
        ('marker_publisher', 'cell_size:=0.0', 'parameter cell_size must be'),
        ('marker_publisher', "frame_id:=''", 'parameter frame_id must be a name'),
        ('trial_view', 'host:=nowhere.invalid', 'cannot be served at nowhere.invalid:0: '),
        ('trial_view', 'token:=short', 'token must be 16 or more letters'),
    ],
)
def test_process_with_bad_parameters_ends_with_one_line(
    name: str, parameter: str, said: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, '-m', NODES, name, '--ros-args', '-p', parameter],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2
    assert done.stdout == ''
    assert re.fullmatch(r'Error: [^\n]*\n', done.stderr)
    assert said in done.stderr


def test_parameters_are_read_from_the_file_that_ships(tmp_path: Path) -> None:
    """With one value changed to nonsense, that one is named."""
    text = (ROOT / 'config' / 'nodes.yaml').read_text(encoding='utf-8')
    path = tmp_path / 'nodes.yaml'
    path.write_text(text.replace('workers: 2', 'workers: 0'), encoding='utf-8')
    done = subprocess.run(
        [
            *(sys.executable, '-m', NODES, 'action_searcher'),
            *('--ros-args', '--params-file', str(path)),
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (done.returncode, done.stdout) == (2, '')
    assert 'workers' in done.stderr
    assert 'got 0' in done.stderr


@each_node
def test_docstring_names_topics_and_parameters(name: str, make: Callable[..., Any]) -> None:
    module = importlib.import_module(f'blocks_planning.ros.nodes.{name}')
    assert module.__doc__ is not None
    rows = dict(re.findall(r'^\| (\w+) \| (.*) \|$', module.__doc__, re.MULTILINE))
    topics = GRAPH[name]
    if rows['subscribes'] == 'every topic':
        assert set(topics.listens) == set(TOPICS)
    else:
        assert named(rows['subscribes']) == {topic.name: topic.latched for topic in topics.listens}
    assert named(rows.get('publishes', '')) == {
        **{topic.name: topic.latched for topic in topics.says},
        **{topic.name: True for topic in topics.views},
    }
    parameters = re.findall(r'(?:^|; )`(\w+)`', rows['parameters'])
    assert parameters == list(own_parameters(make(name)))
    assert ('action' in rows) == (name in ('trial_orchestrator', 'action_searcher'))
    assert ('services' in rows) == (name == 'trial_orchestrator')


def named(row: str) -> dict[str, bool]:
    """The topics of a row of a table, and whether it says that they are latched."""
    found: dict[str, bool] = {}
    for names, qos in re.findall(r'((?:`[\w/]+`(?:, )?)+) \((latched|stream)\)', row):
        found |= dict.fromkeys(re.findall(r'`([\w/]+)`', names), qos == 'latched')
    return found
