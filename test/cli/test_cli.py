"""The ``blocks-planning`` command: results on stdout, the rest on stderr, and exit codes."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import click
import pytest
from builders import CHAIR, FRAME, TOWERS, record, record_json, remade

from blocks_planning import __version__
from blocks_planning.cli import commands, main
from blocks_planning.settings import setting_names, settings_of
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.reading import read_records, record_from_json
from blocks_planning.trials.verify import contradictions

COMMAND = [sys.executable, '-m', 'blocks_planning.cli']
DEADLINE_S = 60


class Done(NamedTuple):
    """How a command ended."""

    code: object
    out: str
    err: str


Run = Callable[..., Done]


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Calls the command in this process, in a terminal of 80 columns."""
    monkeypatch.setenv('COLUMNS', '80')

    def call(*arguments: object) -> Done:
        monkeypatch.setattr(sys, 'argv', ['blocks-planning', *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Done(ended.value.code or 0, *capsys.readouterr())

    return call


@pytest.fixture
def towers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A file with small towers, in the working directory."""
    monkeypatch.chdir(tmp_path)
    _draw(tmp_path / 'towers.txt', chair=CHAIR, frame=FRAME, square='##/##')
    return 'towers.txt'


def _draw(path: Path, **pictures: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    parts = (f'tower {name}\n{rows}\n' for name, rows in pictures.items())
    path.write_text('\n'.join(parts).replace('/', '\n'))


def subprocess_run(*arguments: object, **settings: Any) -> subprocess.CompletedProcess[str]:
    """The command as a process of its own."""
    command = [*COMMAND, *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=DEADLINE_S, **settings)


# Help.


def _all_commands() -> Iterator[tuple[str, click.Command]]:
    for name, command in commands.commands.items():
        yield name, command
        if isinstance(command, click.Group):
            for below, inner in command.commands.items():
                yield f'{name} {below}', inner


COMMANDS = dict(_all_commands())


@pytest.mark.parametrize('name', ['', *COMMANDS])
def test_help_has_an_example(run: Run, name: str) -> None:
    for option in ('--help', '-h'):
        done = run(*name.split(), option)
        assert (done.code, done.err) == (0, '')
        assert re.search(rf'^ .*blocks-planning {name}', done.out, re.MULTILINE)
        assert max(map(len, done.out.splitlines())) <= 99


EXAMPLES = [
    line.strip()
    for command in COMMANDS.values()
    for line in (command.epilog or '').splitlines()
    if line.strip().startswith('blocks-planning ')
]


@pytest.mark.parametrize('example', EXAMPLES)
def test_example_is_understood(example: str) -> None:
    words = shlex.split(example.partition('>')[0])[1:]
    name = next(
        name
        for name in sorted(COMMANDS, reverse=True)
        if words[: len(name.split())] == name.split()
    )
    COMMANDS[name].make_context(name, words[len(name.split()) :])


def test_version(run: Run) -> None:
    assert run('--version') == (0, f'blocks-planning, version {__version__}\n', '')


# Solve.


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
    _draw(tmp_path / name, square='##/##', flat='##')
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


def test_progress_and_errors_do_not_go_to_stdout(towers: str) -> None:
    done = subprocess_run('solve', towers, '--seeds', 3, '--json', '--search', 'random')
    assert len(read_back(done.stdout)) == 9
    assert done.stderr == ''
    done = subprocess_run('solve', towers, 'nothing', '--json')
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr.startswith("Error: stimulus 'nothing': ")
    assert done.stderr.count('\n') == 1


def read_back(text: str) -> list[Any]:
    """The records of a text, one in a line."""
    return [record_from_json(json.loads(line), 'stdout') for line in text.splitlines()]


# What is refused.


@pytest.mark.parametrize(
    ('options', 'words'),
    [
        ('--strategy fast', "'fast' is not one of"),
        ('--search dfs', "'dfs' is not one of"),
        ('--commit all', "'all' is not one of"),
        ('--search astar --divisor 2', "'2' is not one of"),
        ('--search astar --execute all', "'all' is not one of"),
        ('--depth 0', 'depth must be a whole number from 1 to 64, got 0'),
        ('--depth 65', 'got 65'),
        ('--depth -1', 'got -1'),
        ('--depth 1.5', "'1.5' is not a valid integer"),
        ('--search astar --iterations 1', 'iterations must be a whole number from 2 to'),
        ('--search best_first --iterations 0', 'got 0'),
        ('--search astar --iterations 10000000000', 'got 10000000000'),
        ('--lambda nan', 'lambda must be a finite number of 0 or more, got nan'),
        ('--lambda -1', 'lambda must be a finite number of 0 or more, got -1.0'),
        ('--lambda inf', 'got inf'),
        ('--lambda -inf', 'got -inf'),
        ('--lambda 1e999', 'got inf'),
        ('--lambda few', "'few' is not a valid float"),
        ('--strategy full --lambda 0', 'lambda must be a finite number above 0, got 0.0'),
        ('--strategy none --lambda 1', "strategy none has no setting 'lambda'"),
        ('--strategy none --commit action', "strategy none has no setting 'commit'"),
        ('--strategy full --commit action', "strategy full has no setting 'commit'"),
        ('--search astar --depth 3', "search astar has no setting 'depth'"),
        ('--search random --depth 3', "search random has no setting 'depth'; it has none"),
        ('--search bfs --iterations 9', "search bfs has no setting 'iterations'"),
        ('--search best_first --divisor mean', "search best_first has no setting 'divisor'"),
        ('--search exact --execute path', "search exact has no setting 'execute'"),
        ('--budget -1', 'budget must be a whole number from 0 to'),
        (f'--budget {2**63}', f'got {2**63}'),
        ('--budget 1e5', "'1e5' is not a valid integer"),
        ('--seed -1', 'seed must be a whole number from 0 to'),
        (f'--seed {2**64}', f'got {2**64}'),
        (f'--seed {2**64 - 1} --seeds 2', f'got {2**64}'),
        (f'--seed {"9" * 5000}', 'is not a valid integer'),
        ('--seeds 0', '0 is not in the range'),
        ('--seeds -3', '-3 is not in the range'),
        ('--seeds many', "'many' is not a valid integer"),
        ('--library junk', '--library: expected blocks as WIDTHxHEIGHT between commas'),
        ('--library 17x1', '--library: the sides of a block are 1 to 16 cells, got 17x1'),
        ('--library 0x1', 'got 0x1'),
        ('--library 1x2,2x1,1x2', '--library: block 1x2 is listed twice'),
        ("--library ''", "got ''"),
        ('--fast', 'No such option'),
        ('--depth', 'requires an argument'),
        ('--json=yes', 'does not take a value'),
    ],
)
def test_bad_option_is_refused(run: Run, towers: str, options: str, words: str) -> None:
    for as_json in ([], ['--json']):
        done = run('solve', towers, *as_json, *shlex.split(options))
        assert (done.code, done.out) == (2, '')
        assert words in done.err
        assert done.err.count('Error: ') == 1
        assert 'Traceback' not in done.err


@pytest.mark.parametrize(
    ('command', 'words'),
    [
        ('solve', "Missing argument 'STIMULUS...'"),
        ('solve nothing', "stimulus 'nothing': no such file, and no such set"),
        ('solve cogsci2021/99', "has no tower '99'"),
        ('solve .', '.: is a directory'),
        ('solve bad.txt', 'bad.txt, line 2, column 2'),
        ('watch bad.txt', 'bad.txt, line 2, column 2'),
        ('watch', "Missing argument 'STIMULUS...'"),
        ('watch cogsci2021/9 --pause -1', '-1.0 is not in the range'),
        ('watch cogsci2021/9 --pause nan', 'nan'),
        ('watch cogsci2021/9 --depth 0', 'depth must be'),
        ('count bad.txt', 'bad.txt, line 2, column 2'),
        ('count cogsci2021/1 --depth 0', '0 is not in the range'),
        ('count cogsci2021/1 --depth 65', '65 is not in the range'),
        ('count cogsci2021/1 --library 1x', '--library: expected blocks'),
        ('exact bad.txt', 'bad.txt, line 2, column 2'),
        ('exact cogsci2021/1 --library 1x2,1x2', 'listed twice'),
        ('stimuli show', "Missing argument 'STIMULUS...'"),
        ('stimuli show nothing', "stimulus 'nothing'"),
        ('stimuli hide', "No such command 'hide'"),
        ('verify', "Missing argument 'RECORD...'"),
        ('verify missing.json', 'missing.json: cannot be read: No such file or directory'),
        ('verify .', '.: cannot be read: Is a directory'),
        ('verify bad.txt', 'bad.txt, line 1: is not JSON'),
        ('draw missing.json --out x.png', 'missing.json: cannot be read'),
        ('draw bad.txt', "Missing option '--out'"),
        ('rebuild', "No such command 'rebuild'"),
        ('--fast', 'No such option'),
    ],
)
def test_bad_command_is_refused(run: Run, towers: str, command: str, words: str) -> None:
    Path('bad.txt').write_text('##\n#?\n')
    done = run(*command.split())
    assert (done.code, done.out) == (2, '')
    assert words in done.err
    assert done.err.count('Error: ') == 1


# Stimuli, count, exact.


def test_stimuli_lists_the_sets(run: Run) -> None:
    assert run('stimuli') == (0, 'cogsci2021: 16 silhouettes, 8x8 cells\n', '')


def test_stimuli_show_draws_what_can_be_read_again(run: Run, towers: str) -> None:
    done = run('stimuli', 'show', towers, 'cogsci2021/3')
    assert (done.code, done.err) == (0, '')
    Path('again.txt').write_text(done.out)
    assert run('stimuli', 'show', 'again.txt').out.count('#\n') == done.out.count('#\n')
    assert f'# {towers}/chair\n\n' + CHAIR.replace('/', '\n') in done.out
    one = run('stimuli', 'show', 'cogsci2021/3')
    assert one.out.splitlines()[0] == '# cogsci2021/3'
    assert [len(line) for line in one.out.splitlines()[2:]] == [8] * 8


COUNTS = {
    1: [22, 394, 5695],
    2: [31, 833, 19788],
    3: [25, 603, 12523],
    4: [18, 370, 7871],
    5: [17, 278, 4309],
    6: [16, 226, 2936],
    7: [18, 315, 5103],
    8: [22, 414, 6957],
}


def test_count_prints_published_numbers(run: Run) -> None:
    addresses = [f'cogsci2021/{tower}' for tower in COUNTS]
    done = run('count', *addresses, '--depth', 3, '--json')
    assert (done.code, done.err) == (0, '')
    assert [json.loads(line) for line in done.out.splitlines()] == [
        {'stimulus': f'cogsci2021/{tower}', 'counts': counts} for tower, counts in COUNTS.items()
    ]
    assert run('count', 'cogsci2021/2') == (0, 'cogsci2021/2: 31  833  19,788  435,221\n', '')


def test_exact_prints_published_numbers(run: Run) -> None:
    done = run('exact', 'cogsci2021/1', 'cogsci2021/7', '--json')
    assert (done.code, done.err) == (0, '')
    first, second = map(json.loads, done.out.splitlines())
    assert list(first) == [
        *('stimulus', 'fewest_blocks', 'arrangements', 'optimal_arrangements', 'by_rows'),
        'placements',
    ]
    assert first['stimulus'] == 'cogsci2021/1'
    assert (first['fewest_blocks'], first['arrangements']) == (10, 12780)
    assert first['by_rows'] == [4, None, 8, 6, 10, 9, 12, 10]
    assert len(first['placements']) == 10
    assert all(len(placement) == 4 for placement in first['placements'])
    assert second['by_rows'] == [3, 2, None, 5, None, None, None, 12]
    assert run('exact', 'cogsci2021/1').out == (
        'cogsci2021/1: fewest blocks 10; arrangements 12,780, with fewest blocks 1; '
        'by number of rows: 4 - 8 6 10 9 12 10\n'
    )


def test_exact_says_what_is_impossible(run: Run, tmp_path: Path) -> None:
    _draw(tmp_path / 'odd.txt', odd='#./##')
    done = run('exact', tmp_path / 'odd.txt', '--json')
    data = json.loads(done.out)
    assert done.code == 0
    assert (data['fewest_blocks'], data['arrangements'], data['placements']) == (None, 0, None)
    assert (
        'impossible; arrangements 0; by number of rows: 1 -'
        in run('exact', tmp_path / 'odd.txt').out
    )


def test_watch_plays_a_trial_and_says_how_it_ended(run: Run, towers: str) -> None:
    done = run('watch', f'{towers}/square', '--pause', 0)
    assert (done.code, done.err) == (0, '')
    assert f'{towers}/square' in done.out
    assert run('watch', f'{towers}/frame', '--pause', 0, '--depth', 2, '--lambda', 0.05).code == 1


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


LARGE = '/'.join(['.' + '#' * 15, *['#' * 16] * 15])


def _interrupted(arguments: list[str], lines: int) -> tuple[int, list[str], str]:
    """Interrupt a command that has printed some lines, and then works on."""
    command = [*COMMAND, *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        printed = [process.stdout.readline() for _ in range(lines)]
        deadline = time.monotonic() + DEADLINE_S
        enough = _cpu_s(process.pid) + (0.5 if lines else 3)
        while _cpu_s(process.pid) < enough:
            assert process.poll() is None, 'it was over before it could be interrupted'
            assert time.monotonic() < deadline
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=DEADLINE_S)
    finally:
        process.kill()
        process.wait()
    return process.returncode, [*printed, *out.splitlines()], err


def _cpu_s(pid: int) -> float:
    """Processor time that a process has used."""
    times = Path(f'/proc/{pid}/stat').read_text().rpartition(')')[2].split()[11:13]
    return sum(map(int, times)) / os.sysconf('SC_CLK_TCK')


@pytest.mark.parametrize('strategy', ['none', 'scoping'])
def test_interrupted_solve_prints_what_there_is(tmp_path: Path, strategy: str) -> None:
    path = tmp_path / 'towers.txt'
    _draw(path, small='##/##', large=LARGE, never='##')
    options = ['--strategy', strategy, '--depth', '12', '--budget', str(2**63 - 1), '--json']
    code, lines, err = _interrupted(['solve', str(path), *options], lines=1)
    assert code == 130
    assert err.splitlines()[-1] == 'Interrupted.'
    found = read_back(''.join(line.strip() + '\n' for line in lines))
    assert [data.spec.stimulus for data in found] == [f'{path}/small', f'{path}/large']
    assert [data.status.value for data in found] == ['success', 'cancelled']
    assert list(contradictions(found[1])) == []


def test_interrupted_table_and_count_end_in_order(tmp_path: Path) -> None:
    path = tmp_path / 'towers.txt'
    _draw(path, small='##/##', large=LARGE)
    code, lines, err = _interrupted(['count', str(path), '--depth', '30', '--json'], lines=1)
    assert (code, len(lines), err.splitlines()[-1]) == (130, 1, 'Interrupted.')


@pytest.mark.parametrize(
    'arguments',
    [
        [
            'solve',
            'cogsci2021',
            '--search',
            'random',
            '--strategy',
            'none',
            '--seeds',
            '9',
            '--json',
        ],
        ['stimuli', 'show', *['cogsci2021'] * 99],
    ],
    ids=['solve', 'show'],
)
def test_reader_that_has_seen_enough_is_no_error(arguments: list[str]) -> None:
    command = [*COMMAND, *arguments]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        assert process.stdout.readline()
        process.stdout.close()
        err = process.stderr.read()
        process.wait(DEADLINE_S)
    assert err == ''


def test_records_of_solve_hold(tmp_path: Path, towers: str) -> None:
    """From one end to the other, as two processes."""
    done = subprocess_run('solve', towers, '--depth', 2, '--json')
    path = tmp_path / 'records.jsonl'
    path.write_text(done.stdout)
    assert len(read_records(path)) == 3
    assert subprocess_run('verify', path, '--rerun').stdout.endswith('all consistent\n')
