"""Who is missing, what is full, and who is there twice: what nodes make of it, and say of it."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import pytest
from blocks_planning_msgs.action import RunTrial
from builders import CHAIR, ended, spec
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from disks import disk_of
from graphs import NODES, local_lines, record_lines, write_script
from peers import Bench, Graph, Peer
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.node import Node
from rclpy.parameter import Parameter
from source_imports import ROOT

from blocks_planning.board.blocks import Placed
from blocks_planning.errors import LimitExceeded
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.nodes.marker_publisher import MarkerPublisher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.nodes.trial_view import TrialView
from blocks_planning.ros.runtime.attendance import Attendance
from blocks_planning.ros.runtime.diagnostics import TOPIC, Health
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import stood_still
from blocks_planning.ros.runtime.single import claim_name
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.graph import GRAPH, TRIAL_ORCHESTRATOR, WORLD
from blocks_planning.ros.wire.topics import OUTCOME, SEARCH_REQUEST, STATE, TRIAL
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    SearchRequest,
    TrialStarted,
    WorldState,
)
from blocks_planning.worlds.observation import Observation

SPEC = spec(CHAIR, lam=0.2, depth=2)
HEARD: list[Message] = []
RECORD = run_trial(SPEC, observe=HEARD.append)


class Listener(Node):
    """Hears the health of all nodes, and the outcomes of all trials."""

    def __init__(self, **options: Any) -> None:
        super().__init__('listener', **options)
        self.health: list[DiagnosticStatus] = []
        self.outcomes: list[Any] = []
        self.create_subscription(DiagnosticArray, TOPIC, self._hear, 10)
        self.create_subscription(
            OUTCOME.ros_type, OUTCOME.name, self.outcomes.append, OUTCOME.subscription_qos
        )

    def _hear(self, message: Any) -> None:
        self.health += message.status

    def of(self, node: Node) -> list[dict[str, str]]:
        """What a node has said of itself."""
        own = [s for s in self.health if s.name == node.get_fully_qualified_name()]
        return [{value.key: value.value for value in status.values} for status in own]


def orchestrator(graph: Graph, folder: Path, *wait_for: str, **parameters: Any) -> Any:
    """The orchestrator, that does not wait long."""
    values = {
        'out_dir': str(folder),
        'wait_for': list(wait_for) or ['world', 'subgoal_selector', 'action_searcher'],
        'peer_timeout_s': 0.2,
        **parameters,
    }
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return graph.add(
        lambda **options: TrialOrchestrator(
            threading.Event(), parameter_overrides=overrides, **options
        )
    )


def wait_for_peers(graph: Graph, node: PartNode, *names: str) -> None:
    """Until a node sees some others; what it sees the next node of its context sees at once."""
    graph.spin_until(lambda: not node.peers.missing(names))


# Diagnostics


def test_health_says_what_is_wrong_first() -> None:
    health = Health('building', 'a', ['x'], ['y', 'z'], values={'load': 3})
    status = health.status('/some/node')
    assert (status.name, status.level) == ('/some/node', DiagnosticStatus.WARN)
    assert status.message == 'waiting for y, z'
    assert [(value.key, value.value) for value in status.values] == [
        ('state', 'building'),
        ('trial', 'a'),
        ('load', '3'),
        ('peers_present', 'x'),
        ('peers_missing', 'y, z'),
    ]
    assert Health('idle').status('n').level == DiagnosticStatus.OK
    failing = Health('idle', missing=['y'], failure='the disk is full').status('n')
    assert (failing.level, failing.message) == (DiagnosticStatus.ERROR, 'the disk is full')


def told_keys(name: str) -> set[str]:
    """The keys that the page about the graph tells of a node."""
    page = (ROOT / 'docs' / 'ros.md').read_text(encoding='utf-8')
    section = page.split('## Diagnostics')[1].split('\n## ')[0]
    found: set[str] = set()
    for keys, of in re.findall(r'^\| (`.*?) \| (.*?) \| .* \|$', section, re.MULTILINE):
        is_told = of.startswith('all') != (f'`{name}`' in of)
        found |= set(re.findall(r'`(\w+)`', keys)) if is_told else set()
    return found


def test_every_node_says_how_it_is(graph: Graph, tmp_path: Path) -> None:
    listener = graph.add(Listener)
    parameters = [Parameter('bag_dir', value=str(tmp_path / 'bag'))]
    nodes: dict[str, Any] = {
        'world': graph.add(world.make_node),
        'subgoal_selector': graph.add(subgoal_selector.make_node),
        'action_searcher': graph.add(ActionSearcher),
        'bag_recorder': graph.add(BagRecorder, parameter_overrides=parameters),
        'marker_publisher': graph.add(MarkerPublisher),
        'trial_view': graph.add(TrialView),
    }
    graph.spin_until(lambda: listener.of(nodes['world']))
    assert listener.of(nodes['world'])[0]['peers_missing'] == 'trial_orchestrator'
    nodes['trial_orchestrator'] = orchestrator(graph, tmp_path, 'world')
    graph.spin_until(
        lambda: all(
            listener.of(n) and not listener.of(n)[-1]['peers_missing'] for n in nodes.values()
        )
    )
    assert set(nodes) == set(GRAPH) - {'watcher'}
    last = {name: listener.of(node)[-1] for name, node in nodes.items()}
    assert {name: said['state'] for name, said in last.items()} == {
        **dict.fromkeys(nodes, 'idle'),
        'bag_recorder': 'recording',
    }
    assert all(said['trial'] == '' for said in last.values())
    assert 'action_searcher' in last['world']['peers_present'].split(', ')
    assert {name for name, said in last.items() if 'messages_refused' in said} == set(nodes) - {
        'bag_recorder'
    }

    for name, said in last.items():
        assert set(said) == told_keys(name)
    node = nodes['trial_orchestrator']
    node.start_trial('a', SPEC)
    graph.spin_until(lambda: listener.outcomes)
    graph.spin_until(
        lambda: int(listener.of(nodes['bag_recorder'])[-1]['messages_recorded']) > len(HEARD) / 2
    )
    graph.spin_until(lambda: int(listener.of(nodes['action_searcher'])[-1]['states_evaluated']))
    graph.spin_until(lambda: listener.of(node)[-1]['trials_ended'] == '1')


# Peers that are gone


def test_attendance_counts_from_when_it_matters() -> None:
    attendance = Attendance()
    assert attendance.note(['a'], 10.0) == ['a']
    assert attendance.note(['a', 'b'], 12.0) == ['b']
    assert attendance.missing == ['a', 'b']
    assert attendance.overdue(14.0, 5.0, begin_s=0.0) == ''
    assert attendance.overdue(15.0, 5.0, begin_s=0.0) == 'missing: a for 5.0 s'
    assert attendance.overdue(17.5, 5.0, begin_s=0.0) == 'missing: a for 7.5 s, b for 5.5 s'
    assert attendance.overdue(17.5, 5.0, begin_s=13.0) == ''
    assert attendance.note(['b'], 18.0) == []
    assert attendance.overdue(18.0, 5.0, begin_s=0.0) == 'missing: b for 6.0 s'
    assert attendance.note(['a'], 19.0) == ['a']
    assert attendance.overdue(19.0, 5.0, begin_s=0.0) == ''


def test_trial_ends_when_a_peer_is_gone_for_too_long(
    graph: Graph, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    """The record says cancelled, the outcome who was missing, and the script ends with 1."""
    script = write_script(tmp_path, seeds=3)
    listener = graph.add(Listener)
    peer = graph.add(Peer, SPEC, (), ())
    wait_for_peers(graph, graph.add(world.make_node), 'peer')
    node = orchestrator(graph, tmp_path, 'peer', script=str(script))
    graph.spin_until(lambda: node.is_busy)
    graph.remove(peer)
    graph.spin_until(lambda: listener.outcomes)
    outcome = listener.outcomes[0]
    assert outcome.status == 'cancelled'
    assert outcome.reason.startswith('missing: peer for ')
    assert (node._stop.is_set(), node.exit_code) == (True, 1)
    (record,) = map(json.loads, record_lines(tmp_path))
    assert record['status'] == 'cancelled'
    said = capfd.readouterr().err
    assert 'missing: peer; waiting up to 0.2 s' in said
    assert 'the script ends: missing: peer for ' in said


def test_goal_without_peers_is_ended_in_time(graph: Graph, tmp_path: Path) -> None:
    node = orchestrator(graph, tmp_path, 'nobody')
    caller = graph.add(lambda **options: Node('caller', **options))
    client = ActionClient(caller, RunTrial, 'run_trial')
    graph.spin_until(client.server_is_ready)
    for _ in range(2):
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', SPEC)))
        graph.spin_until(sending.done)
        result = sending.result().get_result_async()
        graph.spin_until(result.done, deadline_s=5.0)
        assert result.result().status == GoalStatus.STATUS_ABORTED
        assert result.result().result.outcome.reason.startswith('missing: nobody for ')
    assert not node._stop.is_set()


def test_nobody_is_missing_while_a_person_thinks(graph: Graph, tmp_path: Path) -> None:
    """However long that is."""
    script = write_script(tmp_path, strategies=[{'name': 'human'}])
    listener = graph.add(Listener)
    for make_node in (subgoal_selector.make_node, ActionSearcher):
        graph.add(make_node)
    wait_for_peers(
        graph, graph.add(world.make_node), 'world', 'subgoal_selector', 'action_searcher'
    )
    node = orchestrator(graph, tmp_path, script=str(script), peer_timeout_s=0.1)
    graph.spin_until(lambda: node.is_busy or node._stop.is_set())
    graph.spin_until(lambda: [said['state'] for said in listener.of(node)].count('building') > 2)
    assert listener.outcomes == []


# Disks that are full, and journals that can't be right


def world_with(graph: Graph, folder: Path) -> Bench:
    """A world with a journal, and its peer."""
    overrides = [Parameter('journal_dir', value=str(folder))]
    return Bench(graph, WORLD, graph.add(world.make_node, parameter_overrides=overrides), SPEC)


def placing(sequence: int) -> PlaceBlock:
    """An action of the trial."""
    return PlaceBlock(SPEC.trial_id, sequence, RECORD.placements[sequence].placement)


def test_world_that_can_not_write_its_journal_places_nothing(graph: Graph, tmp_path: Path) -> None:
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(SPEC.trial_id, SPEC), placing(0))
    (journal,) = tmp_path.glob('*.journal')
    before = journal.read_bytes()
    on.hear(2, WorldState)
    with disk_of(len(before) + 3):
        on.peer.say(placing(1))
        graph.spin_until(lambda: len(on.peer.only(PlacementOutcome)) == 2)
    failed = on.peer.only(PlacementOutcome)[-1]
    assert failed.failed
    assert failed.sequence == 1
    assert failed.reason == f'{journal}: cannot be written: File too large'
    assert journal.read_bytes() == before
    assert on.node.memory.state.sequence == 1
    on.tell(placing(1))  # there is room again
    assert on.hear(3, WorldState)[-1].placements == RECORD.placements[:2]


@pytest.mark.parametrize(
    'wrong', [Placed(1, 2, 0, 5), Placed(9, 9, 0, 0), Placed(4, 2, 15, 0)], ids=str
)
def test_journal_that_contradicts_the_task_is_set_aside(
    graph: Graph, tmp_path: Path, wrong: Placed
) -> None:
    """What others know of the board is more than the world does: it says so."""
    journal = Journal(tmp_path)
    journal.begin(SPEC.trial_id)
    for placed in (*RECORD.placements[:1], wrong):
        journal.append(Observation(placed.placement, (placed,)))
    journal.release()
    (path,) = tmp_path.glob('*.journal')
    content = path.read_bytes()
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(SPEC.trial_id, SPEC))
    assert on.hear(1, WorldState)[0].sequence == 0
    (aside,) = tmp_path.glob('*.aside-*')
    assert aside.read_bytes() == content
    on.tell(placing(2))
    (failed,) = on.hear(1, PlacementOutcome)
    assert failed.failed
    assert failed.reason.endswith(f'it was renamed to {aside.name}')
    on.tell(placing(0))
    assert on.hear(2, WorldState)[-1].placements == RECORD.placements[:1]
    on.peer.outlets[OUTCOME].publish(OUTCOME.to_ros(None, ended(SPEC.trial_id, RECORD)))
    graph.spin_until(lambda: not on.node.is_busy)
    on.tell(placing(2))
    assert len(on.peer.only(PlacementOutcome)) == 2


def test_world_with_its_journal_does_not_mind_what_is_to_come(
    graph: Graph, tmp_path: Path
) -> None:
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(SPEC.trial_id, SPEC), placing(2))
    on.tell(placing(0))
    assert [outcome.failed for outcome in on.hear(1, PlacementOutcome)] == [False]


def test_trial_ends_when_nothing_can_be_placed(graph: Graph, tmp_path: Path) -> None:
    """With what the world says; but not for what is stale."""
    node = orchestrator(graph, tmp_path, 'peer')
    listener = graph.add(Listener)
    on = Bench(graph, TRIAL_ORCHESTRATOR, node, SPEC)
    node.start_trial(SPEC.trial_id, SPEC)
    on.tell(*[m for m in HEARD if isinstance(m, (WorldState, SubgoalChosen))][:3])
    at = node.memory.state.sequence
    assert at == 1
    for sequence in (at - 1, at + 1):
        on.tell(PlacementOutcome(SPEC.trial_id, sequence, None, 'stale', PlacementCode.FAILED))
    on.tell(
        PlacementOutcome(
            SPEC.trial_id, at, None, 'that block is impossible', PlacementCode.IMPOSSIBLE
        )
    )
    assert node.is_busy
    on.tell(PlacementOutcome(SPEC.trial_id, at, None, 'the arm is broken', PlacementCode.FAILED))
    graph.spin_until(lambda: listener.outcomes)
    assert listener.outcomes[0].status == 'cancelled'
    assert listener.outcomes[0].reason == 'the arm is broken'


def test_script_ends_when_a_record_can_not_be_written(graph: Graph, tmp_path: Path) -> None:
    """What was written stays readable, and a second start goes on with that trial."""
    script, out = write_script(tmp_path, seeds=3), tmp_path / 'out'
    expected = local_lines(script)
    listener = graph.add(Listener)
    for make_node in (world.make_node, subgoal_selector.make_node, ActionSearcher):
        graph.add(make_node)
    node = orchestrator(graph, out, script=str(script), peer_timeout_s=20.0)
    with disk_of(len(expected[0]) + 1 + len(expected[1]) // 2):
        graph.spin_until(node._stop.is_set)
    assert node.exit_code == 1
    assert record_lines(out) == expected[:1]
    graph.spin_until(lambda: len(listener.outcomes) == 2)
    reason = f'{out / "trials.jsonl"}: cannot be written: File too large'
    assert [outcome.reason == reason for outcome in listener.outcomes] == [False, True]
    graph.spin_until(lambda: any(status.message == reason for status in listener.health))
    graph.remove(node)
    again = orchestrator(graph, out, script=str(script), peer_timeout_s=20.0)
    graph.spin_until(again._stop.is_set)
    assert again.exit_code == 0
    assert record_lines(out) == expected


# Nodes that are there twice


def test_two_of_each_change_no_record(graph: Graph, tmp_path: Path) -> None:
    """As it can be on two machines: what is said twice is the same, and counts once."""
    script = write_script(tmp_path, seeds=2)
    for make_node in (world.make_node, subgoal_selector.make_node, ActionSearcher):
        for _ in range(2):
            graph.add(make_node)
    node = orchestrator(graph, tmp_path, script=str(script), peer_timeout_s=20.0)
    graph.spin_until(node._stop.is_set)
    assert record_lines(tmp_path) == local_lines(script)


def test_name_is_claimed_once_in_a_domain() -> None:
    name = f'/test/{time.monotonic_ns()}'
    first = claim_name(7, name)
    assert first is not None
    other = claim_name(8, name, wait_s=0)
    with pytest.raises(LimitExceeded, match=rf'node {name} is already running in ROS domain 7'):
        claim_name(7, name, wait_s=0)
    first.close()
    for claim in (claim_name(7, name, wait_s=0), other):
        assert claim is not None
        claim.close()


def test_second_process_of_a_node_is_refused(graph: Graph) -> None:
    command = [sys.executable, '-m', NODES, 'subgoal_selector', '--ros-args']
    command += ['-r', f'__ns:={graph.namespace}']
    peer = graph.add(Peer, SPEC, (), ())
    with subprocess.Popen(command) as first:
        try:
            graph.spin_until(
                lambda: any(n.startswith('subgoal_sel') for n in peer.get_node_names())
            )
            second = subprocess.run(command, capture_output=True, text=True, timeout=60)
            assert second.returncode == 2
            assert f'node {graph.namespace}/subgoal_selector is already running' in second.stderr
            assert len(second.stderr.splitlines()) == 1
            assert first.poll() is None
        finally:
            first.terminate()


# Processes that are stopped, and that die


@pytest.mark.parametrize(
    ('passed_s', 'worked_s', 'stopped'),
    [(0.5, 0.0, False), (4.4, 0.0, False), (4.6, 0.0, True), (60.0, 0.3, True), (6.0, 5.9, False)],
)
def test_who_is_busy_did_not_stand_still(passed_s: float, worked_s: float, stopped: bool) -> None:
    assert stood_still(passed_s, worked_s) == stopped


def test_node_that_was_stopped_is_there_again(graph: Graph, tmp_path: Path) -> None:
    """After all others had taken it for dead; and it says what holds."""
    peer = graph.add(Peer, SPEC, (TRIAL, STATE), (SEARCH_REQUEST,))
    command = [sys.executable, '-m', NODES, 'subgoal_selector', '--ros-args']
    command += ['-r', f'__ns:={graph.namespace}']
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            graph.spin_until(lambda: peer.count_publishers('subgoal'))
            process.send_signal(signal.SIGSTOP)
            graph.spin_until(lambda: not peer.count_publishers('subgoal'))
            process.send_signal(signal.SIGCONT)
            peer.say(HEARD[0])
            peer.say(next(m for m in HEARD if isinstance(m, WorldState)))
            first = next(m for m in HEARD if isinstance(m, SearchRequest))
            graph.spin_until(lambda: first in peer.heard)
            assert process.poll() is None
        finally:
            process.terminate()
        assert process.stderr is not None
        assert re.search(r'was stopped for \d+\.\d s, and restarts', process.stderr.read())
