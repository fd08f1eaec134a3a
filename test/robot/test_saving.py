from __future__ import annotations

import random

import pytest

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot.robot import Robot
from blocks_planning.robot.settings import RobotSettings

BOARD = Board(4, 4)
SETTINGS = RobotSettings(glue=False, pose_noise_m=0.001, grip_noise_m=0.0005)
ORDERS = [Placement(Block(2, 1), 0), Placement(Block(1, 2), 3)]


def carry_on(robot: Robot, ticks: int) -> None:
    """Go on with the orders, one after the other, for so many ticks."""
    for _ in range(ticks):
        if not robot.is_busy and robot.simulation.next_number < len(ORDERS):
            robot.order(ORDERS[robot.simulation.next_number])
        if robot.step().report is not None:
            robot.perceive()


@pytest.mark.parametrize('seed', range(4))
def test_restored_robot_goes_on_to_the_last_bit(seed: int) -> None:
    ticks = random.Random(seed).randrange(1, 700)
    robot = Robot(BOARD, SETTINGS, seed)
    carry_on(robot, ticks)
    saved = robot.state()
    other = Robot(BOARD, SETTINGS, seed)
    other.restore(saved)
    assert other.state() == saved
    for _ in range(3):
        carry_on(robot, 120)
        carry_on(other, 120)
        assert other.state() == robot.state()


def test_same_seed_same_result_another_seed_another() -> None:
    def state(seed: int) -> bytes:
        robot = Robot(BOARD, SETTINGS, seed)
        carry_on(robot, 500)
        return robot.state()

    assert state(3) == state(3) != state(4)


def test_damaged_or_foreign_state_is_refused_and_changes_nothing() -> None:
    robot = Robot(BOARD, SETTINGS)
    carry_on(robot, 30)
    saved = robot.state()
    other = Robot(BOARD, SETTINGS)
    untouched = other.state()
    flipped = bytearray(saved)
    flipped[len(saved) // 2] ^= 1
    for data in (b'', saved[:-1], bytes(flipped)):
        with pytest.raises(InvalidInput, match='damaged'):
            other.restore(data)
    assert other.state() == untouched
    with pytest.raises(InvalidInput, match='same board and settings'):
        Robot(Board(5, 4), SETTINGS).restore(saved)
    with pytest.raises(InvalidInput, match='same board and settings'):
        Robot(BOARD, RobotSettings()).restore(saved)
