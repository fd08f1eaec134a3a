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
    if path.is_file() and path.name not in ('README.md', 'CHANGELOG.rst')
)
# Commands of a machine that would do.
GOOD = {
    'uname': 'if [ $1 = -m ]; then echo x86_64; else echo Linux; fi',
    'getconf': 'echo glibc 2.36',
    'cc': 'exit 0',
    'c++': 'exit 0',
}
# A Python whose virtual environments hold itself. Its pip writes down the last of its arguments:
# what it was to install. What it installs of the lock of uv is $FAKE_UV, if there is such a file.
FAKE_PYTHON = """\
for last do :; done
case "$1 $2 $3" in
    '-m venv '*) mkdir -p "$3/bin" && cp "$0" "$3/bin/python" ;;
    '-m pip config') echo "$PIP_SETTINGS" ;;
    '-m pip '*)
        echo "$last" >>installed
        [ "$last" != "$FAILING" ] || exit 1
        case $last in *lock-uv.txt) cp "$FAKE_UV" .venv/bin/uv ;; esac ;;
esac
"""
# A uv that writes down the same, and what of its settings it was given.
FAKE_UV = """\
#!/bin/sh
for last do :; done
echo "uv $last" >>installed
env | grep '^UV_\\|^SSL_CERT_FILE' | sort >settings
[ "$last" != "$FAILING_UV" ]
"""
UV = 'requirements/lock-uv.txt'
FIRST = '.cache/tmp/first.txt'
LOCK = 'requirements/lock.txt'
DEVELOPMENT = 'requirements/lock-development.txt'
BUILT = ['./msg_defs', '.']


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
    checkout: Path, commands: dict[str, str], settings: dict[str, str], *words: str
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
    command = ['sh', 'requirements/setup.sh', *words]
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


def installed(
    checkout: Path, *words: str, failing: str = '', has_uv: bool = True, **settings: str
) -> list[str]:
    """What a run of the set-up installs, in this order; `failing` can't be installed by pip."""
    (checkout / 'installed').unlink(missing_ok=True)
    fake_uv = checkout.parent / 'uv'
    fake_uv.write_text(FAKE_UV)
    fake_uv.chmod(0o755)
    settings |= {
        'PYTHON': str(checkout.parent / 'bin' / 'fake'),
        'FAILING': failing,
        'FAKE_UV': str(fake_uv) if has_uv else '/dev/null/none',
    }
    done = set_up(checkout, {'fake': FAKE_PYTHON}, settings, *words)
    assert done.returncode == (1 if failing else 0), done.stderr
    if failing:
        assert 'error: ' in done.stderr
    log = checkout / 'installed'
    return log.read_text().splitlines() if log.exists() else []


def test_a_second_call_installs_nothing(checkout: Path) -> None:
    with_uv = [f'uv {path}' for path in (FIRST, LOCK, DEVELOPMENT)]
    assert installed(checkout) == [UV, *with_uv, *BUILT]
    assert installed(checkout) == []


def test_pip_installs_the_same_where_uv_cannot_be_had(checkout: Path) -> None:
    wanted = [UV, FIRST, LOCK, DEVELOPMENT, *BUILT]
    assert installed(checkout, has_uv=False) == wanted
    assert installed(checkout, has_uv=False) == []


def test_pip_installs_what_uv_could_not(checkout: Path) -> None:
    done = installed(checkout, FAILING_UV=LOCK)
    assert done[done.index(f'uv {LOCK}') + 1] == LOCK
    assert done[-1] == '.'
    assert installed(checkout) == []


def test_what_builds_the_rest_comes_first(checkout: Path) -> None:
    installed(checkout)
    first = (checkout / FIRST).read_text()
    names = [line.partition('==')[0] for line in first.splitlines() if not line.startswith(' ')]
    assert names == ['setuptools', 'wheel']
    lock = (checkout / LOCK).read_text()
    assert all(line in lock for line in first.splitlines())
    assert first.count('--hash=') >= 2


def test_the_demo_needs_less_and_the_rest_is_added(checkout: Path) -> None:
    assert installed(checkout, 'demo') == [UV, f'uv {FIRST}', f'uv {LOCK}', *BUILT]
    assert installed(checkout, 'demo') == []
    assert installed(checkout) == [f'uv {DEVELOPMENT}']
    assert installed(checkout) == []
    assert installed(checkout, 'demo') == []


def test_uv_is_told_what_pip_was_told_and_nothing_else(
    checkout: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    place = 'https://packages.example/simple'
    said = f"global.index{'-'}url='{place}'\n:env:.cert='/etc/own.pem'"
    for name in ('SSL_CERT_FILE', 'UV_CACHE_DIR', 'UV_DEFAULT_INDEX'):
        monkeypatch.delenv(name, raising=False)
    installed(checkout, PIP_SETTINGS=said, UV_TARGET='elsewhere', UV_FIND_LINKS='elsewhere')
    assert (checkout / 'settings').read_text().splitlines() == [
        'SSL_CERT_FILE=/etc/own.pem',
        f'UV_CACHE_DIR={checkout}/.cache/uv',
        f'UV_DEFAULT_INDEX={place}',
    ]


def test_a_set_that_is_none_is_refused(checkout: Path) -> None:
    done = set_up(checkout, {}, {}, 'test')
    assert done.returncode == 1
    assert done.stderr == (
        'error: test is not a set of packages: name demo, robot, or all (the default)\n'
    )
    assert not (checkout / '.venv').exists()


@pytest.mark.parametrize(
    'path',
    [MESSAGES[0], *(pytest.param(path, marks=pytest.mark.long) for path in MESSAGES[1:])],
    ids=str,
)
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


@pytest.mark.parametrize('lock', [LOCK, DEVELOPMENT])
def test_a_new_lock_installs_everything(checkout: Path, lock: str) -> None:
    first = installed(checkout)
    with (checkout / lock).open('a') as file:
        file.write('# changed\n')
    assert installed(checkout) == first


def test_the_demo_does_not_care_for_the_lock_of_the_rest(checkout: Path) -> None:
    installed(checkout)
    with (checkout / DEVELOPMENT).open('a') as file:
        file.write('# changed\n')
    assert installed(checkout, 'demo') == []


@pytest.mark.parametrize('failing', [FIRST, LOCK, DEVELOPMENT, *BUILT])
def test_what_failed_is_made_again(checkout: Path, failing: str) -> None:
    attempts = [installed(checkout, failing=failing, has_uv=False)]
    attempts.append(installed(checkout, has_uv=False))
    everything = [name for attempt in attempts for name in attempt]
    assert everything.count(failing) == 2
    assert everything[-1] == '.'
    assert installed(checkout) == []
