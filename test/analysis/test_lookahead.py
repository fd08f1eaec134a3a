"""The experiment with regions and horizons: what is written is whole and follows from the trials."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from blocks_planning.analysis.lookahead import answers, read_lookahead, summarise
from blocks_planning.cli import commands


@pytest.fixture(scope='module')
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('lookahead')
    arguments = ['lookahead', '--quick', '--workers', '1', '--out', str(folder)]
    done = CliRunner().invoke(commands, arguments, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    assert 'needs the fewest states' in done.output
    return folder


def test_report_is_in_one_piece(folder: Path) -> None:
    html = (folder / 'report.html').read_text()
    plain = re.sub(r'base64,[^"]*', '', html)
    assert html.count('data:image/svg+xml;base64,') == 1
    assert 'quick run' in plain
    assert 'nan' not in plain
    assert 'http' not in plain
    assert (folder / 'figures' / 'lookahead.png').stat().st_size > 10_000


def test_numbers_follow_from_the_trials(folder: Path) -> None:
    trials = read_lookahead([folder / 'lookahead_quick'])
    results = json.loads((folder / 'results.json').read_text())
    assert results['trials'] == len(trials) == 2 * 2 * 2 * (6 + 4)
    assert len(results['cells']) == 2 * (6 + 4)
    assert results['seeds'] == {'0': [0, 1], '0.1': [0, 1]}
    for cell in results['cells']:
        mine = trials[trials['slip'] == cell['slip']]
        if cell['horizon'] is None:
            mine = mine[mine['strategy'] == cell['family']]
        else:
            mine = mine[(mine['regions'] == cell['family']) & (mine['horizon'] == cell['horizon'])]
            mine = mine[mine['lambda'] == cell['lambda']]
        assert len(mine) == 4
        success, states = mine['success'].mean(), mine['states'].mean()
        assert cell['success']['mean'] == pytest.approx(success)
        assert cell['states']['mean'] == pytest.approx(states)
        if success:
            assert cell['per_success'] == pytest.approx(states / success)
        else:
            assert cell['per_success'] is None
        assert sum(cell['statuses'].values()) == 4


def test_states_are_those_of_subgoals_and_plans(folder: Path) -> None:
    """A scoping trial evaluates what its candidates cost, and nothing else."""
    trials = read_lookahead([folder / 'lookahead_quick'])
    scoping = trials[trials['strategy'] == 'scoping']
    assert (scoping['states'] == scoping['subgoal_planning_cost']).all()


def test_a_planner_is_worth_its_cost_if_no_other_beats_it(folder: Path) -> None:
    trials = read_lookahead([folder / 'lookahead_quick'])
    names = ['none', 'full', 'rows 1 lambda 0.002']
    few = trials[(trials['slip'] == 0) & trials['planner'].isin(names)].copy()
    made = {'none': (0.0, 5.0), 'full': (1.0, 90.0), 'rows 1 lambda 0.002': (1.0, 80.0)}
    for measure, at in (('success', 0), ('states', 1)):
        few[measure] = [made[planner][at] for planner in few['planner']]
    results = summarise(few)
    worth = {cell['planner']: cell['worth'] for cell in results['cells']}
    assert worth == {'none': True, 'full': False, 'rows 1 lambda 0.002': True}
    (sentence,) = answers(results)
    assert 'none rebuilds 0.00 at 5 states; rows 1 lambda 0.002 rebuilds 1.00 at 80' in sentence
    assert (
        'rows 1 lambda 0.002 needs the fewest states for each tower that it rebuilds (80)'
        in sentence
    )


def test_worlds_may_have_their_own_seeds_and_planners(folder: Path) -> None:
    """As in the whole experiment: more seeds where blocks slip, and not every planner."""
    trials = read_lookahead([folder / 'lookahead_quick'])
    of_both = trials[(trials['slip'] > 0) | (trials['seed'] == 0)]
    of_both = of_both[(of_both['slip'] == 0) | (of_both['strategy'] == 'full')]
    results = summarise(of_both)
    assert results['seeds'] == {'0': [0], '0.1': [0, 1]}
    (cell,) = (cell for cell in results['cells'] if cell['slip'] > 0)
    assert cell['planner'] == 'full'
    assert cell['worth']
    mine = trials[(trials['slip'] > 0) & (trials['strategy'] == 'full')]
    assert cell['states']['mean'] == pytest.approx(mine['states'].mean())
