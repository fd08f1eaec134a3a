"""The table of ``solve``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from command import Run, draw_towers


def _rows(table: str, names: list[str]) -> dict[str, list[str]]:
    rows = (line.split() for line in table.splitlines())
    return {row[0]: row[1:] for row in rows if row and row[0] in names}


def test_table_has_a_row_per_stimulus_in_80_columns(run: Run) -> None:
    options = ['--strategy', 'full', '--search', 'astar', '--iterations', 60, '--budget', 20_000]
    lines = run('solve', 'cogsci2021', '--json', *options).out.splitlines()
    expected = {}
    for data in map(json.loads, lines):
        costs = ('action_planning_cost', 'subgoal_planning_cost', 'solution_cost')
        numbers = [data[key] for key in ('blocks', 'subgoals', *costs)]
        expected[data['stimulus']] = [data['status'], *(f'{number:,}' for number in numbers)]
    assert len(expected) == 16
    assert max(len(numbers[4]) for numbers in expected.values()) >= len('1,000,000')
    table = run('solve', 'cogsci2021', *options).out
    assert _rows(table, list(expected)) == expected
    _is_whole(table)


def _is_whole(table: str) -> None:
    """Check that a table fits, and that nothing is left out."""
    assert '\u2026' not in table
    assert max(map(len, table.splitlines())) <= 80
    heading = table.partition('\u2500')[0].split()
    for word in ('stimulus', 'blocks', 'subgoals', 'action', 'subgoal', 'solution', 'cost'):
        assert word in heading


def test_table_of_several_seeds_has_means_over_the_successful_trials(
    run: Run, towers: str
) -> None:
    options = ['--seeds', 4, '--search', 'random', '--strategy', 'none', '--budget', 3]
    lines = run('solve', towers, '--json', *options).out.splitlines()
    table = run('solve', towers, *options).out
    names = [f'{towers}/{name}' for name in ('chair', 'frame', 'square')]
    for name, row in _rows(table, names).items():
        of_name = [data for data in map(json.loads, lines) if data['stimulus'] == name]
        blocks = [data['blocks'] for data in of_name if data['status'] == 'success']
        assert row[0] == f'{len(blocks)}/4'
        mean = sum(blocks) / len(blocks) if blocks else None
        assert row[1] == (
            '-' if mean is None else f'{mean:.0f}' if mean % 1 == 0 else f'{mean:.1f}'
        )
    _is_whole(table)


@pytest.mark.parametrize(
    'name',
    [
        pytest.param('towers of the week.txt', id='blanks'),
        pytest.param('[old]/towers.txt', id='brackets'),
        pytest.param('a[/b].txt', id='closing bracket'),
        pytest.param('stimuli/of/the/second/experiment.txt', id='longish'),
        pytest.param(f'{"long/" * 20}towers.txt', id='longer than the terminal'),
    ],
)
def test_table_names_any_file(
    tmp_path: Path, run: Run, monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    draw_towers(tmp_path / name, square='##/##', flat='##')
    done = run('solve', name)
    assert (done.code, done.err) == (0, '')
    assert '2 of 2 trials' in done.out
    assert done.out.count('success') == 2
    _is_whole(done.out)
    lines = done.out.splitlines()
    end = next(line.index('status') for line in lines if 'status' in line)
    named = ''.join(''.join(line[:end].split()) for line in lines)
    for tower in ('square', 'flat'):
        assert f'{name}/{tower}'.replace(' ', '') in named
