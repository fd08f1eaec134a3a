from __future__ import annotations

from dataclasses import replace

import pytest
from builders import row_regions

from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import palette
from blocks_planning.view.panel import panel
from blocks_planning.view.scene import Scene, last_scene, scene_of, scenes_of


def lines_of(scene: Scene, width: int = 42, height: int = 22) -> list[str]:
    return panel(scene, width, height).plain.split('\n')


def test_before_the_first_decision(tower_spec):
    assert lines_of(scene_of(tower_spec())) == [
        'cogsci2021/9',
        'strategy   scoping, lambda 0.002',
        'search     bfs, depth 3',
        'status     building, deciding',
        'blocks     0',
        'subgoals   0',
        'action planning cost               0',
        'subgoal planning cost              0',
    ]


def test_says_what_is_going_on(tower_spec, recorded):
    record = recorded(tower_spec())
    scenes = list(scenes_of(record))
    label = record.decisions[0].decision.subgoals[0].region.label
    assert lines_of(scenes[1])[3] == f'status     building {label}'
    assert lines_of(scenes[-1])[3] == 'status     success'


def test_table_shows_every_candidate_of_a_scoping_decision(tower_spec, recorded):
    scene = next(scene for scene in scenes_of(recorded(tower_spec())) if scene.decision)
    decision = scene.decision
    assert decision is not None
    heading, titles, *rows = lines_of(scene)[9:]
    assert heading == '8 candidates: cells r, cost c, value V'
    assert titles.split() == ['rows', 'r', 'c', 'V', 'status']
    assert len(rows) == 8
    for index, (row, candidate) in enumerate(zip(rows, decision.candidates, strict=True)):
        assert row.startswith('▶') == (index == decision.chosen)
        height, cells, cost = row.lstrip('▶ ').split()[:3]
        assert height == str(candidate.regions[0].label.numbers[0])
        assert cells == str(candidate.cells)
        assert cost == f'{candidate.planning_cost:,}'


def with_candidates(scene: Scene, count: int, chosen: int | None) -> Scene:
    candidates = tuple(
        Candidate(
            row_regions(*range(1, 17)), 256, 10**9 + index, -float(index), SolveStatus.SOLVED
        )
        for index in range(count)
    )
    decision = Decision(0, candidates, chosen, (), 10**13, count)
    return replace(
        scene, chosen=SubgoalChosen(scene.spec.trial_id, 0, (DecisionRecord(0, decision, 0),))
    )


def test_the_best_of_many_candidates_are_shown_and_the_rest_counted(tower_spec):
    scene = with_candidates(scene_of(tower_spec()), 32768, chosen=20000)
    lines = lines_of(scene)
    assert len(lines) == 22
    assert lines[9] == '32,768 candidates: cells r, cost c, value '
    assert lines[11].startswith('▶ 1 2')
    assert '1,000,020,000' in lines[11]
    assert [line for line in lines if line.startswith('▶')] == [lines[11]]
    assert '1,000,000,000' in lines[12]
    assert lines[-1] == '  32,758 more'


@pytest.mark.parametrize('signs', [palette.UNICODE, palette.ASCII])
@pytest.mark.parametrize('count', [1, 9, 10, 11, 128])
@pytest.mark.parametrize('width', [1, 12, 36, 160])
@pytest.mark.parametrize('height', [0, 1, 9, 12, 21, 40])
def test_stays_inside_its_place(tower_spec, signs, count, width, height):
    scene = with_candidates(scene_of(tower_spec(commit='action')), count, chosen=0)
    text = panel(scene, width, height, signs).plain
    lines = text.split('\n')
    assert len(lines) <= max(height, 1)
    assert all(len(line) <= width for line in lines)
    text.encode(signs.encoding)


def test_all_candidates_are_shown_if_they_just_fit(tower_spec):
    scene = with_candidates(scene_of(tower_spec()), 11, chosen=3)
    assert 'more' not in panel(scene, 80, 22).plain
    assert panel(scene, 80, 21).plain.endswith('\n  2 more')


def test_names_are_not_markup(tower_spec):
    spec = tower_spec(name='[bold]x[/bold]\x1b[31m')
    assert lines_of(scene_of(spec))[0] == '[bold]x[/bold]?[31m'


@pytest.mark.parametrize('status', TrialStatus)
def test_every_status_can_be_shown(tower_spec, recorded, status):
    scene = replace(last_scene(recorded(tower_spec())), status=status)
    assert lines_of(scene)[3].startswith('status     ' + status.value.replace('_', ' '))
