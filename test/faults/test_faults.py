"""A short plan of faults, and what plans and reports are."""

from __future__ import annotations

from pathlib import Path

import pytest
from graphs import local_lines, write_script

from faults.harness import Harness
from faults.judging import verify_bag
from faults.plan import BRINGUP, NODES, PHASES, make_plan
from faults.report import Report


def test_plan_comes_from_its_seed() -> None:
    assert list(make_plan(3, 50)) == list(make_plan(3, 50))
    assert list(make_plan(3, 50)) != list(make_plan(4, 50))


@pytest.mark.parametrize('seed', range(5))
def test_plan_kills_every_node_in_every_phase(seed: int) -> None:
    plan = list(make_plan(seed, 80))
    kills = [fault for fault in plan if fault.kills]
    assert len(kills) == 80
    pairs = {(node, phase) for node in NODES for phase in PHASES}
    assert pairs | {(BRINGUP, 'any')} == {(fault.node, fault.phase) for fault in kills}
    assert {fault.kind for fault in plan} == {'kill', 'late', 'pause', 'copy'}


def test_report_sees_what_is_lost_changed_or_doubled() -> None:
    report = Report()
    report.compare(['a', 'b', 'c'], ['a', 'b', 'c'])
    assert report.is_good
    for found, lost, changed in (
        (['a', 'b'], 1, 0),
        (['a', 'x', 'c'], 1, 1),
        (['a', 'b', 'b', 'c'], 0, 1),
    ):
        report = Report()
        report.compare(found, ['a', 'b', 'c'])
        assert (report.trials, report.lost, report.changed) == (3, lost, changed)
        assert not report.is_good
    report = Report()
    report.compare(['b', 'a'], ['a', 'b'])
    assert not report.is_good


def test_nothing_is_lost_by_a_short_plan(tmp_path: Path) -> None:
    harness = Harness(tmp_path, seed=5, kills=4, trials=8, pace_s=0.03)
    try:
        report = harness.run(per_script=8)
    finally:
        harness.close()
    assert report.is_good, '\n'.join(report.lines())
    assert report.kills.total() == 4
    assert report.trials >= 8


def test_harness_sees_a_record_that_was_changed(tmp_path: Path) -> None:
    """The same that is asked of a good one, of one that is not."""
    script = write_script(tmp_path)
    (line,) = local_lines(script)
    report = Report()
    report.compare([line.replace('"blocks":', '"blocks": ')], [line])
    assert (report.lost, report.changed) == (1, 1)
    with pytest.raises(Exception, match='does not exist'):
        verify_bag(tmp_path / 'bag')
