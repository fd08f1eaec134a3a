"""Hostile messages and spoilt files, a few of them; `make fuzz` has many."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from bag_builders import Said, trial_said, write_bag
from builders import SQUARE, record, spec
from graphs import NODES

from blocks_planning.errors import ConfigurationError, RecordError
from blocks_planning.located import MAX_FILE_BYTES, MAX_VALUES, read_yaml
from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.wire.topics import STATE, TRIAL
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.script import read_script
from faults import fuzz_files, fuzz_messages

HEAD = 'stimuli: [cogsci2021/5]\nseeds: 1\n'
SEARCHES = 'searches: [{name: bfs}]\n'


def test_graph_goes_on_among_hostile_messages(tmp_path: Path) -> None:
    report = fuzz_messages.fuzz(tmp_path, 1000, seed=11, interruptions=4)
    assert report.failures == []
    assert report.sent.total() >= 900
    assert report.sent['interruptions'] == 4


def test_spoilt_files_are_read_or_refused(tmp_path: Path) -> None:
    came, failures = fuzz_files.fuzz(tmp_path, 250, seed=12)
    assert failures == []
    for kind in ('towers.txt', 'script.yaml', 'records.jsonl', 'trials.jsonl', 'nodes.yaml'):
        assert came[f'{kind}: refused'] > 0
        assert came[f'{kind}: read'] > 0


def _refusal(tmp_path: Path, text: str) -> str:
    path = tmp_path / 'x.yaml'
    path.write_text(text, encoding='utf-8')
    with pytest.raises(ConfigurationError) as refused:
        read_script(path)
    message = str(refused.value)
    assert '\n' not in message
    assert len(message) < 500
    return message.removeprefix(str(path))


@pytest.mark.parametrize('tag', ['!!bool maybe', '!!int ""', '!!timestamp soon', '!!float x'])
def test_tag_that_does_not_fit_its_value_is_refused(tmp_path: Path, tag: str) -> None:
    message = _refusal(tmp_path, f'{HEAD}budget: {tag}\n')
    assert message.startswith(", line 3, key 'budget': ")
    assert message.endswith('is not a value that can be read')


def test_aliases_of_aliases_are_counted(tmp_path: Path) -> None:
    lines = ['a0: &a0 [1, 1]']
    for number in range(1, 12):
        below = ', '.join([f'*a{number - 1}'] * 9)
        lines += [f'a{number}: &a{number} [{below}]']
    assert f'has more than {MAX_VALUES} values' in _refusal(tmp_path, '\n'.join(lines))


def test_alias_of_itself_is_refused(tmp_path: Path) -> None:
    assert _refusal(tmp_path, 'stimuli: &a [*a]\n')


def test_file_that_is_too_large_is_refused(tmp_path: Path) -> None:
    path = tmp_path / 'x.yaml'
    path.write_bytes(b'#' * MAX_FILE_BYTES)
    with pytest.raises(ConfigurationError, match='is empty'):
        read_yaml(path)
    path.write_bytes(b'#' * (MAX_FILE_BYTES + 1))
    with pytest.raises(ConfigurationError, match='is larger than'):
        read_yaml(path)


@pytest.mark.parametrize('value', ['x' * 5000, '[' + '1, ' * 5000 + ']', '0x' + 'f' * 9000])
def test_long_value_is_cut_in_the_error(tmp_path: Path, value: str) -> None:
    _refusal(tmp_path, f'stimuli: {value}\nseeds: {value}\n{SEARCHES}strategies: {value}\n')


def test_lists_of_lists_of_settings_are_counted(tmp_path: Path) -> None:
    commits = ', '.join(['action'] * 99)
    lambdas = '{from: 0, to: 1, count: 9999}'
    planner = f'{{name: scoping, lambda: {lambdas}, commit: [{commits}]}}'
    text = f'{HEAD}{SEARCHES}strategies: [{planner}]\n'
    assert 'more than 100000 combinations' in _refusal(tmp_path, text)


def test_number_of_hundreds_of_digits_is_refused(tmp_path: Path) -> None:
    lambdas = f'{{from: 0, to: 1{"0" * 400}, count: 3}}'
    text = f'{HEAD}{SEARCHES}strategies: [{{name: scoping, lambda: {lambdas}}}]\n'
    assert 'expected a number' in _refusal(tmp_path, text)


@pytest.mark.parametrize(
    ('text', 'said'),
    [
        ('/**:\n  ros__parameters:\n    wait_for: [a, 1]\n', 'Sequence should be of same type'),
        ('/**:\n  ros__parameters:\n    use_sim_time: 5\n', 'use_sim_time'),
        ('a: &x [1]\n', 'ROS arguments: '),
        ('- 1\n', 'ROS arguments: '),
        (None, 'Error opening YAML file'),
    ],
)
def test_node_with_a_broken_file_of_parameters_ends_with_one_line(
    tmp_path: Path, text: str | None, said: str
) -> None:
    path = tmp_path / 'nodes.yaml'
    if text is not None:
        path.write_text(text, encoding='utf-8')
    command = [sys.executable, '-m', NODES, 'world', '--ros-args', '--params-file', str(path)]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr.startswith('Error: ')
    assert len(done.stderr.splitlines()) == 1
    assert said in done.stderr


def test_long_words_of_records_and_settings_are_cut_in_the_error(tmp_path: Path) -> None:
    long = 'x' * 5000
    path = tmp_path / 'records.jsonl'
    for line in (
        record(SQUARE).to_line().replace('"seed"', f'"{long}":1,"seed"', 1),
        record(SQUARE).to_line().replace('"seed"', f'"{long}":1,"{long}":2,"seed"', 1),
    ):
        path.write_text(line, encoding='utf-8')
        with pytest.raises(RecordError) as refused:
            read_records(path)
        assert len(str(refused.value)) < 500
    for setting in (f'lambda: {long}', f'commit: {long}', f'{long}: 1'):
        text = f'{HEAD}{SEARCHES}strategies: [{{name: scoping, {setting}}}]\n'
        _refusal(tmp_path, text)
    _refusal(tmp_path, f'{HEAD}library: {long}\n{SEARCHES}strategies: [{{name: none}}]\n')


def test_bag_with_messages_that_say_nothing_is_read_but_for_them(tmp_path: Path) -> None:
    trial, said = trial_said(spec(SQUARE))
    spoilt = [Said(one.topic, one.message) for one in said if one.topic in (TRIAL, STATE)]
    for one in spoilt:
        one.__dict__['data'] = one.data[:9]
    bag = write_bag(tmp_path / 'bag', [*spoilt, *said])
    refused: list[str] = []
    (found,) = trials_of(bag, refused.append)
    assert found.record == trial
    assert len(refused) == len(spoilt)
    assert all('its bytes are invalid' in sentence for sentence in refused)
