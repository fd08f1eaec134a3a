"""Ctrl-C, and readers that have seen enough."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from command import COMMAND, DEADLINE_S, draw_towers, read_back

from blocks_planning.trials.verify import contradictions

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
    draw_towers(path, small='##/##', large=LARGE, never='##')
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
    draw_towers(path, small='##/##', large=LARGE)
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
