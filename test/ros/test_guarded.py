"""No message, request or goal ends a node or grows its memory without bounds."""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, ended, spec
from peers import Bench, Graph, Peer
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import ParameterValue
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.action.server import GoalResponse
from rclpy.parameter import Parameter
from rclpy.serialization import serialize_message

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.runtime import guarded, inbox
from blocks_planning.ros.runtime.guarded import read_message
from blocks_planning.ros.runtime.inbox import Inbox
from blocks_planning.ros.wire.conversions.fields import MessageError
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.graph import SUBGOAL_SELECTOR, WORLD
from blocks_planning.ros.wire.topics import ACTION, OUTCOME, STATE, TRIAL
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, TrialEnded, TrialStarted, WorldState

TRIAL_SPEC = spec(CHAIR, lam=0.2, depth=2)
HEARD: list[Message] = []
RECORD = run_trial(TRIAL_SPEC, observe=HEARD.append)
STATES = [message for message in HEARD if isinstance(message, WorldState)]
STARTED = TrialStarted(TRIAL_SPEC.trial_id, TRIAL_SPEC)
QUICK = {'parameter_overrides': [Parameter('remind_period_s', value=0.05)]}


def test_bytes_that_say_nothing_are_refused() -> None:
    data = serialize_message(STATE.to_ros(TRIAL_SPEC.task.board, STATES[-1]))
    assert read_message(STATE.ros_type, data).sequence == len(RECORD.placements)
    for spoilt in (b'', data[:4], data[:20], data[:-1], b'\xff' * 64):
        with pytest.raises(MessageError, match=f'its {len(spoilt)} bytes are not a WorldState'):
            read_message(STATE.ros_type, spoilt)
    with pytest.raises(MessageError, match='up to'):
        read_message(STATE.ros_type, data + bytes(guarded.MOST_BYTES))


def test_node_counts_bytes_that_say_nothing_and_goes_on(graph: Graph) -> None:
    on = Bench(graph, WORLD, graph.add(world.make_node), TRIAL_SPEC)
    data = serialize_message(TRIAL.to_ros(None, STARTED))
    for length in (4, 12, len(data) - 1):
        on.peer.outlets[TRIAL].publish(data[:length])
    graph.spin_until(lambda: on.node.refused == 3)
    on.tell(STARTED)
    assert on.hear(1, WorldState)[0].sequence == 0


def test_what_contradicts_is_counted_and_changes_nothing(graph: Graph) -> None:
    on = Bench(graph, SUBGOAL_SELECTOR, graph.add(subgoal_selector.make_node), TRIAL_SPEC)
    on.tell(STARTED, *STATES[:2])
    other = next(
        state
        for seed in range(1, 20)
        for state in _states(seed)
        if state.sequence == 2 and state.placements[0] != STATES[1].placements[0]
    )
    before, memory = on.node.refused, on.node.memory
    on.peer.say(replace(other, trial_id=TRIAL_SPEC.trial_id))
    graph.spin_until(lambda: on.node.refused == before + 1)
    assert on.node.memory.state == memory.state == STATES[1]


def _states(seed: int) -> list[WorldState]:
    heard: list[Message] = []
    run_trial(spec(CHAIR, lam=0.2, depth=2, seed=seed), observe=heard.append)
    return [message for message in heard if isinstance(message, WorldState)]


@pytest.mark.parametrize(
    'make_node', [world.make_node, subgoal_selector.make_node, ActionSearcher, BagRecorder]
)
@pytest.mark.parametrize('service', [SetParameters, SetParametersAtomically])
def test_parameter_of_no_type_does_not_end_a_node(
    graph: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, make_node: Any, service: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    node = graph.add(make_node)
    peer = graph.add(Peer, TRIAL_SPEC, (), ())
    name = {SetParameters: 'set_parameters', SetParametersAtomically: 'set_parameters_atomically'}
    client = peer.create_client(service, f'{node.get_name()}/{name[service]}')
    graph.spin_until(client.service_is_ready)
    wrong = ParameterMessage(name='x', value=ParameterValue(type=77))
    answer = client.call_async(service.Request(parameters=[wrong]))
    graph.spin_until(answer.done)
    assert node.refused == 1
    assert answer.result() == service.Response()


def test_outcome_of_somebody_else_holds_a_trial_up_and_no_more(
    graph: Graph, tmp_path: Path
) -> None:
    """A world that was told that the trial is over begins again when nothing more happens."""
    overrides = [*QUICK['parameter_overrides'], Parameter('journal_dir', value=str(tmp_path))]
    node = graph.add(world.make_node, parameter_overrides=overrides)
    orchestrator = graph.add(_orchestrator, tmp_path)
    peer = graph.add(Peer, TRIAL_SPEC, (TRIAL, OUTCOME, ACTION), (STATE,))
    graph.spin_until(lambda: peer.outlets[OUTCOME].get_subscription_count() == 1)
    orchestrator.start_trial(TRIAL_SPEC.trial_id, TRIAL_SPEC)
    graph.spin_until(lambda: node.memory.state is not None)
    peer.outlets[OUTCOME].publish(OUTCOME.to_ros(None, ended(TRIAL_SPEC.trial_id, RECORD)))
    graph.spin_until(lambda: node.memory.state is None)
    graph.spin_until(lambda: node.memory.state is not None)
    assert node.trial == STARTED


def test_foreign_trial_holds_a_trial_up_and_no_more(graph: Graph, tmp_path: Path) -> None:
    node = graph.add(world.make_node, **QUICK)
    orchestrator = graph.add(_orchestrator, tmp_path)
    peer = graph.add(Peer, TRIAL_SPEC, (TRIAL,), ())
    graph.spin_until(lambda: peer.outlets[TRIAL].get_subscription_count() == 1)
    orchestrator.start_trial(TRIAL_SPEC.trial_id, TRIAL_SPEC)
    graph.spin_until(lambda: node.trial == STARTED)
    peer.say(TrialStarted('foreign', TRIAL_SPEC))
    graph.spin_until(lambda: node.trial is not None and node.trial.trial_id == 'foreign')
    graph.spin_until(lambda: node.trial == STARTED)
    assert orchestrator.memory.trial == STARTED


def test_trial_that_is_over_is_not_announced_again(graph: Graph, tmp_path: Path) -> None:
    orchestrator = graph.add(_orchestrator, tmp_path)
    peer = graph.add(Peer, TRIAL_SPEC, (), (TRIAL, OUTCOME))
    graph.spin_until(lambda: orchestrator._outlets[OUTCOME.kind].get_subscription_count() == 1)
    orchestrator.start_trial(TRIAL_SPEC.trial_id, TRIAL_SPEC)
    graph.spin_until(lambda: len(peer.only(TrialStarted)) >= 3)
    orchestrator.take(_cancel())
    graph.spin_until(lambda: peer.only(TrialEnded))
    reminded: list[None] = []
    orchestrator.create_timer(0.05, lambda: reminded.append(None))
    count = len(peer.only(TrialStarted))
    graph.spin_until(lambda: len(reminded) >= 6)
    assert len(peer.only(TrialStarted)) == count
    assert len(peer.only(TrialEnded)) == 1


def _cancel() -> Message:
    from blocks_planning.trials.messages import CancelTrial

    return CancelTrial(TRIAL_SPEC.trial_id)


def _orchestrator(folder: Path, **options: Any) -> TrialOrchestrator:
    overrides = [
        Parameter('out_dir', value=str(folder)),
        Parameter('wait_for', value=['peer']),
        *QUICK['parameter_overrides'],
    ]
    return TrialOrchestrator(threading.Event(), parameter_overrides=overrides, **options)


def test_latched_state_that_was_lost_is_said_again(graph: Graph) -> None:
    """A queue that was flooded has lost it; nobody comes late who would get it anyway."""
    on = Bench(graph, WORLD, graph.add(world.make_node, **QUICK), TRIAL_SPEC)
    on.tell(STARTED)
    assert on.hear(4, WorldState) == STATES[:1] * len(on.peer.only(WorldState))


def test_goal_whose_caller_is_gone_keeps_nobody_out(graph: Graph, tmp_path: Path) -> None:
    """rclpy does not run a goal whose acceptance it can't tell anybody."""
    node = graph.add(_orchestrator, tmp_path)

    class Goal:
        trial = spec_to_ros('', TRIAL_SPEC)

    judge = node._goals._server._goal_callback
    assert [judge(Goal()), judge(Goal())] == [GoalResponse.ACCEPT] * 2
    assert not node._goals.is_busy


def test_inbox_is_bounded_by_bytes(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(inbox, 'MOST_BYTES', 1000)
    box = Inbox()
    for number in range(50):
        box.hold(f'trial {number % 3}', number, 90)
    assert sum(size for held in box._held.values() for size, _ in held) == box._bytes <= 1000
    for number in range(50):
        box.hold('one', number, 90)
    assert box.take('one') == list(range(39, 50))
    assert box._bytes == 0
    assert box.take('trial 0') == []


def test_inbox_drops_the_trial_that_was_silent_longest() -> None:
    box = Inbox()
    trials = [f'trial {number}' for number in range(inbox.MOST_TRIALS)]
    for trial_id in (*trials, trials[0], 'another'):
        box.hold(trial_id, trial_id)
    assert box.take(trials[1]) == []
    assert box.take(trials[0]) == [trials[0]] * 2


def test_searcher_takes_on_no_more_than_it_can(monkeypatch: pytest.MonkeyPatch) -> None:
    from blocks_planning.subgoals.decision import Query
    from blocks_planning.trials import searcher
    from blocks_planning.trials.messages import SearchAnswer, SearchRequest, Solve

    monkeypatch.setattr(searcher, 'MOST_SOLVING', 5)
    monkeypatch.setattr(searcher, 'MOST_KNOWN', 3)
    memory, _ = searcher.step(searcher.Memory(), STARTED)
    asked: list[Message] = []
    for cells in range(9):
        memory, said = searcher.step(
            memory, SearchRequest(TRIAL_SPEC.trial_id, (Query(0, cells),))
        )
        asked += said
    assert len(asked) == 5
    result = next(m.result for m in HEARD if isinstance(m, SearchAnswer))
    for solve in asked:
        assert isinstance(solve, Solve)
        memory, _ = searcher.step(memory, SearchAnswer(solve.trial_id, solve.query, result))
    assert [query.target for query in memory.known] == [2, 3, 4]
    assert not memory.solving
