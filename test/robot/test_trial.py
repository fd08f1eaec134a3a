"""A robot in a trial: each order is carried out once, and what is perceived is reported."""

from __future__ import annotations

from pathlib import Path

import pytest

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from blocks_planning.robot.fitting import Misfit, Perceived, Remark
from blocks_planning.robot.phases import Phase, Reason, Report
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.trial import Conditions, RobotTrial, report_of

CONDITIONS = Conditions(Board(4, 4), RobotSettings(), seed=3)
LOW, ABOVE, BESIDE = Placed(2, 1, 0, 0), Placed(1, 2, 0, 1), Placed(2, 1, 2, 0)
FIRST, SECOND = ArmOrder('one', 0, LOW), ArmOrder('one', 1, ABOVE)


def carry_out(trial: RobotTrial, order: ArmOrder) -> ArmReport:
    report = trial.take(order)
    while report is None:
        _, report = trial.step()
    return report


def told(order: ArmOrder, reason: Reason | None, before: Perceived, after: Perceived) -> ArmReport:
    phase = Phase.LOWER if reason else Phase.SETTLE
    text = f'it was {reason.value}' if reason else ''
    report = Report(order.placed.placement, phase, reason, text, 5.0, settled=True)
    return report_of(order, report, before, after)


def test_two_orders_are_placed() -> None:
    trial = RobotTrial('one', CONDITIONS)
    for order in (FIRST, SECOND):
        report = carry_out(trial, order)
        assert report == order.report(PlacementCode.PLACED, landed=(order.placed,))
    assert trial.robot.seen.placed == (LOW, ABOVE)
    assert not trial.is_busy


def test_order_that_is_asked_for_again_is_carried_out_once() -> None:
    trial = RobotTrial('one', CONDITIONS)
    trial.take(FIRST)
    trial.step()
    assert trial.take(FIRST) is None
    assert trial.is_busy
    report = carry_out(trial, FIRST)
    time = trial.robot.time
    assert trial.take(FIRST) == report
    assert trial.robot.time == time


def test_stop_leaves_the_board_and_the_next_order_works() -> None:
    trial = RobotTrial('one', CONDITIONS)
    trial.take(FIRST)
    while trial.step()[0].phase is not Phase.CARRY:
        pass
    time = trial.robot.time
    trial.stop()
    assert not trial.is_busy
    assert not trial.robot.is_moving
    assert trial.robot.time - time < 0.2
    assert carry_out(trial, FIRST).code is PlacementCode.PLACED


def test_kept_state_continues_where_it_was(tmp_path: Path) -> None:
    trial = RobotTrial('one', CONDITIONS, tmp_path / 'one')
    first = carry_out(trial, FIRST)
    trial.take(SECOND)
    trial.step()
    again = RobotTrial('one', CONDITIONS, tmp_path / 'one')
    assert again.robot.seen == trial.robot.seen
    assert again.take(FIRST) == first
    assert carry_out(again, SECOND) == SECOND.report(PlacementCode.PLACED, landed=(ABOVE,))
    again.forget()
    assert list(tmp_path.iterdir()) == []


def test_trial_that_begins_anew_has_an_empty_board(tmp_path: Path) -> None:
    carry_out(RobotTrial('one', CONDITIONS, tmp_path / 'one'), FIRST)
    trial = RobotTrial('one', CONDITIONS, tmp_path / 'one')
    other = ArmOrder('one', 0, BESIDE)
    assert carry_out(trial, other).landed == (BESIDE,)
    assert trial.robot.seen.placed == (BESIDE,)


def test_order_for_another_board_is_refused() -> None:
    trial = RobotTrial('one', CONDITIONS)
    report = trial.take(SECOND)
    assert report is not None
    assert report.code is PlacementCode.FAILED
    assert report.reason.startswith('the order refers to state 1 of the board, but the robot has')


@pytest.mark.parametrize(
    'spoil', [lambda data: data[:-1], lambda data: b'{}' + data[data.index(b'\n') :]]
)
def test_damaged_state_is_refused(tmp_path: Path, spoil: object) -> None:
    carry_out(RobotTrial('one', CONDITIONS, tmp_path / 'one'), FIRST)
    (path,) = tmp_path.iterdir()
    path.write_bytes(spoil(path.read_bytes()))  # type: ignore[operator]
    with pytest.raises(InvalidInput, match='damaged'):
        RobotTrial('one', CONDITIONS, tmp_path / 'one')


@pytest.mark.parametrize(
    ('reason', 'code'),
    [
        (None, PlacementCode.LOST),
        (Reason.DROPPED, PlacementCode.LOST),
        (Reason.NOTHING_GRASPED, PlacementCode.TRY_AGAIN),
        (Reason.COLLISION, PlacementCode.TRY_AGAIN),
        (Reason.CANCELLED, PlacementCode.TRY_AGAIN),
        (Reason.OUT_OF_REACH, PlacementCode.IMPOSSIBLE),
    ],
)
def test_board_that_did_not_change(reason: Reason | None, code: PlacementCode) -> None:
    report = told(FIRST, reason, Perceived(), Perceived())
    assert (report.code, report.landed, report.gone) == (code, (), ())
    assert report.reason == (f'it was {reason.value}' if reason else '')


def test_board_that_changed_otherwise() -> None:
    before = Perceived(((0, BESIDE),))
    moved = Perceived(((0, Placed(2, 1, 1, 0)), (1, ABOVE)))
    slipped = told(SECOND, None, before, moved)
    assert slipped.code is PlacementCode.SLIPPED
    assert (slipped.landed, slipped.gone) == ((Placed(2, 1, 1, 0), ABOVE), (BESIDE,))
    lost = told(FIRST, Reason.COLLISION, before, Perceived())
    assert (lost.code, lost.gone) == (PlacementCode.LOST, (BESIDE,))


def test_heap_has_collapsed() -> None:
    heap = Perceived((), (Remark(Misfit.IMPOSSIBLE, 0, 'block 2x1 is in an impossible place'),))
    report = told(SECOND, None, Perceived(((0, LOW),)), heap)
    assert report.code is PlacementCode.COLLAPSED
    assert report.reason == 'block 2x1 is in an impossible place'
