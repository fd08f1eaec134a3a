"""What ROS tools see of the robot: joints, shapes, pictures, frames and the clock."""

from __future__ import annotations

import json
from collections import defaultdict
from typing import Any

import pytest
import yaml
from peers import Graph
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import CameraInfo, Image, JointState
from source_imports import ROOT
from std_msgs.msg import Header
from visualization_msgs.msg import Marker, MarkerArray

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire import qos

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot.gantry import JOINTS
from blocks_planning.robot.rendering import why_blind
from blocks_planning.robot.robot import Robot
from blocks_planning.robot.scene import Pose
from blocks_planning.ros.runtime.guarded import GuardedNode
from blocks_planning.ros.runtime.showing import HEIGHT, PERIOD_S, WIDTH, Shower
from blocks_planning.ros.wire.conversions.robot import transforms_to_ros

BOARD = Board(4, 4)


class Stage:
    """A shower, and what is heard of it."""

    def __init__(
        self, graph: Graph, camera_period_s: float = 0.0, has_clock: bool = False
    ) -> None:
        self.graph = graph
        self.heard: dict[str, list[Any]] = defaultdict(list)
        listener = graph.add(lambda **options: Node('viewer', **options))
        for kind, name, profile in (
            (JointState, 'joint_states', qos.stream()),
            (MarkerArray, 'robot/markers', qos.every_latched_state()),
            (Image, 'camera/image_raw', qos.stream()),
            (CameraInfo, 'camera/camera_info', qos.stream()),
            (Clock, '/clock', qos.stream()),
        ):
            listener.create_subscription(kind, name, self.heard[name].append, profile)
        self.node = graph.add(lambda **options: GuardedNode('shower', **options))
        self.shower = Shower(self.node, 'board', camera_period_s, has_clock)
        publishers = ['joint_states', 'robot/markers', *(['/clock'] if has_clock else [])]
        graph.spin_until(lambda: all(map(self._is_matched, publishers)))

    def _is_matched(self, name: str) -> bool:
        return self.node.count_subscribers(name) > 0

    def hear(self, name: str, count: int = 1) -> list[Any]:
        self.graph.spin_until(lambda: len(self.heard[name]) >= count)
        return self.heard[name]


def test_joints_and_shapes_are_those_of_the_robot(graph: Graph) -> None:
    stage, robot = Stage(graph), Robot(BOARD)
    robot.place(Placement(Block(2, 1), 0))
    stage.shower.show(robot, 1.0)
    [joints] = stage.hear('joint_states')
    assert joints.name == list(JOINTS)
    assert list(joints.position) == robot.simulation.joints.tolist()
    assert list(joints.velocity) == robot.simulation.speeds.tolist()
    assert joints.header.frame_id == 'board'
    [shapes] = stage.hear('robot/markers')
    clear, *boxes = shapes.markers
    assert clear.action == Marker.DELETEALL
    assert sorted({box.ns for box in boxes}) == ['blocks', 'robot']
    [block] = [box for box in boxes if box.ns == 'blocks']
    assert block.scale.x == pytest.approx(0.0795)
    assert block.pose.position.x == pytest.approx(0.04, abs=5e-4)


def test_messages_are_rare_in_an_act_and_come_after_it(graph: Graph) -> None:
    stage, robot = Stage(graph), Robot(BOARD)
    robot.order(Placement(Block(2, 1), 0))
    for now_s in (1.0, 1.0 + PERIOD_S / 2, 1.0 + PERIOD_S):
        robot.step()
        stage.shower.show(robot, now_s)
    while robot.is_busy:
        robot.step()
    stage.shower.show(robot, 1.0 + PERIOD_S)
    other = Robot(BOARD)
    stage.shower.show(other, 1.0 + PERIOD_S)
    stage.hear('joint_states', 4)
    assert [list(one.position) for one in stage.heard['joint_states'][2:]] == [
        one.simulation.joints.tolist() for one in (robot, other)
    ]


def test_viewer_that_comes_late_sees_the_scene_after_the_act(graph: Graph) -> None:
    node = graph.add(lambda **options: GuardedNode('shower', **options))
    shower, robot = Shower(node, 'board', 0.0, has_clock=False), Robot(BOARD)
    robot.order(Placement(Block(2, 1), 0))
    for now_s in (1.0, 2.0):
        robot.step()
        shower.show(robot, now_s)
    robot.cancel()
    while robot.is_busy:
        robot.step()
    shower.show(robot, 2.0)
    viewer = graph.add(lambda **options: Node('viewer', **options))
    heard: list[MarkerArray] = []
    viewer.create_subscription(
        MarkerArray, 'robot/markers', heard.append, qos.every_latched_state()
    )
    graph.spin_until(lambda: heard)
    assert len(heard) == 1
    assert any(box.ns == 'blocks' for box in heard[0].markers)


def test_clock_never_goes_back(graph: Graph) -> None:
    stage = Stage(graph, has_clock=True)
    for robot in (Robot(BOARD), Robot(BOARD)):
        for _ in range(2):
            robot.step()
            stage.shower.show(robot, 1.0)
    times = [one.clock.sec * 10**9 + one.clock.nanosec for one in stage.hear('/clock', 4)]
    assert times == sorted(times)
    assert times[1] - times[0] == times[3] - times[2] == 10**7
    assert stage.hear('joint_states')[0].header.stamp == stage.heard['/clock'][0].clock


def test_pictures_and_the_camera_are_published(graph: Graph) -> None:
    robot = Robot(BOARD)
    if why_blind(robot.simulation):
        pytest.skip(why_blind(robot.simulation))
    stage = Stage(graph, camera_period_s=1.0)
    graph.spin_until(lambda: stage.node.count_subscribers('camera/image_raw'))
    for now_s in (1.0, 1.5, 2.0):
        robot.step()
        stage.shower.show(robot, now_s)
    pictures, lenses = stage.hear('camera/image_raw', 2), stage.hear('camera/camera_info', 2)
    assert [len(pictures), len(lenses)] == [2, 2]
    picture, lens = pictures[0], lenses[0]
    assert (picture.width, picture.height, picture.encoding) == (WIDTH, HEIGHT, 'rgb8')
    assert len(picture.data) == HEIGHT * picture.step == HEIGHT * WIDTH * 3
    assert len(set(picture.data)) > 10
    assert (lens.width, lens.height) == (WIDTH, HEIGHT)
    assert (lens.k[2], lens.k[5]) == (WIDTH / 2, HEIGHT / 2)
    assert picture.header == lens.header
    assert picture.header.frame_id == 'camera'


def test_blind_machine_says_so_once(graph: Graph, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('blocks_planning.robot.rendering.BACKENDS', ())
    monkeypatch.delenv('MUJOCO_GL', raising=False)
    stage, robot = Stage(graph, camera_period_s=1.0), Robot(BOARD)
    said: list[str] = []
    monkeypatch.setattr(stage.node.get_logger(), 'warning', said.append)
    for now_s in (1.0, 2.0):
        stage.shower.show(robot, now_s)
    assert len(said) == 1
    assert said[0].startswith('no pictures on camera/image_raw: this machine cannot render')
    assert len(stage.hear('joint_states', 2)) == 2


def test_frames_are_in_that_of_the_board() -> None:
    poses = {
        'tool': Pose((0.1, 0.02, 0.3)),
        'block_2': Pose((1.0, 2.0, 3.0), (0.6, 0.0, 0.8, 0.0)),
    }
    tool, block = transforms_to_ros(poses, Header(frame_id='board'))
    assert (tool.header.frame_id, tool.child_frame_id) == ('board', 'tool')
    assert block.child_frame_id == 'block_2'
    moved, turned = block.transform.translation, block.transform.rotation
    assert (moved.x, moved.y, moved.z) == (1.0, 2.0, 3.0)
    assert (turned.w, turned.x, turned.y, turned.z) == (0.6, 0.0, 0.8, 0.0)


def test_files_for_viewers_show_what_is_published() -> None:
    rviz = yaml.safe_load((ROOT / 'config' / 'robot.rviz').read_text(encoding='utf-8'))
    manager = rviz['Visualization Manager']
    topics = {one['Name']: one['Topic']['Value'] for one in manager['Displays'] if 'Topic' in one}
    assert topics == {'Robot': '/robot/markers', 'Camera': '/camera/image_raw'}
    assert manager['Global Options']['Fixed Frame'] == 'board'
    foxglove = json.loads((ROOT / 'config' / 'robot_foxglove.json').read_text(encoding='utf-8'))
    panels = foxglove['configById']
    assert list(panels['3D!robot']['topics']) == ['/robot/markers']
    assert panels['Image!camera']['imageMode']['imageTopic'] == '/camera/image_raw'
    assert panels['RawMessages!joints']['topicPath'] == '/joint_states'
