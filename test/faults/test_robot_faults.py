"""A few cancels and kills of the robot; ``make robot-faults`` has many."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from faults.robot import STOP_S, Report, cancel_often, kill_often


def test_robot_is_safe_after_cancels_at_any_moment() -> None:
    report = Report()
    cancel_often(report, count=5, seed=1)
    assert report.complaints == []
    assert report.cancels.total() == 5
    assert 0 < report.slowest_stop_s <= STOP_S


@pytest.mark.long
def test_trials_end_though_the_robot_is_killed(tmp_path: Path) -> None:
    report = Report()
    kill_often(report, tmp_path, count=2, seed=1)
    assert report.complaints == []
    assert report.kills == 2
    assert report.ends.total() >= 2
