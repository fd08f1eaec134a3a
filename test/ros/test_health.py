"""What nodes say of themselves, and peers that are gone."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest
from blocks_planning_msgs.action import RunTrial
from diagnostic_msgs.msg import DiagnosticStatus
from graphs import record_lines, write_script
from orchestrators import Listener, orchestrator, wait_for_peers
from part_nodes import HEARD, TRIAL_SPEC
from peers import Graph, Peer
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.node import Node
from rclpy.parameter import Parameter
from source_imports import ROOT

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.nodes.marker_publisher import MarkerPublisher
from blocks_planning.ros.nodes.robot_arm import RobotArm
from blocks_planning.ros.nodes.trial_view import TrialView
from blocks_planning.ros.runtime.attendance import Attendance
from blocks_planning.ros.runtime.diagnostics import Health
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.graph import GRAPH

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
        'robot_arm': graph.add(RobotArm),
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
    node.start_trial('a', TRIAL_SPEC)
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
    peer = graph.add(Peer, TRIAL_SPEC, (), ())
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
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
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
