"""Specifications of sweeps: what they expand to, and errors that name file, line and key."""

from __future__ import annotations

from pathlib import Path

import pytest

from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.reading import find_sweep, read_sweep
from blocks_planning.search.searches import AStar, BreadthFirst
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping

GOOD = """\
name: mine
stimuli: [cogsci2021/9, cogsci2021/13]
library: 1x2,2x1
seeds: 10
first_seed: 5
experiments:
  - name: first
    budget: 1000
    searches:
      - {name: bfs, depth: [1, 2]}
      - {name: astar, iterations: [8, 64], divisor: [smallest, mean]}
    strategies:
      - name: none
      - {name: scoping, lambda: {from: 0, to: 0.01, count: 3}}
"""


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / 'sweep.yaml'
    path.write_text(text)
    return path


def test_lists_and_ranges_expand(tmp_path: Path) -> None:
    sweep = read_sweep(written(tmp_path, GOOD))
    [experiment] = sweep.experiments
    assert experiment.searches == (
        BreadthFirst(1),
        BreadthFirst(2),
        AStar(8, 'smallest'),
        AStar(8, 'mean'),
        AStar(64, 'smallest'),
        AStar(64, 'mean'),
    )
    assert experiment.strategies == (NoSubgoals(), Scoping(0.0), Scoping(0.005), Scoping(0.01))
    assert experiment.budget == 1000
    assert sweep.seeds == tuple(range(5, 15))
    assert [tower.name for tower in sweep.towers] == ['cogsci2021/9', 'cogsci2021/13']
    trials = [s for c in sweep.chunks() for group in c.groups() for s in group]
    assert len(trials) == sum(c.trials for c in sweep.chunks()) == 6 * 4 * 10 * 2
    assert len({spec.trial_id for spec in trials}) == len(trials)


def test_identity_is_stable_and_follows_from_every_setting(tmp_path: Path) -> None:
    sweep = read_sweep(written(tmp_path, GOOD))
    again = read_sweep(written(tmp_path, GOOD.replace('name: mine', 'name: yours')))
    assert again.sweep_id == sweep.sweep_id
    for old, new in [('1x2,', '2x2,'), ('[1, 2]', '[1, 3]'), ('1000', '999'), ('0.01', '0.02')]:
        other = read_sweep(written(tmp_path, GOOD.replace(old, new)))
        assert other.sweep_id != sweep.sweep_id


def test_more_seeds_keep_the_chunks_there_are(tmp_path: Path) -> None:
    few = read_sweep(written(tmp_path, GOOD.replace('seeds: 10', 'seeds: 8')))
    many = read_sweep(written(tmp_path, GOOD.replace('seeds: 10', 'seeds: 16')))
    assert {c.chunk_id for c in few.chunks()} < {c.chunk_id for c in many.chunks()}


def test_evenly_spaced_values_end_where_they_should(tmp_path: Path) -> None:
    """0.003 * 3 / 3 is not 0.003."""
    text = GOOD.replace('{from: 0, to: 0.01, count: 3}', '{from: 0, to: 0.003, count: 4}')
    strategies = read_sweep(written(tmp_path, text)).experiments[0].strategies
    assert [strategies[1], strategies[-1]] == [Scoping(0.0), Scoping(0.003)]


def test_experiment_can_have_the_first_seeds_alone(tmp_path: Path) -> None:
    whole = read_sweep(written(tmp_path, GOOD))
    few = read_sweep(written(tmp_path, GOOD.replace('budget: 1000', 'budget: 1000\n    seeds: 9')))
    assert [chunk.seeds for chunk in few.chunks()] == 2 * [tuple(range(5, 13)), (13,)]
    assert {c.chunk_id for c in few.chunks()} & {c.chunk_id for c in whole.chunks()}
    assert few.sweep_id != whole.sweep_id
    assert few.to_json()['experiments'][0]['seeds'] == 9
    assert 'seeds' not in whole.to_json()['experiments'][0]


@pytest.mark.parametrize('name', ['paper', 'paper_quick', 'beyond'])
def test_sweeps_of_the_package_can_be_read(name: str) -> None:
    assert read_sweep(find_sweep(name)).chunks()


@pytest.mark.parametrize(
    ('old', 'new', 'message'),
    [
        ('seeds: 10', 'sedes: 10', r"line 4, key 'sedes': unknown key; expected one of name"),
        ('seeds: 10', 'seeds: 0', r"line 4, key 'seeds': seeds must be a whole number from 1"),
        ('seeds: 10\n', '', r"line 1: missing key 'seeds'"),
        ('depth', 'deep', r"line 10, key 'deep': search bfs has no setting 'deep'"),
        ('[1, 2]', '0', r"line 10, key 'depth': depth must be a whole number from 1 to 64"),
        ('[1, 2]', '[]', r"line 10, key 'depth': expected a list with at least one item"),
        ('name: bfs', 'name: dfs', r"line 10, key 'name': search must be one of bfs"),
        ('to: 0.01', 'till: 1', r"line 14, key 'till': unknown key; expected one of from, to"),
        ('to: 0.01', 'to: high', r"line 14, key 'to': expected a number, got 'high'"),
        ('count: 3', 'count: 1', r"line 14, key 'count': count must be a whole number from 2"),
        ('from: 0', 'from: -1', r"line 14, key 'lambda': lambda must be a finite number"),
        ('1x2,2x1', '1x2,1x2', r"line 3, key 'library': block library: block 1x2 is listed twice"),
        ('cogsci2021/9', 'nowhere/9', r"line 2, key 'stimuli': stimulus 'nowhere/9'"),
        ('name: mine', 'name: }', r'line 1: is not YAML'),
        ('first_seed: 5', 'seeds: 5', r"line 5, key 'seeds': appears twice"),
        ('budget: 1000', 'budget: many', r"line 8, key 'budget': budget must be a whole number"),
        ('budget: 1000', 'seeds: 11', r"line 8, key 'seeds': seeds must be a whole number from 1"),
    ],
)
def test_error_names_file_line_and_key(tmp_path: Path, old: str, new: str, message: str) -> None:
    assert old in GOOD
    path = written(tmp_path, GOOD.replace(old, new, 1))
    with pytest.raises(ConfigurationError, match=message) as caught:
        read_sweep(path)
    assert str(caught.value).startswith(f'{path}, line ')
    assert '\n' not in str(caught.value)


def test_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match='cannot be read: No such file'):
        read_sweep(tmp_path / 'none.yaml')


def test_two_experiments_of_one_name(tmp_path: Path) -> None:
    body = GOOD[GOOD.index('  - name: first') :]
    with pytest.raises(ConfigurationError, match="there is already an experiment 'first'"):
        read_sweep(written(tmp_path, GOOD + body))
