"""What viewers are told of a scene: boxes, and where the camera is."""

from __future__ import annotations

import pytest

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.board.geometry import Board

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from math import radians, tan

from blocks_planning.robot.looking import camera_pose, focal_length, shapes_of
from blocks_planning.robot.robot import Robot


def test_shapes_are_arm_board_and_blocks_where_they_are() -> None:
    robot = Robot(Board(4, 4))
    robot.place(Placement(Block(2, 1), 1))
    shapes = {shape.name: shape for shape in shapes_of(robot.simulation)}
    assert {'board', 'feeder', 'beam', 'palm', 'finger_front_pad', 'block_0'} <= shapes.keys()
    block = shapes['block_0']
    assert block.size == pytest.approx((0.0795, 0.0395, 0.04))
    assert block.pose.position == pytest.approx((0.08, 0.02, 0.02), abs=5e-4)
    assert block.pose.orientation == pytest.approx((1, 0, 0, 0), abs=1e-3)
    x, z = robot.simulation.joints[:2]
    assert shapes['mast'].pose.position[0] == pytest.approx(x)
    assert shapes['finger_front_pad'].pose.position[2] == pytest.approx(z)


def test_camera_looks_along_y_and_slightly_down() -> None:
    pose = camera_pose(Robot(Board(4, 4)).simulation)
    assert pose.position[1] < 0 < pose.position[2]
    w, x, y, z = pose.orientation
    # The optical axis is z of the frame, and its y axis points down.
    forwards = (2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y))
    down = (2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x))
    assert forwards[1] > 0.9
    assert -0.4 < forwards[2] < 0
    assert down[2] < -0.9


def test_focal_length_follows_from_the_angle_of_view() -> None:
    simulation = Robot(Board(4, 4)).simulation
    assert focal_length(simulation, 400) == pytest.approx(200 / tan(radians(21)))
