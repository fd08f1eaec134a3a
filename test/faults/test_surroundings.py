"""Everything stays on this machine and in its folder, and nothing that is read runs code."""

from __future__ import annotations

import ast
import socket
import struct
from collections.abc import Iterator
from pathlib import Path

import pytest
from graphs import bring_up, node_processes, record_lines, wait_until, write_script
from source_imports import Source, imports, package_sources

NAMES = {'world', 'subgoal_selector', 'action_searcher', 'trial_orchestrator', 'bag_recorder'}
MANY = 2000
FORBIDDEN_MODULES = {'pickle', 'marshal', 'shelve', 'dill', 'cloudpickle'}
FORBIDDEN_CALLS = {'eval', 'exec', 'compile', '__import__', 'system', 'popen', 'execfile'}
UNSAFE_YAML = {'load', 'load_all', 'full_load', 'full_load_all', 'unsafe_load', 'unsafe_load_all'}


def _addresses(table: str) -> dict[str, str]:
    """The local address of every socket in a table of the kernel, by inode."""
    found = {}
    for line in Path('/proc/net', table).read_text(encoding='utf-8').splitlines()[1:]:
        words = line.split()
        digits = words[1].partition(':')[0]
        family = socket.AF_INET if len(digits) == 8 else socket.AF_INET6
        parts = [int(digits[at : at + 8], 16) for at in range(0, len(digits), 8)]
        found[words[9]] = socket.inet_ntop(family, struct.pack(f'={len(parts)}I', *parts))
    return found


def _sockets(pid: int) -> set[str]:
    """The inodes of a process's sockets."""
    found = set()
    for path in Path(f'/proc/{pid}/fd').iterdir():
        try:
            target = str(path.readlink())
        except OSError:
            continue
        if target.startswith('socket:['):
            found.add(target[8:-1])
    return found


def test_graph_has_sockets_on_this_machine_only(tmp_path: Path) -> None:
    script, out = write_script(tmp_path, seeds=MANY), tmp_path / 'out'
    with bring_up(script, '--out', out, '--bag', tmp_path / 'bag') as process:
        wait_until(process, lambda: len(record_lines(out)) >= 2)
        pids = {**node_processes(process.pid), 'bring-up': process.pid}
        assert set(pids) == NAMES | {'bring-up'}
        inodes = {inode: name for name, pid in pids.items() for inode in _sockets(pid)}
        tables = ('udp', 'udp6', 'tcp', 'tcp6', 'raw', 'raw6')
        bound = [
            (inodes[inode], table, address)
            for table in tables
            for inode, address in _addresses(table).items()
            if inode in inodes
        ]
    assert {name for name, _, _ in bound} == set(pids)
    assert [one for one in bound if not one[2].startswith('127.') and one[2] != '::1'] == []


@pytest.mark.long
def test_graph_leaves_files_in_its_folder_only(tmp_path: Path) -> None:
    """Names come from scripts and messages; nothing is written beside the folder."""
    towers = tmp_path / 'towers.txt'
    towers.write_text('tower ..\n##\n##\n\ntower .\n##\n', encoding='utf-8')
    script, out = write_script(tmp_path, stimuli=[str(towers)]), tmp_path / 'deep' / 'out'
    with bring_up(script, '--out', out) as process:
        process.communicate(timeout=60)
    assert len(record_lines(out)) == 2
    assert {path.name for path in tmp_path.iterdir()} == {'towers.txt', 'script.yaml', 'deep'}
    assert [path.name for path in (tmp_path / 'deep').iterdir()] == ['out']
    assert {path.name for path in out.iterdir()} <= {
        *('trials.jsonl', 'journal', 'log', 'pictures')
    }


def _complaints(source: Source) -> Iterator[str]:
    """What could run code that is only data."""
    for name, line in imports(source):
        if name.split('.')[0] in FORBIDDEN_MODULES:
            yield f'{source.module}, line {line}: imports {name}'
    for node in ast.walk(ast.parse(source.text)):
        if not isinstance(node, ast.Call):
            continue
        called = ast.unparse(node.func)
        last = called.rpartition('.')[2]
        is_yaml = called.startswith('yaml.') and last in UNSAFE_YAML
        is_plain = called in FORBIDDEN_CALLS or called in {'os.system', 'os.popen'}
        shell = any(keyword.arg == 'shell' for keyword in node.keywords)
        if is_yaml or is_plain or shell:
            yield f'{source.module}, line {node.lineno}: calls {called}'


@pytest.mark.parametrize('source', package_sources(), ids=lambda source: source.module)
def test_nothing_that_is_read_runs_code(source: Source) -> None:
    assert list(_complaints(source)) == []


@pytest.mark.parametrize(
    'text',
    [
        'import yaml\nyaml.load(text)',
        'yaml.unsafe_load(text)',
        'from pickle import loads',
        'eval(text)',
        'os.system(text)',
        'subprocess.run(text, shell=True)',
    ],
)
def test_what_runs_code_is_found(text: str) -> None:
    assert list(_complaints(Source('blocks_planning.x', text)))


def _clocks(source: Source) -> Iterator[str]:
    """Uses of a clock that somebody may set."""
    for node in ast.walk(ast.parse(source.text)):
        if not isinstance(node, ast.Call):
            continue
        called = ast.unparse(node.func)
        keywords = {keyword.arg for keyword in node.keywords}
        if called in {'time.time', 'datetime.now', 'datetime.datetime.now'}:
            yield f'line {node.lineno}: {called}'
        if called.endswith('.create_timer') and 'clock' not in keywords:
            yield f'line {node.lineno}: a timer of the clock of the system'
        if 'throttle_duration_sec' in keywords and 'throttle_time_source_type' not in keywords:
            yield f'line {node.lineno}: a limited rate by the clock of the system'


STAMPS = {'blocks_planning.study.session': ['time.time']}
"""Uses that only say when an event happened, by module."""


@pytest.mark.parametrize('source', package_sources(), ids=lambda source: source.module)
def test_no_jump_of_the_clock_matters(source: Source) -> None:
    """Only stamps are taken from it: of messages, of what a bag holds, of events of a study."""
    stamps = [use.partition(': ')[2] for use in _clocks(source)]
    assert stamps == STAMPS.get(source.module, [])


def test_clock_that_jumps_is_found() -> None:
    text = 'time.time()\nself.create_timer(1.0, f)\nlog(throttle_duration_sec=1.0)'
    assert len(list(_clocks(Source('x', text)))) == 3
