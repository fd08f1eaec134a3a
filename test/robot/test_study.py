"""Planners with a robot in one process, and the study of robots that err."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, spec

from blocks_planning.board.blocks import Placed
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.world import Observed

pytest.importorskip(
    'mujoco', reason='the extra robot is not installed: pip install -r requirements/lock-robot.txt'
)

from dataclasses import replace

from blocks_planning.analysis.embodied import answers, summarise
from blocks_planning.analysis.embodied_report import write_embodied
from blocks_planning.robot.building import RETRIES, Building, build
from blocks_planning.robot.phases import Reason
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.study import ROWS, Study, case_of, run_case, run_study
from blocks_planning.robot.trial import Conditions, RobotTrial
from blocks_planning.trials.local import LocalTrial
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode

SPEC = replace(spec(CHAIR, lam=0.01, depth=2), world=Observed())
SMALL = Study(('cogsci2021/13',), robots=('glued, pose 8 mm',), planners=('scoping subgoal',))


def unseen(_: int, __: int) -> None:
    """Progress that nobody looks at."""


def test_robot_builds_what_the_planner_orders() -> None:
    built = build(SPEC, RobotSettings())
    record = built.record
    assert record.status is TrialStatus.SUCCESS
    assert built.score.is_perfect
    assert built.codes == {PlacementCode.PLACED: record.orders}
    assert not built.reasons
    assert list(contradictions(record)) == []


@pytest.mark.parametrize('glue', [True, False])
def test_blocks_that_stand_at_the_start_are_built_upon(glue: bool) -> None:
    placements = build(SPEC, RobotSettings()).record.placements
    begun = replace(SPEC, built=placements[:2])
    built = build(begun, RobotSettings(glue=glue))
    assert built.record.status is TrialStatus.SUCCESS
    assert built.record.placements[:2] == placements[:2]
    assert built.score.is_perfect
    bodies = built.robot.robot.simulation.bodies
    assert [body.fixed for body in bodies[:2]] == [glue, glue]
    assert list(contradictions(built.record)) == []


@pytest.mark.parametrize(
    ('code', 'times', 'reason'),
    [
        (PlacementCode.TRY_AGAIN, 1 + RETRIES, f'the order was given {1 + RETRIES} times: no'),
        (PlacementCode.IMPOSSIBLE, 1 + RETRIES, f'the order was given {1 + RETRIES} times: no'),
        (PlacementCode.FAILED, 1, 'no'),
    ],
)
def test_order_that_is_not_carried_out_ends_the_trial_with_the_reason(
    monkeypatch: pytest.MonkeyPatch, code: PlacementCode, times: int, reason: str
) -> None:
    orders = []

    def refuse(_: Building, order: ArmOrder) -> ArmReport:
        orders.append(order)
        return order.report(code, reason='no')

    monkeypatch.setattr(Building, 'act', refuse)
    record = build(SPEC, RobotSettings()).record
    assert (record.status, record.reason) == (TrialStatus.CANCELLED, reason)
    assert len(orders) == times
    assert list(contradictions(record)) == []


def test_failures_are_counted_by_reason() -> None:
    trial = LocalTrial(SPEC)
    conditions = Conditions(SPEC.task.board, RobotSettings(), 0)
    building = Building(trial, RobotTrial(SPEC.trial_id, conditions))
    order = ArmOrder(SPEC.trial_id, 0, Placed(2, 1, 3, 0))  # beyond the edge of the board
    assert building.act(order).code is PlacementCode.IMPOSSIBLE
    assert building.codes == {PlacementCode.IMPOSSIBLE: 1}
    assert building.reasons == {Reason.OUT_OF_REACH: 1}


def test_study_continues_where_it_was_interrupted(tmp_path: Path) -> None:
    [case] = SMALL.cases()
    row = run_case(case)
    assert case_of(row) == case
    assert row['surprises'] > 0
    assert row['contradictions'] == []
    assert run_study(SMALL, tmp_path / 'new', 1, unseen) == [row]
    told = []
    (tmp_path / 'old').mkdir()
    lines = json.dumps({**row, 'f1': 0.25}) + '\n' + '{"robot": "glu'
    (tmp_path / 'old' / ROWS).write_text(lines)
    found = run_study(SMALL, tmp_path / 'old', 1, lambda *counts: told.append(counts))
    assert found == [{**row, 'f1': 0.25}]
    assert told == [(1, 1)]


def row(planner: str, stimulus: str, success: bool, states: int, **more: Any) -> dict[str, Any]:
    return {
        'robot': 'a',
        'planner': planner,
        'stimulus': stimulus,
        'seed': 0,
        'status': 'stuck',
        'success': success,
        'f1': 0.5,
        'blocks': 4,
        'surprises': 0,
        'acts': 5,
        'codes': {},
        'failures': {},
        'states': states,
        'simulated_s': 10.0,
        'contradictions': [],
        **more,
    }


ROWS_BY_HAND = [
    row('scoping subgoal', 't1', True, 100, surprises=2, codes={'placed': 3, 'slipped': 2}),
    row('scoping subgoal', 't2', False, 100, surprises=1, codes={'lost': 1, 'placed': 4}),
    row('full replan', 't1', False, 400, failures={'collision': 3}),
    row('full replan', 't2', False, 1600),
]


def test_results_of_a_study_by_hand(tmp_path: Path) -> None:
    results = write_embodied(ROWS_BY_HAND, tmp_path, ['a note'])
    near, far = results['cells']
    assert (near['success']['mean'], far['success']['mean']) == (0.5, 0.0)
    assert (near['surprised'], near['recovered']) == (2, 1)
    assert near['outcomes'] == {'lost': 1, 'placed': 7, 'slipped': 2}
    assert near['seconds_per_act']['mean'] == 2.0
    assert far['failures'] == {'collision': 3}
    assert far['ends'] == {'stuck': 2}
    [advantage] = results['advantages']
    assert advantage['success']['mean'] == 0.5
    assert advantage['success']['ci'] == [0, 1]
    assert advantage['log2_cost_ratio']['mean'] == pytest.approx(3)
    assert json.loads((tmp_path / 'results.json').read_text()) == results
    html = (tmp_path / 'report.html').read_text()
    assert 'a note' in html
    assert 'lost 1, placed 7, slipped 2' in html
    assert results['answers'] == answers(summarise(ROWS_BY_HAND))
    assert results['answers'][0].startswith('a: scoping rebuilds 50 (')
    assert 'evaluates 8.0 (4.0 to 16.0) times fewer states' in results['answers'][0]
