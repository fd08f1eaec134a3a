"""Commands on records: verify and draw."""

from __future__ import annotations

import json
import os
from pathlib import Path

import pytest
from builders import CHAIR, TOWERS, record, record_json, remade
from command import Run, subprocess_run

from blocks_planning.trials.reading import read_records

# Verify and draw.


@pytest.fixture
def records(tmp_path: Path) -> Path:
    """A file of true records."""
    path = tmp_path / 'records.jsonl'
    path.write_text(''.join(f'{record(rows, depth=2).to_line()}\n' for rows in TOWERS))
    return path


def test_true_records_hold(run: Run, records: Path) -> None:
    expected = f'{records}: {len(TOWERS)} records read\n'
    assert run('verify', records) == (0, f'{expected}all consistent\n', '')
    assert run('verify', records, '--rerun') == (0, f'{expected}all consistent\n', '')
    assert run('verify', records, records) == (0, f'{expected}{expected}all consistent\n', '')


def test_contradicting_record_is_named(run: Run, records: Path) -> None:
    lied = record_json(CHAIR, depth=2)
    lied['observations'][1]['landed'][0][3] += 1
    with records.open('a') as file:
        file.write(json.dumps(remade(lied)) + '\n')
    done = run('verify', records)
    assert (done.code, done.err) == (1, '')
    assert f'{records}, record {len(TOWERS) + 1} ' in done.out
    assert ': observation 1: the outcome differs' in done.out
    assert done.out.endswith('1 inconsistent\n')


def test_only_a_rerun_finds_another_seed(run: Run, tmp_path: Path) -> None:
    path = tmp_path / 'record.json'
    lied = record_json(CHAIR, strategy='none', depth=2)
    lied['seed'] = 2
    path.write_text(json.dumps(remade(lied), indent=1))
    assert run('verify', path).code == 0
    done = run('verify', path, '--rerun')
    assert done.code == 1
    assert 'a new run gives another value of placements' in done.out


def test_unreadable_record_is_refused_with_its_line(run: Run, records: Path) -> None:
    with records.open('a') as file:
        file.write('{"format": 1}\n')
    done = run('verify', records)
    assert (done.code, done.out) == (2, '')
    assert done.err.startswith(f'Error: {records}, line {len(TOWERS) + 1}: ')
    assert done.err.count('\n') == 1


def test_name_that_cannot_be_printed_is_no_crash(tmp_path: Path) -> None:
    path = tmp_path / 'record.json'
    lied = record_json(CHAIR, stimulus='\ud800')
    lied['observations'][1]['landed'][0][3] += 1
    path.write_text(json.dumps(remade(lied)))
    done = subprocess_run('verify', path, env={**os.environ, 'PYTHONIOENCODING': 'utf-8:strict'})
    assert done.returncode in (1, 2)
    assert 'Traceback' not in done.stderr


@pytest.mark.parametrize(('name', 'begins'), [('tower.png', b'\x89PNG'), ('tower.gif', b'GIF8')])
def test_draw_makes_a_picture(run: Run, records: Path, name: str, begins: bytes) -> None:
    out = records.parent / name
    assert run('draw', records, '--record', 1, '--out', out) == (0, '', '')
    assert out.read_bytes().startswith(begins)


@pytest.mark.parametrize(
    ('options', 'words'),
    [
        ('--out {0}/x.png', 'has 8 records; choose one with --record'),
        ('--out {0}/x.png --record 9', 'has 8 records; --record 9 is out of range'),
        ('--out {0}/x.png --record 0', '0 is not in the range'),
        ('--out {0}/x.bmp --record 1', '.bmp'),
        ('--out {0}/x --record 1', 'suffix'),
        ('--out {0}/missing/x.png --record 1', 'cannot be written: No such file or directory'),
    ],
)
def test_picture_that_cannot_be_made_is_refused(
    run: Run, records: Path, options: str, words: str
) -> None:
    done = run('draw', records, *options.format(records.parent).split())
    assert (done.code, done.out) == (2, '')
    assert words in done.err
    assert list(records.parent.glob('x*')) == []


# Ctrl-C, and readers that have seen enough.


def test_records_of_solve_hold(tmp_path: Path, towers: str) -> None:
    """From one end to the other, as two processes."""
    done = subprocess_run('solve', towers, '--depth', 2, '--json')
    path = tmp_path / 'records.jsonl'
    path.write_text(done.stdout)
    assert len(read_records(path)) == 3
    assert subprocess_run('verify', path, '--rerun').stdout.endswith('all consistent\n')
