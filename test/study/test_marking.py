"""Marking the parts of a silhouette before its trial."""

from __future__ import annotations

import csv
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from blocks_planning.study.desk import Desk
from blocks_planning.study.events import EventKind
from blocks_planning.study.export import export_study
from blocks_planning.study.log import read_events
from blocks_planning.study.plan import StepKind, steps_of
from blocks_planning.study.spec import Study
from blocks_planning.subgoals.drawn import MalformedProposal
from blocks_planning.view.study.frame import frame_json
from blocks_planning.view.study.overview import overview_json

from .conftest import Person, session_of

ARCH = ['####', '####', '#..#', '#..#']
LEFT = ['#...', '#...', '#...', '#...']
TOP = ['####', '####', '....', '....']


@pytest.fixture
def study(study: Study) -> Study:
    """The same study, but builders mark the parts of each tower first."""
    scoping, building = study.conditions
    return replace(study, conditions=(scoping, replace(building, mark_parts=True)))


@pytest.fixture
def marker(person: Person) -> Person:
    """A participant whose condition asks for the parts of the arch."""
    person.go_to(StepKind.MARKING)
    return person


def shown(person: Person) -> Any:
    return frame_json('', person.session)['trial']


def test_parts_are_asked_for_before_each_tower_of_the_condition(study: Study) -> None:
    steps = steps_of(study, 'P01', 0)
    marked = [number for number, step in enumerate(steps) if step.kind is StepKind.MARKING]
    assert [steps[number].marks for number in marked] == [steps[n + 1].trial for n in marked]
    modes = [step.trial.condition.mode.name for step in steps if step.trial]
    assert len(marked) == modes.count('building') == 2


def test_the_id_of_a_study_without_marking_is_what_it_was(study: Study) -> None:
    plain = replace(study, conditions=study.conditions[:1])
    assert 'mark_parts' not in plain.to_json()['conditions'][0]
    assert study.to_json()['conditions'][1]['mark_parts'] is True


def test_a_part_is_what_is_drawn_of_cells_without_a_part(marker: Person) -> None:
    assert marker.draw('mark', LEFT) is None
    assert marker.draw('mark', TOP) is None
    board = marker.session.steps[marker.session.state.step + 1].trial.spec.task.board  # type: ignore[union-attr]
    left, top = (board.parse(rows) for rows in (LEFT, TOP))
    assert marker.session.state.parts == (left, top & ~left)
    cells = {(one['column'], one['row']): one['subgoal'] for one in shown(marker)['all_blocks']}
    assert (cells[0, 3], cells[1, 3], (3, 0) in cells) == (0, 1, False)


def test_a_part_without_cells_is_refused_and_kept(marker: Person, folder: Path) -> None:
    marker.draw('mark', LEFT)
    acts = marker.session.state.acts
    refused = marker.draw('mark', LEFT)
    assert refused is not None
    assert refused.code == 'marked'
    assert marker.session.state.acts == acts
    assert read_events(folder)[-1].kind is EventKind.REFUSED


@pytest.mark.parametrize('fields', [{}, {'region': ['##'], 'thinking_s': 1}, {'region': LEFT}])
def test_what_is_no_part_is_malformed(marker: Person, fields: dict[str, Any]) -> None:
    with pytest.raises(MalformedProposal):
        marker.act('mark', **fields)
    assert marker.session.state.parts == ()


def test_only_a_whole_division_leads_on(marker: Person) -> None:
    marker.draw('mark', LEFT)
    early = marker.act('next')
    assert early is not None
    assert early.code == 'stale'
    marker.draw('mark', ARCH)
    assert shown(marker)['answer'] == 'marked'
    assert marker.act('unmark') is None
    assert shown(marker)['answer'] == ''
    assert marker.act('unmark') is None
    assert marker.act('unmark') is None  # of nothing
    marker.draw('mark', ARCH)
    assert marker.act('next') is None
    assert marker.session.step is not None
    assert marker.session.step.kind is StepKind.TRIAL
    assert marker.session.state.parts == ()


def test_marking_goes_on_where_it_was(marker: Person, opened: Callable[[], Desk]) -> None:
    marker.draw('mark', LEFT)
    marker.draw('mark', ARCH)
    marker.act('unmark')
    parts = marker.session.state.parts
    desk = opened()
    assert session_of(desk).state.parts == parts != ()
    assert overview_json(desk, False, '')['doing'].startswith('marks the parts of trial 3 of 4')


def test_parts_that_stand_are_in_a_table(marker: Person, tmp_path: Path) -> None:
    marker.draw('mark', ARCH)
    marker.act('unmark')
    marker.draw('mark', LEFT, thinking_s=2.5)
    marker.draw('mark', ARCH)
    step = marker.session.state.step
    marker.session.note({'note': 'preview', 'step': step, 'region': TOP})
    marker.act('stop')
    export_study(tmp_path / 'out', tmp_path / 'tables')
    with (tmp_path / 'tables' / 'parts.csv').open(newline='') as file:
        rows = list(csv.DictReader(file))
    assert [(row['step'], row['part'], row['thinking_s']) for row in rows] == [
        (str(step), '0', '2.5'),
        (str(step), '1', '1.0'),
    ]
    assert {(row['phase'], row['condition']) for row in rows} == {('trial', 'hands')}
    assert int(rows[0]['cells'], 16) & int(rows[1]['cells'], 16) == 0
    assert rows[1]['region'] != rows[1]['cells']
    with (tmp_path / 'tables' / 'trials.csv').open(newline='') as file:
        assert str(step) not in [row['step'] for row in csv.DictReader(file)]
