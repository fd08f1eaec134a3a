"""The set-up says in one sentence what a machine lacks, and makes again only what has changed."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from source_imports import ROOT

NEEDED = ['setup.py', 'setup.cfg', 'pyproject.toml', 'package.xml', 'requirements', 'msg_defs']
MESSAGES = sorted(
    path.relative_to(ROOT)
    for path in (ROOT / 'msg_defs').rglob('*')
    if path.is_file() and path.name != 'README.md'
)
# Commands of a machine that would do.
GOOD = {
    'uname': 'if [ $1 = -m ]; then echo x86_64; else echo Linux; fi',
    'getconf': 'echo glibc 2.36',
    'cc': 'exit 0',
    'c++': 'exit 0',
}
# A Python whose virtual environments hold itself. Its pip writes down the last of its arguments:
# what it was to install.
FAKE_PYTHON = """\
for last do :; done
case "$1 $2" in
    '-m venv') mkdir -p "$3/bin" && cp "$0" "$3/bin/python" ;;
    '-m pip') echo "$last" >>installed; [ "$last" != "$FAILING" ] ;;
esac
"""


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """The files that the set-up looks at, in a folder with a space in its name."""
    copy = tmp_path / 'check out'
    (copy / 'blocks_planning').mkdir(parents=True)
    shutil.copy(ROOT / 'blocks_planning' / '__init__.py', copy / 'blocks_planning')
    for name in NEEDED:
        copier = shutil.copytree if (ROOT / name).is_dir() else shutil.copy
        copier(ROOT / name, copy / name)
    return copy


def set_up(
    checkout: Path, commands: dict[str, str], settings: dict[str, str]
) -> subprocess.CompletedProcess[str]:
    """Run the set-up where `commands` are as given, and otherwise those of a good machine."""
    folder = checkout.parent / 'bin'
    folder.mkdir(exist_ok=True)
    for name, body in {**GOOD, **commands}.items():
        (folder / name).write_text(f'#!/bin/sh\n{body}\n')
        (folder / name).chmod(0o755)
    environment = {
        name: value for name, value in os.environ.items() if name not in {'CC', 'CXX', 'PYTHON'}
    }
    environment |= {'PATH': f'{folder}:{os.environ["PATH"]}', **settings}
    command = ['sh', 'requirements/setup.sh']
    return subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)


@pytest.mark.parametrize(
    ('commands', 'settings', 'sentence'),
    [
        pytest.param(
            {'uname': 'if [ $1 = -m ]; then echo aarch64; else echo Linux; fi'},
            {},
            'only for x86_64 Linux with glibc 2.28 or newer but this is Linux/aarch64',
            id='other processor',
        ),
        pytest.param(
            {'getconf': 'echo glibc 2.27'},
            {},
            'but this machine has glibc 2.27',
            id='old C library',
        ),
        pytest.param(
            {'getconf': 'exit 1'},
            {},
            'but this machine has another C library',
            id='other C library',
        ),
        pytest.param(
            {'cc': 'exit 1', 'gcc': 'exit 127', 'clang': 'exit 127'},
            {},
            'no C compiler works here',
            id='no compiler',
        ),
        pytest.param(
            {'c++': 'exit 1', 'g++': 'exit 127', 'clang++': 'exit 127'},
            {},
            'no C++ compiler works here',
            id='no C++ compiler',
        ),
        pytest.param(
            {f'python3{minor}': 'exit 127' for minor in ('', '.10', '.11', '.12', '.13')},
            {},
            'no CPython 3.10 to 3.13 (64 bit) found',
            id='shims without a Python behind them',
        ),
        pytest.param(
            {'old': 'exit 3'},
            {'PYTHON': 'old'},
            'old is not a CPython 3.10 to 3.13',
            id='wrong PYTHON',
        ),
        pytest.param(
            {'bare': 'exit 4'},
            {'PYTHON': 'bare'},
            "bare can't make virtual environments",
            id='no ensurepip',
        ),
        pytest.param(
            {'bare': 'exit 5'},
            {'PYTHON': 'bare'},
            'bare has no Python.h to compile against: install its headers (Debian, Ubuntu: apt'
            ' install bare-dev)',
            id='no headers',
        ),
    ],
)
def test_missing_is_named_and_nothing_is_made(
    checkout: Path, commands: dict[str, str], settings: dict[str, str], sentence: str
) -> None:
    before = sorted(checkout.rglob('*'))
    done = set_up(checkout, commands, settings)
    assert done.returncode == 1
    assert done.stdout == ''
    assert done.stderr.startswith('error: ')
    assert done.stderr.count('\n') == 1
    assert sentence in done.stderr
    assert sorted(checkout.rglob('*')) == before


def installed(checkout: Path, failing: str = '') -> list[str]:
    """What a run of the set-up installs with pip, in this order; `failing` can't be installed."""
    (checkout / 'installed').unlink(missing_ok=True)
    settings = {'PYTHON': str(checkout.parent / 'bin' / 'fake'), 'FAILING': failing}
    done = set_up(checkout, {'fake': FAKE_PYTHON}, settings)
    assert done.returncode == (1 if failing else 0), done.stderr
    assert done.stderr.startswith('error: ') or not failing
    log = checkout / 'installed'
    return log.read_text().splitlines() if log.exists() else []


def test_a_second_call_installs_nothing(checkout: Path) -> None:
    assert installed(checkout) == ['wheel', 'requirements/lock.txt', './msg_defs', '.']
    assert installed(checkout) == []


@pytest.mark.parametrize('path', MESSAGES, ids=str)
def test_messages_are_built_when_a_file_of_them_has_changed(checkout: Path, path: Path) -> None:
    installed(checkout)
    with (checkout / path).open('a') as file:
        file.write('\n')
    assert installed(checkout) == ['./msg_defs']
    assert installed(checkout) == []


def test_messages_are_built_when_one_is_new_or_gone(checkout: Path) -> None:
    installed(checkout)
    message = checkout / 'msg_defs' / 'msg' / 'New.msg'
    message.touch()
    assert installed(checkout) == ['./msg_defs']
    message.unlink()
    assert installed(checkout) == ['./msg_defs']


def test_a_new_lock_installs_everything(checkout: Path) -> None:
    first = installed(checkout)
    with (checkout / 'requirements' / 'lock.txt').open('a') as file:
        file.write('# changed\n')
    assert installed(checkout) == first


@pytest.mark.parametrize('failing', ['requirements/lock.txt', './msg_defs', '.'])
def test_what_failed_is_made_again(checkout: Path, failing: str) -> None:
    everything = installed(checkout, failing) + installed(checkout)
    assert everything.count(failing) == 2
    assert everything[-1] == '.'
    assert installed(checkout) == []
