"""Generated towers can be rebuilt; costs grow as fitted."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from blocks_planning.analysis.growth import fit
from blocks_planning.board.geometry import Board, area
from blocks_planning.board.task import Task
from blocks_planning.experiments.growth import generate_tower, growth_sweep
from blocks_planning.search.exact import analyse


@pytest.mark.parametrize('size', [(4, 4), (8, 8), (8, 12), (12, 8)])
def test_generated_towers_can_be_rebuilt(size: tuple[int, int]) -> None:
    board = Board(*size)
    for seed in range(3):
        silhouette = generate_tower(board, np.random.default_rng(seed))
        assert area(silhouette) > board.size // 3
        answer = analyse(Task(board, silhouette))
        assert answer is not None
        assert answer.arrangements > 0


def test_generator_decides() -> None:
    board = Board(16, 16)
    first, again, other = (generate_tower(board, np.random.default_rng(s)) for s in (1, 1, 2))
    assert first == again != other


def test_sizes() -> None:
    names = [tower.name for tower in growth_sweep(2, 1).towers]
    assert len(set(names)) == len(names)
    assert {'8x16/0', '16x8/1', '16x16/0', '4x4/1', '8x8/0'} <= set(names)


def test_fits_find_the_law() -> None:
    sides = np.array([4.0, 6, 8, 12, 16])
    doubling = fit(sides, 3 * 2**sides)
    assert doubling is not None
    assert doubling.law == 'exponential'
    assert doubling.base == pytest.approx(2)
    assert doubling.at(np.array([5.0])) == pytest.approx([96])
    cubic = fit(sides, 7 * sides**3)
    assert cubic is not None
    assert cubic.law == 'power'
    assert cubic.base == pytest.approx(3)
    assert cubic.r2 == pytest.approx(1)


@pytest.mark.parametrize(
    ('sides', 'costs'),
    [([4, 6], [3, 9]), ([4, 6, 8], [3, 0, 9]), ([4, 4, 6, 6], [3, 4, 8, 9]), ([], [])],
)
def test_no_law_is_fitted_to_fewer_than_three_sizes(sides: list[int], costs: list[int]) -> None:
    assert fit(np.array(sides, float), np.array(costs, float)) is None


def test_too_few_sizes_are_refused_before_anything_runs(tmp_path: Path) -> None:
    command = [sys.executable, '-m', 'blocks_planning.cli', 'growth', '--out', str(tmp_path / 'x')]
    done = subprocess.run([*command, '--largest', '7'], capture_output=True, text=True)
    assert done.returncode == 2
    assert '--largest 7: leaves the sizes 4, 6; a fit needs at least 3 sizes' in done.stderr
    assert not (tmp_path / 'x').exists()


def test_command_writes_table_and_figure(tmp_path: Path) -> None:
    command = [sys.executable, '-m', 'blocks_planning.cli', 'growth', '--out', str(tmp_path)]
    command += ['--largest', '8', '--towers', '2', '--seeds', '1', '--workers', '1']
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    rows = json.loads((tmp_path / 'growth.json').read_text())
    assert len(rows) == 9
    assert all(len(row['states']) == len(row['sides']) == 3 for row in rows)
    full = next(row for row in rows if (row['way'], row['strategy']) == ('height', 'full'))
    assert full['fit']['base'] > 1.5
    assert (tmp_path / 'figures' / 'growth.png').stat().st_size > 10_000
