"""The commands that run sweeps and studies: what they print, and their exit codes."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pyarrow.parquet as pq
import pytest

from blocks_planning.search.policy import MAX_STATES

TOWERS = 'tower a\n##\n##\n\ntower b\n####\n####\n'
SPEC = """\
name: small
stimuli: [towers.txt]
library: 1x2,2x1
seeds: 3
experiments:
  - name: only
    searches: [{name: bfs, depth: 2}, {name: exact}]
    strategies: [{name: none}, {name: scoping}]
"""


def run(folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, '-m', 'blocks_planning.cli', *words]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / 'towers.txt').write_text(TOWERS)
    (tmp_path / 'sweep.yaml').write_text(SPEC)
    return tmp_path


def test_sweep(folder: Path) -> None:
    for _ in range(2):
        done = run(folder, 'sweep', 'sweep.yaml', '--out', 'out', '--workers', '1')
        assert (done.returncode, done.stderr) == (0, '')
        assert done.stdout == 'out: 24 trials: 24 success\n'
    assert pq.read_table(folder / 'out' / 'trials.parquet').num_rows == 24


def test_sweep_with_a_failed_trial_exits_with_1(folder: Path) -> None:
    rows = '\n'.join(['################'] * 16)
    (folder / 'towers.txt').write_text(rows)
    text = SPEC.replace('seeds: 3', 'seeds: 1').replace(', {name: scoping}', '')
    (folder / 'sweep.yaml').write_text(text.replace('library: 1x2,2x1\n', ''))
    program = 'from blocks_planning.search import exact; exact.MAX_STATES = 9; '
    program += 'from blocks_planning.cli import main; main()'
    words = ['sweep', 'sweep.yaml', '--out', 'out', '--workers', '1']
    done = subprocess.run(
        [sys.executable, '-c', program, *words], cwd=folder, capture_output=True, text=True
    )
    assert done.returncode == 1
    assert '1 failed' in done.stdout
    why = 'exact: the search would have exceeded its memory'
    assert done.stderr == f'failed, 1 trials: {why}\n'


@pytest.mark.parametrize(
    ('words', 'error'),
    [
        (['sweep', 'none.yaml', '--out', 'x'], 'none.yaml: cannot be read: No such file'),
        (['sweep', 'bad.yaml', '--out', 'x'], "bad.yaml, line 4, key 'sedes': unknown key"),
        (['sweep', 'sweep.yaml', '--out', 'towers.txt'], '--out towers.txt: File exists'),
        (['exact-policy', 'towers.txt/a', '--search', 'random', '--depth', '2'], 'has no setting'),
        (
            ['exact-policy', 'towers.txt', '--slip', '1.5'],
            'slip must be a number from 0 to 1, got 1.5',
        ),
    ],
)
def test_bad_input_is_one_line(folder: Path, words: list[str], error: str) -> None:
    (folder / 'bad.yaml').write_text(SPEC.replace('seeds', 'sedes'))
    done = run(folder, *words)
    assert done.returncode == 2
    assert done.stdout == ''
    assert error in done.stderr
    assert done.stderr.startswith('Error: ')
    assert done.stderr.count('\n') == 1


def test_exact_policy(folder: Path) -> None:
    words = ['exact-policy', 'towers.txt', '--library', '1x2,2x1', '--search', 'random']
    lines = run(folder, *words, '--json').stdout.splitlines()
    first, second = map(json.loads, lines)
    assert first['stimulus'] == 'towers.txt/a'
    # Of the first placements on 2 x 2, all are good; the second must match its kind.
    assert first['success'] == pytest.approx(1.0)
    assert 0 < second['success'] < 1
    said = run(folder, *words).stdout
    assert f'succeeds with probability {second["success"]:.6g}' in said


@pytest.mark.long
def test_exact_policy_where_blocks_slip(folder: Path) -> None:
    (folder / 'towers.txt').write_text('tower a\n.##.\n.##.\n\ntower b\n.###.\n.###.\n')
    words = ['exact-policy', 'towers.txt', '--slip', '0', '--slip', '0.2']
    rows = [json.loads(line) for line in run(folder, *words, '--json').stdout.splitlines()]
    assert [(row['stimulus'], row['slip']) for row in rows] == [
        (f'towers.txt/{name}', slip) for name in 'ab' for slip in (0.0, 0.2)
    ]
    assert [row['optimum'] for row in rows[::2]] == [1.0, 1.0]
    for row in rows[1::2]:
        assert 1 > row['optimum'] >= row['bfs'] > 0
        assert row['optimum'] > row['random'] > 0
    said = run(folder, *words).stdout.splitlines()
    assert len(said) == 4
    for line, row in zip(said, rows, strict=True):
        assert line.startswith(f'{row["stimulus"]}: slip {row["slip"]:g}: best possible')
        assert f'best possible {row["optimum"]:.6g}, bfs {row["bfs"]:.6g}, random ' in line


def test_exact_policy_where_blocks_slip_compares_all_policies(folder: Path) -> None:
    for words in (['--search', 'bfs'], ['--budget', '9']):
        done = run(folder, 'exact-policy', 'towers.txt', '--slip', '0.1', *words)
        assert done.returncode == 2
        assert f'remove {words[0]}' in done.stderr


@pytest.mark.parametrize(
    ('more', 'key', 'said'),
    [((), 'success', 'one attempt succeeds'), (('--slip', '0'), 'bfs', 'slip 0: best possible 1')],
    ids=['as ordered', 'slips'],
)
def test_a_tower_over_the_limit_of_states_is_reported_in_its_row(
    folder: Path, more: tuple[str, ...], key: str, said: str
) -> None:
    words = ['exact-policy', 'cogsci2021/2', 'towers.txt/a', '--limit', '9', *more]
    done = run(folder, *words, '--json')
    assert (done.returncode, done.stderr) == (3, '')
    first, second = map(json.loads, done.stdout.splitlines())
    assert 'more than the limit of 9 states' in first['problem']
    assert second[key] == pytest.approx(1.0)
    first, second = run(folder, *words).stdout.splitlines()
    assert first.startswith('cogsci2021/2: ')
    assert 'more than the limit of 9 states' in first
    assert second.startswith(f'towers.txt/a: {said}')


def test_limit_that_is_shown_is_the_one_that_holds(folder: Path) -> None:
    assert str(MAX_STATES) in run(folder, 'exact-policy', '--help').stdout


def test_interrupted_sweep_says_so_and_goes_on(folder: Path) -> None:
    text = SPEC.replace('towers.txt', 'cogsci2021').replace('library: 1x2,2x1\n', '')
    text = text.replace(', {name: exact}', '').replace('seeds: 3', 'seeds: 24')
    (folder / 'sweep.yaml').write_text(text)
    command = [sys.executable, '-m', 'blocks_planning.cli', 'sweep', 'sweep.yaml']
    command += ['--out', 'out', '--workers', '1']
    process = subprocess.Popen(
        command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    deadline = time.monotonic() + 60
    while not list(folder.glob('out/parts/????????????????')) and time.monotonic() < deadline:
        time.sleep(0.01)
    os.kill(process.pid, signal.SIGINT)
    _, said = process.communicate(timeout=60)
    assert process.returncode == 130, said
    assert said.strip() == 'Interrupted.'
    done = run(folder, 'sweep', 'sweep.yaml', '--out', 'out', '--workers', '1')
    assert done.returncode == 0
    assert '768 trials' in done.stdout
