"""Records on stdout, the rest on stderr, and exit codes."""

from __future__ import annotations

import json

import pytest
from command import Run, read_back, subprocess_run

from blocks_planning.settings import setting_names, settings_of
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.verify import contradictions

KEYS: dict[str, type | tuple[type, ...]] = {
    'stimulus': str,
    'strategy': str,
    'search': str,
    'strategy_settings': dict,
    'seed': int,
    'status': str,
    'placements': list,
    'blocks': int,
    'subgoals': int,
    'action_planning_cost': int,
    'subgoal_planning_cost': int,
    'solution_cost': int,
}


def test_solve_prints_a_record_per_line(run: Run, towers: str) -> None:
    done = run('solve', towers, '--json', '--seeds', 2, '--seed', 5, '--depth', 2)
    assert (done.code, done.err) == (0, '')
    found = [json.loads(line) for line in done.out.splitlines()]
    for data in found:
        for key, kind in KEYS.items():
            assert type(data[key]) is kind, key
        assert all(len(placement) == 4 for placement in data['placements'])
        assert {type(number) for placement in data['placements'] for number in placement} == {int}
        assert data['blocks'] == len(data['placements'])
        assert list(contradictions(record_from_json(data, 'x'))) == []
    assert [(data['stimulus'], data['seed']) for data in found] == [
        (f'{towers}/{name}', seed) for name in ('chair', 'frame', 'square') for seed in (5, 6)
    ]


def test_settings_of_another_strategy_are_not_in_a_record(run: Run, towers: str) -> None:
    done = run('solve', f'{towers}/square', '--json', '--strategy', 'none')
    data = json.loads(done.out)
    assert set(data['strategy_settings']) == set(setting_names(NoSubgoals))


def test_options_reach_the_record(run: Run, towers: str) -> None:
    options = {
        'strategy': 'scoping', 'lambda': '0.25', 'commit': 'action', 'search': 'astar',
        'iterations': '7', 'divisor': 'mean', 'execute': 'path', 'budget': '50', 'seed': '9',
        'library': '2x1,1x2',
    }  # fmt: skip
    given = [word for name, value in options.items() for word in (f'--{name}', value)]
    data = json.loads(run('solve', f'{towers}/square', '--json', *given).out)
    assert data['search_settings'] == {'iterations': 7, 'divisor': 'mean', 'execute': 'path'}
    assert data['strategy_settings'] == {
        **settings_of(Scoping()), 'lambda': 0.25, 'commit': 'action', 'regions': 'rows',
    }  # fmt: skip
    for name in ('strategy', 'search', 'library'):
        assert data[name] == options[name]
    assert (data['budget'], data['seed']) == (50, 9)


@pytest.mark.parametrize(
    ('strategy', 'search', 'expected'),
    [
        ('none', 'bfs', (None, {'depth': 3, 'dead_ends': 'worst'})),
        ('scoping', 'random', (0.002, {})),
        ('full', 'exact', (1.0, {})),
        ('none', 'best_first', (None, {'iterations': 4096, 'execute': 'first'})),
        ('none', 'astar', (None, {'iterations': 4096, 'divisor': 'smallest', 'execute': 'first'})),
    ],
)
def test_defaults(run: Run, towers: str, strategy: str, search: str, expected: object) -> None:
    done = run('solve', f'{towers}/square', '--json', '--strategy', strategy, '--search', search)
    data = json.loads(done.out)
    found = (data['strategy_settings'].get('lambda'), data['search_settings'])
    assert found == expected
    assert (data['seed'], data['budget']) == (0, 100_000)


def test_largest_seed_and_budget_are_taken(run: Run, towers: str) -> None:
    done = run('solve', f'{towers}/square', '--seed', 2**64 - 1, '--budget', 2**63 - 1, '--json')
    assert done.code == 0
    assert json.loads(done.out)['seed'] == 2**64 - 1


@pytest.mark.parametrize('lam', ['1e308', '1.7976931348623157e308'])
def test_any_lambda_that_is_taken_gives_a_record(run: Run, towers: str, lam: str) -> None:
    done = run('solve', f'{towers}/chair', '--json', '--lambda', lam)
    if done.code == 2:
        assert 'lambda' in done.err
    else:
        assert json.loads(done.out)['status'] == 'success'


def test_exit_code_is_1_if_a_tower_was_not_rebuilt(run: Run, towers: str) -> None:
    done = run('solve', towers, '--depth', 2, '--lambda', 0.05, '--json')
    assert [json.loads(line)['status'] for line in done.out.splitlines()] == [
        'success',
        'gave_up',
        'success',
    ]
    assert (done.code, done.err) == (1, '')
    done = run('solve', towers, '--depth', 2, '--lambda', 0.05)
    assert (done.code, done.err) == (1, '')
    assert '2 of 3 trials rebuilt the tower perfectly' in ' '.join(done.out.split())


def test_progress_and_errors_do_not_go_to_stdout(towers: str) -> None:
    done = subprocess_run('solve', towers, '--seeds', 3, '--json', '--search', 'random')
    assert len(read_back(done.stdout)) == 9
    assert done.stderr == ''
    done = subprocess_run('solve', towers, 'nothing', '--json')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr.startswith("Error: stimulus 'nothing': ")
    assert done.stderr.count('\n') == 1
