"""Everything that can go wrong with an act, and that the next one works."""

from __future__ import annotations

import pytest

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot.phases import ACT, Phase, Reason, Report
from blocks_planning.robot.robot import TICK, Robot
from blocks_planning.robot.scene import Pose
from blocks_planning.robot.settings import RobotSettings

BOARD = Board(4, 4)
FIRST, SECOND = Placement(Block(2, 1), 0), Placement(Block(1, 2), 3)
LONGEST_STOP_S = 0.2


def go_on_until(robot: Robot, phase: Phase) -> None:
    while robot.is_busy:
        if robot.step().phase is phase:
            return
    raise AssertionError(f'the act ended before {phase.value}')


def finish(robot: Robot) -> Report:
    for _ in range(10_000):
        report = robot.step().report
        if report is not None:
            robot.perceive()
            return report
    raise AssertionError('the act does not end')


def check_next_works(robot: Robot) -> None:
    assert robot.place(SECOND).reason is None
    assert Placed(1, 2, 3, 0) in robot.perceive().placed


def test_missing_block_is_not_grasped() -> None:
    robot = Robot(BOARD)
    robot.order(FIRST)
    robot.simulation.remove([0])
    report = finish(robot)
    assert (report.phase, report.reason) == (Phase.GRASP, Reason.NOTHING_GRASPED)
    assert robot.seen.placed == ()
    check_next_works(robot)


@pytest.mark.parametrize('phase', [Phase.LIFT, Phase.CARRY, Phase.LOWER])
def test_block_that_is_lost_on_the_way_is_dropped(phase: Phase) -> None:
    robot = Robot(BOARD, RobotSettings(glue=False))
    robot.order(FIRST)
    go_on_until(robot, phase)
    away = Pose((1.0, 0.5, 0.02))
    robot.simulation.place(0, away)
    report = finish(robot)
    assert (report.phase, report.reason) == (phase, Reason.DROPPED)
    assert [remark.number for remark in robot.seen.warnings] == [0]
    check_next_works(robot)


def test_weak_fingers_drop_a_heavy_block() -> None:
    robot = Robot(BOARD, RobotSettings(grip_force_n=0.5, density=5000))
    report = robot.place(Placement(Block(2, 2), 0))
    assert report.reason in (Reason.DROPPED, Reason.NOTHING_GRASPED)
    assert robot.perceive().placed == ()


def test_something_unseen_in_the_way_is_a_collision_and_the_block_is_brought_back() -> None:
    robot = Robot(BOARD)
    # The robot has not looked since, so it expects the ground.
    hidden = robot.simulation.add(Block(2, 3), 0.04)
    robot.simulation.glue([hidden])
    report = robot.place(FIRST)
    assert report.reason is Reason.COLLISION
    assert robot.simulation.is_at_feeder(1)
    assert robot.perceive().placed == (Placed(2, 3, 0, 0),)
    check_next_works(robot)


def test_block_that_would_not_end_on_the_board_is_out_of_reach() -> None:
    robot = Robot(BOARD)
    report = robot.place(Placement(Block(2, 1), 3))
    assert report.reason is Reason.OUT_OF_REACH
    assert 'column 3' in report.text
    assert robot.perceive().placed == ()
    check_next_works(robot)


@pytest.mark.parametrize('phase', ACT)
def test_cancel_stops_the_arm_and_the_next_order_works(phase: Phase) -> None:
    robot = Robot(BOARD, RobotSettings(glue=False))
    robot.order(FIRST)
    go_on_until(robot, phase)
    for _ in range(3):
        if robot.is_busy:
            robot.step()
    held = robot.held
    cancelled = robot.time
    robot.cancel()
    report = finish(robot)
    assert robot.time - cancelled <= LONGEST_STOP_S
    assert report.reason is Reason.CANCELLED
    assert not robot.is_busy
    assert not robot.is_moving
    for _ in range(round(0.5 / TICK)):
        robot.step()
    assert abs(robot.simulation.speeds).max() < 0.005
    assert robot.held == held
    check_next_works(robot)


def test_first_block_may_be_higher_than_the_arm_at_rest() -> None:
    robot = Robot(Board(4, 6))
    tall = Placement(Block(1, 5), 0)
    robot.order(tall)
    assert robot.simulation.bodies == ()  # the arm moves up first
    assert finish(robot).reason is None
    assert robot.seen.placed == (Placed(1, 5, 0, 0),)


def test_glued_block_is_not_held_after_a_cancel() -> None:
    robot = Robot(BOARD)
    robot.order(FIRST)
    go_on_until(robot, Phase.RELEASE)
    robot.cancel()
    assert finish(robot).reason is Reason.CANCELLED
    assert robot.held is None
    assert robot.seen.placed == (Placed(2, 1, 0, 0),)
    check_next_works(robot)


def test_cancel_without_an_order_changes_nothing() -> None:
    robot = Robot(BOARD)
    robot.cancel()
    assert robot.step().report is None
    check_next_works(robot)


def test_block_that_is_pushed_is_seen_where_it_is() -> None:
    robot = Robot(BOARD, RobotSettings(glue=False))
    robot.place(FIRST)
    before = robot.perceive()
    robot.simulation.push(0, (0.9, 0.0, 0.0))
    for _ in range(100):
        robot.step()
    assert robot.perceive().placed != before.placed


def test_reason_is_that_of_the_first_failure() -> None:
    """Even if the block cannot be brought back afterwards."""
    robot = Robot(BOARD)
    hidden = robot.simulation.add(Block(2, 3), 0.04)
    robot.simulation.glue([hidden])
    robot.order(FIRST)
    go_on_until(robot, Phase.BRING_BACK)
    robot._behaviour.memory.entered = -1000.0
    report = finish(robot)
    assert (report.phase, report.reason) == (Phase.CARRY, Reason.COLLISION)
    assert report.text == 'carry: the arm was blocked'


@pytest.mark.parametrize(
    ('y', 'orientation'),
    [(0.03, (1.0, 0.0, 0.0, 0.0)), (0.0, (0.5**0.5, 0.5**0.5, 0.0, 0.0))],
    ids=['in front of the board', 'on its face'],
)
def test_block_that_left_the_plane_of_the_board_does_not_stand_on_it(
    y: float, orientation: tuple[float, float, float, float]
) -> None:
    robot = Robot(BOARD, RobotSettings(glue=False))
    robot.place(FIRST)
    assert robot.perceive().placed == (Placed(2, 1, 0, 0),)
    x, middle, z = robot.simulation.pose(0).position
    robot.simulation.place(0, Pose((x, middle + y, z), orientation))
    seen = robot.perceive()
    assert seen.placed == ()
    assert [remark.number for remark in seen.warnings] == [0]
