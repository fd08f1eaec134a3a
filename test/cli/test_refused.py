"""Options and commands that are refused, in one line."""

from __future__ import annotations

import shlex
from pathlib import Path

import pytest
from command import Run


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
