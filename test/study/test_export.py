"""Tables, codebook and records of a study agree with each other and with what happened."""

from __future__ import annotations

import csv
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from blocks_planning.errors import ConfigurationError
from blocks_planning.fitting.points import points_of
from blocks_planning.study.codebook import TABLES
from blocks_planning.study.desk import Desk
from blocks_planning.study.export import export_study
from blocks_planning.study.plan import StepKind
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.verify import contradictions, differs_from_rerun

from .conftest import Clock, Person, session_of

Tables = dict[str, list[dict[str, str]]]


def begin(desk: Desk, code: str) -> Person:
    """The next participant, whose page is connected."""
    desk.begin(code)
    person = Person(session_of(desk))
    person.session.arrive()
    return person


@pytest.fixture
def exported(opened: Callable[[], Desk], tmp_path: Path, clock: Clock) -> Tables:
    """The tables of three participants: one finishes, one stops, one is there still."""
    desk = opened()
    first = begin(desk, 'P01')
    while first.session.step is not None:
        clock.s += 5
        first.go_on()
    second = begin(desk, 'P02')
    second.go_to(StepKind.TRIAL, 'building')
    second.place(0, 0)
    second.place(1, 3)
    points = [[0.1, 1.5, 2.25], [0.2, 1.0, 2.0]]
    second.session.note({'note': 'pointer', 'step': second.session.state.step, 'points': points})
    second.session.note({'note': 'visible', 'step': second.session.state.step, 'visible': False})
    second.act('stop')
    second.go_on()
    third = begin(desk, 'P03')
    third.go_to(StepKind.TRIAL)
    third.draw('withdrawn', ['####', '####'])
    done = export_study(tmp_path / 'out', tmp_path / 'tables')
    assert done.has_parquet
    found = {}
    for name in (*TABLES, 'codebook'):
        with (tmp_path / 'tables' / f'{name}.csv').open(newline='') as file:
            found[name] = list(csv.DictReader(file))
    assert {name: len(rows) for name, rows in found.items()} == {
        name: done.files[f'{name}.csv'] for name in found
    }
    return found


def test_participants_are_told_apart(exported: Tables) -> None:
    rows = exported['participants']
    assert [(row['participant'], row['number'], row['status']) for row in rows] == [
        *(('P01', '0', 'finished'), ('P02', '1', 'stopped'), ('P03', '2', 'running')),
    ]
    trials = [row['participant'] for row in exported['trials']]
    assert [trials.count(code) for code in ('P01', 'P02', 'P03')] == [5, 4, 1]


def test_trials_agree_with_records(exported: Tables, tmp_path: Path) -> None:
    records = records_in(tmp_path / 'tables', 'records', 'practice')
    ended = {row['trial_id']: row for row in exported['trials'] if row['status']}
    assert len(records) == len(ended) == 9
    for record in records:
        row = ended[record.spec.trial_id]
        assert (row['tower'], row['status']) == (record.spec.stimulus, record.status.value)
        assert (int(row['blocks']), float(row['f1'])) == (record.blocks, record.measures.f1)
        assert list(contradictions(record)) + list(differs_from_rerun(record)) == []
        placed = [
            tuple(int(one[key]) for key in ('width', 'height', 'column', 'row'))
            for one in exported['placements']
            if (one['participant'], one['step']) == (row['participant'], row['step'])
        ]
        assert placed == [tuple(block) for block in record.placements]


def records_in(tables: Path, *folders: str) -> list[TrialRecord]:
    """The records of all conditions."""
    paths = [path for folder in folders for path in sorted((tables / folder).iterdir())]
    return [record for path in paths for record in read_records(path)]


def test_choices_can_be_fitted(exported: Tables, tmp_path: Path) -> None:
    points = points_of(records_in(tmp_path / 'tables', 'records'))
    built = [row for row in exported['proposals'] if row['kind'] == 'build']
    main = [row for row in built if trial_of(exported, row)['phase'] == 'trial']
    assert len(points) == len(main)
    assert {point.session for point in points} == {'P01', 'P02'}


def trial_of(tables: Tables, row: dict[str, str]) -> dict[str, str]:
    (found,) = (
        one
        for one in tables['trials']
        if (one['participant'], one['step']) == (row['participant'], row['step'])
    )
    return found


def test_outcomes_are_told(exported: Tables) -> None:
    second = [row for row in exported['trials'] if row['participant'] == 'P02'][-1]
    assert (second['status'], second['reason']) == (
        *('cancelled', 'the participant stopped taking part'),
    )
    assert (second['proposals'], second['refused'], second['blocks']) == ('1', '1', '1')
    outcomes = {row['outcome'] for row in exported['proposals'] if row['participant'] != 'P03'}
    assert outcomes == {'built'}
    assert [row['outcome'] for row in exported['proposals'] if row['participant'] == 'P03'] == ['']
    pointer = [(row['page_s'], row['column'], row['row']) for row in exported['pointer']]
    assert pointer == [('0.1', '1.5', '2.25'), ('0.2', '1.0', '2.0')]
    assert '{"visible":false}' in [row['data'] for row in exported['events']]


def test_every_column_is_in_the_codebook_and_holds_what_it_says(
    exported: Tables, tmp_path: Path
) -> None:
    described = [(row['table'], row['column']) for row in exported['codebook']]
    assert described == [(name, key) for name in TABLES for key in header_of(tmp_path, name)]
    assert all(row['meaning'] for row in exported['codebook'])
    kinds: dict[str, Any] = {'int': int, 'float': float, 'str': str}
    for row in exported['codebook']:
        values = [one[row['column']] for one in exported[row['table']]]
        for value in filter(None, values):
            kinds[row['type']](value)


def header_of(folder: Path, name: str) -> list[str]:
    with (folder / 'tables' / f'{name}.csv').open(newline='') as file:
        return next(csv.reader(file))


def test_parquet_is_the_same(exported: Tables, tmp_path: Path) -> None:
    import pyarrow.parquet as pq

    for name, rows in exported.items():
        table = pq.read_table(tmp_path / 'tables' / f'{name}.parquet').to_pylist()
        told = [{k: '' if v is None else str(v) for k, v in row.items()} for row in table]
        assert told == rows


def test_what_is_no_study_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r'is not the folder of a study'):
        export_study(tmp_path, tmp_path / 'tables')


def test_who_is_deleted_is_in_no_table(exported: Tables, tmp_path: Path) -> None:
    kept = tmp_path / 'out' / 'participants'
    for code in ('P01', 'P02'):
        shutil.rmtree(kept / code)
    export_study(tmp_path / 'out', tmp_path / 'tables')
    texts = [path.read_bytes() for path in (tmp_path / 'tables').rglob('*.*')]
    assert [text for text in texts if b'P01' in text or b'P02' in text] == []
    assert any(b'P03' in text for text in texts)
