"""The experiment in uncertain worlds: what is written is whole, and follows from the trials."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from blocks_planning.analysis.trials import read_measured
from blocks_planning.analysis.uncertainty import Resampling, read_uncertain
from blocks_planning.analysis.uncertainty_answers import first_change


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('uncertain')
    run(folder)
    return folder


def run(folder: Path) -> str:
    command = [sys.executable, '-m', 'blocks_planning.cli', 'uncertain', '--quick']
    command += ['--workers', '1', '--out', str(folder)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.fixture(scope='module')
def results(folder: Path) -> Any:
    return json.loads((folder / 'results.json').read_text())


def test_report_is_in_one_piece(folder: Path) -> None:
    html = (folder / 'report.html').read_text()
    plain = re.sub(r'base64,[^"]*', '', html)
    assert html.count('data:image/svg+xml;base64,') == 2
    assert 'quick run' in plain
    assert 'nan' not in plain
    assert 'http' not in plain
    for name in ('uncertainty', 'loose'):
        assert (folder / 'figures' / f'{name}.png').stat().st_size > 10_000


def test_loose_towers_are_compared_where_nothing_slips(folder: Path, results: Any) -> None:
    trials = read_uncertain(folder / 'sweep')
    obeyed = trials[(trials['slip'] == 0) & (trials['loss'] == 0)]
    assert results['loose']
    for row in results['loose']:
        mine = obeyed[
            (obeyed['stimulus'] == row['stimulus']) & (obeyed['planner'] == row['planner'])
        ]
        for blocks in ('glued', 'loose'):
            part = mine[mine['blocks_are'] == blocks]
            assert row[blocks] == pytest.approx(float((part['status'] == 'success').mean()))
        assert row['falls'] == pytest.approx(float((part['status'] == 'collapsed').mean()))


def test_numbers_follow_from_the_trials(folder: Path, results: Any) -> None:
    trials = read_uncertain(folder / 'sweep')
    assert results['trials'] == len(trials) == 8 * 2 * 5 * 4
    best = {
        (row['stimulus'], row['slip']): row['optimum']
        for path in folder.glob('optimum-*.json')
        for row in json.loads(path.read_text())
    }
    for cell in results['cells']:
        mine = trials[
            (trials['planner'] == cell['planner'])
            & (trials['slip'] == cell['slip'])
            & (trials['loss'] == cell['loss'])
            & (trials['blocks_are'] == cell['blocks_are'])
        ]
        assert len(mine) == 16
        success = float((mine['status'] == 'success').mean())
        assert cell['success']['mean'] == pytest.approx(success)
        assert cell['states']['mean'] == pytest.approx(float(mine['states'].mean()))
        assert ('regret' in cell) == (cell['blocks_are'] == 'glued')
        if 'regret' in cell:
            optimum = np.mean([best[tower, cell['slip']] for tower in mine['stimulus']])
            assert cell['regret']['mean'] == pytest.approx(optimum - success)


def test_optimum_is_one_where_nothing_slips(results: Any) -> None:
    sure, chancy = results['optima']
    assert sure == {'slip': 0, 'mean': 1, 'ci': [1, 1], 'p': None}
    assert 0 < chancy['mean'] < 1


def test_searches_that_know_that_towers_fall(folder: Path, results: Any) -> None:
    trials = read_measured(folder / 'stable')
    assert {(row['strategy'], row['search']) for row in results['stable']} == {
        *product(('none', 'scoping'), ('bfs', 'stable_bfs'))
    }
    for row in results['stable']:
        mine = trials[
            (trials['strategy'] == row['strategy']) & (trials['search'] == row['search'])
        ]
        assert row['falls']['mean'] == float((mine['status'] == 'collapsed').mean())
        for measure in ('success', 'f1', 'states'):
            assert row[measure]['mean'] == pytest.approx(float(mine[measure].mean()))
        if row['search'] == 'stable_bfs':
            assert row['falls']['mean'] == 0
    assert any(row['falls']['mean'] > 0 for row in results['stable'])


@pytest.mark.long
def test_started_again_it_says_the_same(folder: Path, results: Any) -> None:
    said = run(folder)
    assert json.loads((folder / 'results.json').read_text()) == results
    for sentence in results['answers']:
        assert sentence in said


@pytest.mark.parametrize(
    ('intervals', 'expected'),
    [
        ([(0, 0), (-1, 1), (1, 2), (0.5, 3)], (0.2, 1)),
        ([(0, 0), (1, 2), (1, 2), (1, 2)], (0.1, 1)),
        ([(0, 0), (1, 2), (-1, 2), (1, 2)], (0.3, 1)),
        ([(0, 0), (1, 2), (1, 2), (-1, 2)], None),
        ([(0, 0), (1, 2), (-2, -1), (-2, -1)], (0.2, -1)),
        ([(0, 0), (-1, 1), (0, 1), (-1, 0)], None),
    ],
)
def test_change_begins_where_it_stays(
    intervals: list[tuple[float, float]], expected: tuple[float, int] | None
) -> None:
    rows = [
        {'slip': round(0.1 * number, 1), 'gain_change': {'ci': list(interval)}}
        for number, interval in enumerate(intervals)
    ]
    assert first_change(rows, 'gain') == expected


def interval(table: np.ndarray) -> Any:
    resampling = Resampling.of(*table.shape)
    return resampling.over_towers(resampling.by_tower(table))


HALF = np.outer([0.0, 1.0] * 8, np.ones(2))


@pytest.mark.parametrize('table', [HALF, HALF.T])
def test_towers_and_seeds_are_drawn(table: np.ndarray) -> None:
    """Half of 16 towers are 1 in both seeds; then half of 16 seeds in both towers."""
    found = interval(table)
    assert found.mean == 0.5
    # The mean of 16 draws from 0 and 1 has a standard deviation of 1/8.
    assert found.low == pytest.approx(0.25, abs=0.07)
    assert found.high == pytest.approx(0.75, abs=0.07)


def test_what_is_the_same_everywhere_has_no_interval() -> None:
    found = interval(np.full((3, 4), 7.0))
    assert [found.mean, found.low, found.high] == pytest.approx([7, 7, 7])


def test_differences_are_paired_by_tower_and_seed() -> None:
    rng = np.random.default_rng(1)
    table = rng.random((5, 6))
    resampling = Resampling.of(5, 6)
    gain = resampling.by_tower(table + 0.25).minus(resampling.by_tower(table))
    found = resampling.over_towers(gain)
    assert [found.mean, found.low, found.high] == pytest.approx([0.25] * 3)


def test_logarithm_is_of_the_mean_cost_of_a_tower() -> None:
    found = Resampling.of(1, 2).by_tower(np.array([[0.0, 16.0]])).log2()
    assert found.mean == 3.0
    assert set(np.unique(found.drawn)) == {0.0, 3.0, 4.0}
