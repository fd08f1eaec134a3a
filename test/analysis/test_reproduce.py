"""The whole reproduction, quickly: what is written is whole, and says the same every time."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from blocks_planning.analysis.people import read_people
from blocks_planning.analysis.report import add_exact
from blocks_planning.analysis.results import summarise
from blocks_planning.analysis.trials import groups_of, planners_of, read_trials

CLAIM = {
    *('id', 'statement', 'is_effect', 'paper', 'analysis', 'ours', 'against', 'verdict'),
    *('analysis_verdict', 'contradiction', 'why'),
}
FIGURES = (
    *('figure-2', 'figure-3-published', 'figure-3-text'),
    *('figure-4-published', 'figure-4-text', 'people'),
    *('behaviour-building', 'behaviour-parts', 'behaviour-difficulty'),
)
STRATEGIES = ('none', 'scoping', 'full')
MEASURES = {'success', 'action_planning_cost', 'subgoal_planning_cost', 'blocks', 'subgoals'}


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('reproduce')
    command = [sys.executable, '-m', 'blocks_planning.cli', 'reproduce', '--quick']
    command += ['--workers', '1', '--out', str(folder)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert 'effects are the same' in done.stdout
    return folder


@pytest.fixture(scope='module')
def results(folder: Path) -> Any:
    return json.loads((folder / 'results.json').read_text())


def test_results_have_the_structure_that_readers_rely_on(results: Any) -> None:
    for preset in (results, *results['presets'].values()):
        assert set(preset['planners']) == set(preset['lambda']) == {'bfs', 'astar'}
        for planners in preset['planners'].values():
            assert set(planners) == set(STRATEGIES)
            for estimates in planners.values():
                assert set(estimates) == MEASURES
                assert set(estimates['success']) == {'mean', 'ci', 'p', 'se'}
        for found in preset['lambda'].values():
            assert len(found['values']) == 4
            assert set(found['measures']) == set(found['correlation']) == MEASURES
        assert {row['search'] for row in preset['table1']} == {'random', 'bfs', 'astar'}
        for claim in preset['claims']:
            assert set(claim) == CLAIM
            assert claim['paper'] or claim['analysis']
            verdict = claim['verdict']
            differs = 'differs' in (verdict['effect'], verdict['size'])
            assert bool(claim['why']) == differs
        assert len(preset['claims']) >= 45
    assert set(results['presets']) == {'text', 'published'}
    assert results['preset'] == 'published'
    assert len(results['switches']) == 8
    assert all(size['states'] > size['cells'] for size in results['sizes'])


def test_other_searches_have_the_numbers_of_their_trials(folder: Path, results: Any) -> None:
    """Every trial is in one row, and its means are those of its trials."""
    trials = pd.read_parquet(folder / 'beyond' / 'trials.parquet')
    assert len(results['beyond']) == 4
    counted = 0
    for row in results['beyond']:
        chosen = trials[(trials['search'].astype(str) == row['search']).to_numpy(bool)]
        for name, value in row['settings'].items():
            chosen = chosen[(chosen[name] == value).to_numpy(bool)]
        counted += len(chosen)
        won = chosen[(chosen['status'] == 'success').to_numpy(bool)]
        assert row['success']['mean'] == pytest.approx(len(won) / len(chosen))
        means = [
            part['solution_cost'].mean()
            for _, part in won.groupby('stimulus', observed=True)
            if len(part)
        ]
        expected = float(np.mean(means)) if means else None
        assert row['states_evaluated']['mean'] == pytest.approx(expected)
        assert row['all_attempts']['mean'] == pytest.approx(chosen['action_planning_cost'].mean())
    assert counted == len(trials)
    assert {row['search'] for row in results['beyond']} == {'beam', 'mcts'}


def test_exact_values_stand_beside_the_sampled_ones(results: Any) -> None:
    for row in results['table1']:
        if row['search'] == 'astar':
            assert row['exact'] is None
        else:
            assert 0 < row['exact']['success'] < 1
            # The mean of 16 towers with 2 seeds each.
            assert abs(row['success']['mean'] - row['exact']['success']) < 0.2


def test_people_stand_beside_every_planner(folder: Path, results: Any) -> None:
    planners = [f'{search} {how}' for search in ('bfs', 'astar') for how in STRATEGIES]
    found = results['behaviour']
    assert [row['who'] for row in found['building']] == ['people', *planners]
    assert set(found['difficulty']['rho']) == set(planners)
    html = (folder / 'report.html').read_text()
    for row in found['building']:
        shown = f'{100 * row["measures"]["lowest_row"]["mean"]:.1f}'
        assert f'>{shown} <span' in html


def test_report_is_in_one_piece(folder: Path) -> None:
    html = (folder / 'report.html').read_text()
    assert html.count('data:image/svg+xml;base64,') == len(FIGURES)
    assert not re.search(r'(src|href)="(?!data:|#)', html)
    assert 'http' not in re.sub(r'base64,[^"]*', '', html)
    assert html.count('<figcaption>') == len(FIGURES)
    assert 'quick run' in html
    assert 'nan' not in re.sub(r'base64,[^"]*', '', html)


@pytest.mark.parametrize('name', FIGURES)
def test_figures_are_drawn(folder: Path, name: str) -> None:
    assert (folder / 'figures' / f'{name}.svg').read_text().count('<path') > 20
    with Image.open(folder / 'figures' / f'{name}.png') as picture:
        assert picture.width >= 1000
        assert np.asarray(picture.convert('L')).std() > 10


def test_numbers_follow_from_the_tables(folder: Path, results: Any) -> None:
    trials = read_trials(folder / 'sweep')
    again = summarise(trials, 'published')
    assert again['planners'] == results['presets']['published']['planners']
    chosen = trials[
        (trials['search'] == 'astar')
        & (trials['divisor'] == 'mean')
        & (trials['strategy'] == 'full')
    ]
    by_tower = chosen[chosen['success']].groupby('stimulus', observed=True)
    expected = by_tower['action_planning_cost'].mean().mean()
    found = again['planners']['astar']['full']['action_planning_cost']['mean']
    assert found == pytest.approx(expected)


def test_groups_keep_towers_apart(folder: Path) -> None:
    trials = planners_of(read_trials(folder / 'sweep'), 'text').query("strategy == 'none'")
    bfs = trials[trials['search'] == 'bfs']
    groups = groups_of(bfs, 'success')
    assert [len(group) for group in groups] == [2] * 16
    costs = groups_of(bfs, 'blocks')
    assert [len(group) for group in costs] == [int(group.sum()) for group in groups]


def test_presets_share_no_trial_with_other_settings(folder: Path) -> None:
    trials = read_trials(folder / 'sweep')
    for preset, commit, dead_ends, divisor, execute in (
        ('published', 'subgoal', 'worst', 'mean', 'path'),
        ('text', 'action', 'ignored', 'smallest', 'first'),
    ):
        chosen = planners_of(trials, preset)
        assert set(chosen['commit'].dropna()) == {commit}
        assert set(chosen['dead_ends'].dropna()) == {dead_ends}
        assert set(chosen['divisor'].dropna()) == {divisor}
        assert set(chosen['execute'].dropna()) == {execute}
        # 16 towers, 2 seeds, 2 searches; none, 4 values of lambda, full.
        assert len(chosen) == 16 * 2 * 2 * 6


def test_exact_row_must_have_the_same_settings() -> None:
    table = [{'search': 'bfs', 'depth': 2}, {'search': 'bfs', 'depth': 3}]
    values = {'success': 0.5, 'states_evaluated': 9.0, 'within_budget': 0.7}
    add_exact(table, [{'search': 'bfs', 'depth': 3, **values}])
    assert [row['exact'] for row in table] == [None, values]


def test_people_have_the_share_that_the_paper_quotes() -> None:
    people = read_people()
    assert len(people) == 8
    assert people['attempts'].sum() == 2520
    share = np.average(people['perfect'], weights=people['attempts'])
    assert round(float(share), 3) == 0.224
    assert isinstance(people, pd.DataFrame)
