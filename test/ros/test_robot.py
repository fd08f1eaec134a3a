"""A simulated robot in the graph: it builds, is stopped, is killed and asked again."""

from __future__ import annotations

import os
import signal
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from blocks_planning_msgs.action import Place
from blocks_planning_msgs.msg import PlacementOutcome as Codes
from builders import CHAIR, spec
from graphs import (
    DEADLINE_S,
    bring_up,
    node_processes,
    wait_until,
    write_script,
)
from peers import Graph
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.node import Node
from rclpy.parameter import Parameter
from sensor_msgs.msg import JointState

from blocks_planning.board.blocks import Placed
from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.wire import qos
from blocks_planning.ros.wire.conversions.place import order_to_ros
from blocks_planning.trials.messages import ArmOrder, TrialStarted
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.world import Observed

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.ros.nodes.robot_arm import RobotArm

SPEC = replace(spec(CHAIR, lam=0.01, depth=2), world=Observed())
FAST = [Parameter('remind_period_s', value=0.1)]
NODES = ['world', 'subgoal_selector', 'action_searcher', 'robot_arm']
CELL_M = 0.04


class Trial:
    """A graph with a robot."""

    def __init__(self, graph: Graph, folder: Path, cell_m: float = CELL_M, **robot: Any) -> None:
        self.graph = graph
        self.folder = folder
        self.started = 0
        cell = Parameter('cell_size', value=cell_m)
        self.world = graph.add(world.make_node, parameter_overrides=[*FAST, cell])
        graph.add(subgoal_selector.make_node, parameter_overrides=FAST)
        graph.add(ActionSearcher, parameter_overrides=FAST)
        self.arm = self.add_robot(**robot)
        values = {'out_dir': str(folder), 'wait_for': NODES, 'retries': 1000}
        overrides = [*FAST, *(Parameter(name, value=value) for name, value in values.items())]
        self.node = graph.add(
            lambda **options: TrialOrchestrator(
                threading.Event(), parameter_overrides=overrides, **options
            )
        )
        graph.spin_until(lambda: not self.node.peers.missing(NODES))

    def add_robot(self, **values: Any) -> RobotArm:
        values = {'state_dir': str(self.folder / 'robot'), **values}
        overrides = [*FAST, *(Parameter(name, value=value) for name, value in values.items())]
        arm: RobotArm = self.graph.add(RobotArm, parameter_overrides=overrides)
        return arm

    def start(self) -> None:
        self.started += 1
        self.node.start_trial(f'trial {self.started}', SPEC)

    def record(self) -> TrialRecord:
        """The record of the trial when it is over; it holds."""
        self.graph.spin_until(lambda: not self.node.is_busy and not self.world.is_busy)
        self.graph.spin_until(lambda: not self.arm.is_busy)
        record: TrialRecord = self.node.memory.record()
        assert list(contradictions(record)) == []
        return record


def test_robot_builds_a_tower_trial_after_trial(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path)
    heard: list[JointState] = []
    viewer = graph.add(lambda **options: Node('viewer', **options))
    viewer.create_subscription(JointState, 'joint_states', heard.append, qos.stream())
    for _ in range(2):
        trial.start()
        record = trial.record()
        assert record.status is TrialStatus.SUCCESS
        assert len(record.observations) == record.blocks + 1
    assert list((tmp_path / 'robot').iterdir()) == []
    assert len({tuple(joints.position) for joints in heard}) > 5


def test_cancelled_trial_stops_the_arm_and_the_next_works(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path)
    trial.start()
    graph.spin_until(lambda: trial.arm.robot is not None and trial.arm.robot.is_busy)
    robot = trial.arm.robot
    assert robot is not None
    trial.node.cancel_trial()
    assert trial.record().status is TrialStatus.CANCELLED
    assert not robot.robot.is_moving
    assert not robot.is_busy
    trial.start()
    assert trial.record().status is TrialStatus.SUCCESS


def test_cancelled_goal_stops_the_arm(graph: Graph) -> None:
    """Although the trial goes on."""
    arm = graph.add(RobotArm)
    arm.take(TrialStarted('trial', SPEC))
    robot = arm.robot
    assert robot is not None
    asking = graph.add(lambda **options: Node('asking', **options))
    client = ActionClient(asking, Place, 'place')
    graph.spin_until(client.server_is_ready)
    goal = order_to_ros(ArmOrder('trial', 0, Placed(1, 2, 0, 0)), CELL_M)
    sent = client.send_goal_async(goal)
    graph.spin_until(lambda: robot.robot.is_moving)
    sent.result().cancel_goal_async()
    got = sent.result().get_result_async()
    graph.spin_until(got.done)
    assert got.result().status == GoalStatus.STATUS_CANCELED
    assert not robot.is_busy
    assert not robot.robot.is_moving


def test_robot_that_is_restarted_continues(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path)
    trial.start()
    graph.spin_until(lambda: list((tmp_path / 'robot').glob('*.robot')))
    graph.spin_until(lambda: trial.arm.robot is not None and trial.arm.robot.is_busy)
    assert trial.arm.robot is not None
    before = trial.arm.robot.robot.seen
    graph.remove(trial.arm)
    trial.arm = trial.add_robot()
    graph.spin_until(lambda: trial.arm.robot is not None)
    assert trial.arm.robot is not None
    assert trial.arm.robot.robot.seen == before
    assert trial.record().status is TrialStatus.SUCCESS


def test_cells_of_another_size_end_the_trial_with_the_reason(graph: Graph, tmp_path: Path) -> None:
    trial = Trial(graph, tmp_path, cell_m=0.05)
    trial.start()
    record = trial.record()
    assert record.status is TrialStatus.CANCELLED
    assert 'the order is for cells of 0.05 m, those of the robot have 0.04 m' in record.reason


def test_goal_of_an_unknown_trial_is_told_to_come_again(graph: Graph) -> None:
    graph.add(RobotArm)
    asking = graph.add(lambda **options: Node('asking', **options))
    client = ActionClient(asking, Place, 'place')
    graph.spin_until(client.server_is_ready)
    goal = order_to_ros(ArmOrder('elsewhere', 0, Placed(1, 1, 0, 0)), CELL_M)
    sent = client.send_goal_async(goal)
    graph.spin_until(sent.done)
    got = sent.result().get_result_async()
    graph.spin_until(got.done)
    result = got.result().result
    assert result.code == Codes.CODE_TRY_AGAIN
    assert result.reason == 'no trial elsewhere of world observed is announced on topic trial'


@pytest.mark.parametrize(
    ('values', 'complaint'),
    [
        ({'cell_m': 5.0}, 'parameter cell_m must be a float from 0.01 to 0.2, got 5.0'),
        ({'perception': 'smell'}, 'perception must be one of poses, camera, got .smell.'),
        ({'state_dir': '/dev/null/robot'}, 'parameter state_dir: /dev/null/robot cannot be made'),
    ],
)
def test_wrong_parameter_is_named(graph: Graph, values: dict[str, Any], complaint: str) -> None:
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    with pytest.raises(ConfigurationError, match=complaint):
        graph.add(RobotArm, parameter_overrides=overrides)


def small_script(folder: Path) -> Path:
    towers = folder / 'towers.txt'
    towers.write_text('tower block\n##\n##\n##\n', encoding='utf-8')
    return write_script(
        folder, stimuli=[str(towers)], library='2x1,1x2', worlds=[{'name': 'observed'}]
    )


def test_command_brings_the_robot_up_and_a_kill_is_survived(tmp_path: Path) -> None:
    script, out = small_script(tmp_path), tmp_path / 'out'
    with bring_up(script, '--out', out, '--robot', '--robot-setting', 'glue=false') as graph:
        wait_until(graph, lambda: list((out / 'robot').glob('*.robot')))
        os.kill(node_processes(graph.pid)['robot_arm'], signal.SIGKILL)
        assert graph.wait(DEADLINE_S) in (0, 1)
    (record,) = read_records(out / 'trials.jsonl')
    assert list(contradictions(record)) == []
    assert record.status is TrialStatus.SUCCESS or record.reason
