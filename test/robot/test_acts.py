from __future__ import annotations

import pytest

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError, InvalidInput

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot.driving import carry_out, carry_out_all, score
from blocks_planning.robot.phases import ACT, BOUNDS_S, Phase
from blocks_planning.robot.robot import TICK, Robot
from blocks_planning.robot.settings import RobotSettings

BOARD = Board(4, 4)
ORDERS = [Placement(Block(2, 1), 0), Placement(Block(1, 2), 2), Placement(Block(2, 2), 0)]
PLACED = (Placed(2, 1, 0, 0), Placed(1, 2, 2, 0), Placed(2, 2, 0, 1))


@pytest.mark.parametrize('glue', [True, False])
def test_blocks_stand_where_they_were_ordered(glue: bool) -> None:
    robot = Robot(BOARD, RobotSettings(glue=glue))
    acts = carry_out_all(robot, ORDERS)
    assert robot.seen.placed == PLACED
    assert robot.seen.warnings == ()
    assert not any(act.is_surprise or act.report.reason for act in acts)
    assert all(act.report.settled for act in acts)
    for number, placed in enumerate(PLACED):
        x, y, z = robot.simulation.pose(number).position
        assert x == pytest.approx(0.04 * (placed.column + placed.width / 2), abs=0.0005)
        assert y == pytest.approx(0.02, abs=0.0005)
        assert z == pytest.approx(0.04 * (placed.row + placed.height / 2), abs=0.0005)


def test_phases_follow_one_another_within_their_bounds() -> None:
    robot = Robot(BOARD)
    robot.order(ORDERS[0])
    phases: list[Phase] = []
    entered: dict[Phase, float] = {}
    time = robot.time
    while robot.is_busy:
        progress = robot.step()
        assert progress.time == pytest.approx(time + TICK)
        time = progress.time
        if progress.phase not in phases:
            phases.append(progress.phase)
        entered[progress.phase] = entered.get(progress.phase, 0) + TICK
    assert phases == [*ACT, Phase.IDLE]
    assert all(entered[phase] < BOUNDS_S[phase] for phase in ACT)
    assert progress.report is not None
    assert progress.report.seconds == pytest.approx(time, abs=2 * TICK)


def test_glue_holds_what_would_topple() -> None:
    overhanging = [Placement(Block(1, 2), 0), Placement(Block(4, 1), 0)]
    glued, loose = Robot(BOARD), Robot(BOARD, RobotSettings(glue=False))
    carry_out_all(glued, overhanging)
    assert glued.seen.placed == (Placed(1, 2, 0, 0), Placed(4, 1, 0, 2))
    *_, last = carry_out_all(loose, overhanging)
    assert last.is_surprise
    assert loose.seen.placed != glued.seen.placed


def test_grip_noise_moves_a_block_and_follows_from_the_seed() -> None:
    def x(seed: int) -> float:
        robot = Robot(BOARD, RobotSettings(grip_noise_m=0.004), seed)
        robot.place(ORDERS[0])
        return robot.simulation.pose(0).position[0]

    one, same, other = x(1), x(1), x(2)
    assert one == same != other
    assert abs(one - 0.04) > 1e-4


def test_pose_noise_moves_what_is_seen_and_nothing_else() -> None:
    robot = Robot(BOARD, RobotSettings(pose_noise_m=0.02), seed=5)
    robot.place(ORDERS[0])
    pose = robot.simulation.pose(0)
    looks = [robot.perceive() for _ in range(20)]
    assert len({look.placed for look in looks}) > 1
    assert robot.simulation.pose(0) == pose
    again = Robot(BOARD, RobotSettings(pose_noise_m=0.02), seed=5)
    again.place(ORDERS[0])
    assert [again.perceive() for _ in range(20)] == looks


def test_second_order_is_refused_while_one_is_carried_out() -> None:
    robot = Robot(BOARD)
    robot.order(ORDERS[0])
    with pytest.raises(InvalidInput, match='another order'):
        robot.order(ORDERS[1])


def test_settings_out_of_range_are_refused() -> None:
    with pytest.raises(ConfigurationError, match='pose_noise_m'):
        RobotSettings(pose_noise_m=-1)
    with pytest.raises(ConfigurationError, match='perception'):
        RobotSettings(perception='smell')


def test_score_compares_cells() -> None:
    found = score(0b1111, 0b10_1111)
    assert found.recall == 1.0
    assert found.precision == pytest.approx(4 / 5)
    assert found.f1 == pytest.approx(8 / 9)
    assert not found.is_perfect
    assert score(0b11, 0b11).is_perfect
    assert score(0b11, 0).f1 == 0


def test_surprise_is_anything_but_the_expected_block() -> None:
    robot = Robot(BOARD)
    act = carry_out(robot, ORDERS[0])
    assert act.expected == PLACED[0]
    assert act.change.landed == PLACED[:1]
    assert not act.is_surprise
