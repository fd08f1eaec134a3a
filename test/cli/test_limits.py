"""Towers that reach a limit are reported in their rows; the exit code is 3."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import pytest

from blocks_planning.cli import main
from blocks_planning.search import exact, memory

LARGE = '\n'.join(['#' * 16] * 16)
TOWERS = f'tower large\n{LARGE}\n\ntower small\n####\n'


class Command:
    """Calls the command in this process."""

    def __init__(
        self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        self._monkeypatch, self._capsys = monkeypatch, capsys

    def __call__(self, *words: str) -> tuple[object, list[str], str]:
        self._monkeypatch.setattr(sys, 'argv', ['blocks-planning', *words])
        with pytest.raises(SystemExit) as ended:
            main()
        out, err = self._capsys.readouterr()
        return ended.value.code or 0, out.splitlines(), err


@pytest.fixture
def command(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Command:
    (tmp_path / 'towers.txt').write_text(TOWERS)
    monkeypatch.chdir(tmp_path)
    return Command(monkeypatch, capsys)


def test_exact_reports_a_tower_that_is_too_large(
    command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(exact, 'MAX_STATES', 1_000)
    code, (large, small), _ = command('exact', 'towers.txt')
    assert code == 3
    assert large.startswith('towers.txt/large: exact: a region of this shape on 16 x 16 cells')
    assert large.endswith('more than the limit of 1000 states')
    assert small == (
        'towers.txt/small: fewest blocks 2; arrangements 1, with fewest blocks 1; '
        'by number of rows: 2'
    )
    code, rows, _ = command('exact', 'towers.txt', '--json')
    assert code == 3
    assert sorted(json.loads(rows[0])) == ['problem', 'stimulus']


def test_count_reports_the_depths_that_were_finished(command: Command) -> None:
    words = ('count', 'towers.txt', '--depth', '30', '--time-limit', '4')
    code, (large, small), _ = command(*words, '--json')
    assert code == 3
    found = json.loads(large)
    assert found['problem'] == 'not finished within the time limit of 4 s'
    assert len(found['counts']) < 30
    assert found['counts'][:1] in ([], [74])
    counts = json.loads(small)['counts']
    assert (len(counts), 'problem' in json.loads(small)) == (30, False)


def test_solve_reports_a_trial_that_the_time_limit_ended(command: Command) -> None:
    words = ('--strategy', 'none', '--depth', '30', '--budget', str(2**62), '--time-limit', '4')
    code, rows, err = command('solve', 'towers.txt', '--json', *words)
    assert code == 3
    assert [json.loads(row)['status'] for row in rows] == ['cancelled', 'success']
    said = 'towers.txt/large, seed 0: cancelled: not finished within the time limit of 4 s'
    assert said in err.splitlines()


def test_solve_reports_a_search_that_outgrew_its_memory(
    command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(memory, 'MAX_NODES', 1 << 10)
    monkeypatch.setattr(memory, '_NODES_PER_ITERATION', 1)
    words = ('--strategy', 'none', '--search', 'astar', '--iterations', '1000')
    code, rows, err = command('solve', 'towers.txt/large', '--json', *words)
    assert (code, json.loads(rows[0])['status']) == (3, 'gave_up')
    assert err == (
        'towers.txt/large, seed 0: gave_up: a region is too large for the memory of astar\n'
    )


def test_exact_policy_has_a_time_limit(command: Command) -> None:
    words = ('exact-policy', 'towers.txt', '--depth', '30', '--time-limit', '1')
    code, (large, small), _ = command(*words)
    assert code == 3
    assert large == 'towers.txt/large: not finished within the time limit of 1 s'
    assert small.startswith('towers.txt/small: one attempt succeeds')


@pytest.mark.parametrize('name', ['solve', 'exact', 'count', 'exact-policy'])
@pytest.mark.parametrize('value', ['0', '-2', 'nan', 'soon'])
def test_a_time_limit_that_is_none_is_refused(command: Command, name: str, value: str) -> None:
    code, out, err = command(name, 'towers.txt', '--time-limit', value)
    assert (code, out) == (2, [])
    assert 'time-limit' in err
