"""Without ROS, and without what only POSIX systems have, all but the graph works."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest
from source_imports import PACKAGE, ROOT, Source, package_sources

POSIX_MODULES = (
    *('crypt', 'fcntl', 'grp', 'nis', 'ossaudiodev', 'posix', 'pty', 'pwd', 'resource'),
    *('spwd', 'syslog', 'termios', 'tty'),
)
POSIX_NAMES = {
    'os': (
        *('O_DIRECTORY', 'O_NONBLOCK', 'chown', 'fchmod', 'fork', 'geteuid', 'getgid', 'getpgid'),
        *('getsid', 'getuid', 'killpg', 'mkfifo', 'nice', 'sched_getaffinity', 'setpriority'),
        *('setsid', 'sync', 'uname', 'wait'),
    ),
    'signal': ('SIGALRM', 'SIGHUP', 'SIGKILL', 'SIGQUIT', 'SIGUSR1', 'SIGUSR2', 'pthread_kill'),
    'socket': ('AF_UNIX',),
    'time': ('pthread_getcpuclockid', 'tzset'),
}
"""What Windows has not, of modules that it has."""
ROS = r'rclpy.*|ament_.*|launch.*|rosidl_.*|rpyutils|.*_(msgs|srvs|interfaces)'
HIDE = f"""
import importlib.abc, re, sys
import numba, numpy, portalocker  # they look at the system themselves
posix_modules = {POSIX_MODULES!r}
class Hidden(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        top = name.partition('.')[0]
        if top in posix_modules and called_by_us() or re.fullmatch({ROS!r}, top):
            raise ModuleNotFoundError(f'No module named {{name!r}}', name=name)
def called_by_us():
    frame = sys._getframe(2)
    while 'importlib' in frame.f_code.co_filename:
        frame = frame.f_back
    return {PACKAGE!r} in frame.f_globals.get('__name__', '')
for name in posix_modules:
    sys.modules.pop(name, None)
sys.meta_path.insert(0, Hidden())
"""


def outside_of_ros() -> list[Source]:
    """The modules that must work on every system."""
    own = (source for source in package_sources() if not source.module.endswith('__main__'))
    return [source for source in own if source.module.split('.')[1:2] != ['ros']]


def posix_uses(source: Source) -> Iterator[str]:
    """What a source uses that only POSIX systems have; what it asks for first is left out."""
    tree = ast.parse(source.text)
    asked = {
        node.args[1].value
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and isinstance(node.func, ast.Name)
        and node.func.id == 'hasattr'
        and isinstance(node.args[1], ast.Constant)
    }
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(ast.Name(module), name) if name in POSIX_NAMES.get(module, ()):
                if name not in asked:
                    yield f'line {node.lineno}: {module}.{name}'
            case ast.Import(names):
                for alias in names:
                    if alias.name in POSIX_MODULES:
                        yield f'line {node.lineno}: {alias.name}'
            case ast.ImportFrom(str(module), names):
                if module in POSIX_MODULES:
                    yield f'line {node.lineno}: {module}'
                for alias in names:
                    if alias.name in POSIX_NAMES.get(module, ()):
                        yield f'line {node.lineno}: {module}.{alias.name}'
            case ast.Constant(str(text)) if re.match(r'/(tmp|dev|var|home)\b', text):
                yield f'line {node.lineno}: the path {text}'


def unsaid_encodings(source: Source) -> Iterator[str]:
    """Where a text file is opened in the encoding of the machine: Windows has its own."""
    for node in ast.walk(ast.parse(source.text)):
        if not isinstance(node, ast.Call):
            continue
        name = getattr(node.func, 'attr', getattr(node.func, 'id', ''))
        given = {keyword.arg for keyword in node.keywords}
        words = [arg.value for arg in node.args if isinstance(arg, ast.Constant)]
        binary = any(
            isinstance(word, str) and re.fullmatch(r'[rwxa]\+?b\+?', word) for word in words
        )
        is_text = name in {'read_text', 'write_text'} or (name == 'open' and not binary)
        of_a_file = name != 'open' or not ast.unparse(node.func).startswith(
            ('Image', 'webbrowser')
        )
        if is_text and of_a_file and 'encoding' not in given:
            yield f'line {node.lineno}: {ast.unparse(node.func)}'


@pytest.mark.parametrize('source', outside_of_ros(), ids=lambda source: source.module)
def test_nothing_of_posix_alone_is_used(source: Source) -> None:
    assert list(posix_uses(source)) == []


@pytest.mark.parametrize('source', outside_of_ros(), ids=lambda source: source.module)
def test_every_text_file_says_its_encoding(source: Source) -> None:
    if source.module != f'{PACKAGE}.located':  # its read_text reads a value
        assert [use for use in unsaid_encodings(source) if ': read_text' not in use] == []


@pytest.mark.parametrize(
    ('text', 'found'),
    [
        ('import fcntl', 'line 1: fcntl'),
        ('def f():\n    from pwd import getpwnam', 'line 2: pwd'),
        ('import os\nos.fork()', 'line 2: os.fork'),
        ('from signal import SIGKILL', 'line 1: signal.SIGKILL'),
        ("Path('/tmp/x')", 'line 1: the path /tmp/x'),
    ],
)
def test_use_is_seen(text: str, found: str) -> None:
    assert list(posix_uses(Source(f'{PACKAGE}.x', text))) == [found]


def test_what_is_asked_for_first_may_be_used() -> None:
    text = "import os\nif hasattr(os, 'fork'):\n    os.fork()"
    assert list(posix_uses(Source(f'{PACKAGE}.x', text))) == []


@pytest.mark.parametrize('call', ['path.read_text()', "open('x', 'w')", "path.open('a')"])
def test_unsaid_encoding_is_seen(call: str) -> None:
    assert list(unsaid_encodings(Source(f'{PACKAGE}.x', call))) != []


@pytest.mark.parametrize('call', ["path.open('rb')", "path.write_text(text, encoding='utf-8')"])
def test_said_encoding_is_not_complained_about(call: str) -> None:
    assert list(unsaid_encodings(Source(f'{PACKAGE}.x', call))) == []


def run_elsewhere(code: str, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run code in a Python without ROS and POSIX, outside of the checkout."""
    path = f'import sys; sys.path.insert(0, {str(ROOT)!r})'
    command = [sys.executable, '-c', f'{path}\n{HIDE}\n{code}']
    return subprocess.run(command, cwd=folder, capture_output=True, text=True)


def test_every_module_can_be_imported(tmp_path: Path) -> None:
    # The robot's simulation is an extra that the other commands do not need.
    needs_robot = f'{PACKAGE}.robot'
    names = [
        source.module
        for source in outside_of_ros()
        if find_spec('mujoco') is not None or not source.module.startswith(needs_robot)
    ]
    assert f'{PACKAGE}.trials.recordfile' in names
    code = f"""
from importlib import import_module
for name in {names!r}:
    import_module(name)
print('all')
"""
    done = run_elsewhere(code, tmp_path)
    assert done.stdout == 'all\n', done.stderr


@pytest.mark.parametrize('words', [['world'], ['std_msgs.msg'], ['fcntl']])
def test_what_is_hidden_cannot_be_imported(tmp_path: Path, words: list[str]) -> None:
    [name] = words
    module = f'{PACKAGE}.ros.nodes.world' if name == 'world' else name
    code = f"exec(compile('import {module}', 'x', 'exec'), {{'__name__': '{PACKAGE}.x'}})"
    done = run_elsewhere(code, tmp_path)
    assert 'ModuleNotFoundError' in done.stderr


@pytest.mark.long
def test_towers_are_solved_verified_and_drawn(tmp_path: Path) -> None:
    code = f"""
import contextlib
from {PACKAGE}.cli import main
def run(*words):
    sys.argv = ['blocks-planning', *words]
    try:
        main()
    except SystemExit as end:
        assert not end.code, (words, end.code)
with open('record.jsonl', 'w', encoding='utf-8') as file, contextlib.redirect_stdout(file):
    run('solve', 'cogsci2021/9', '--json')
run('verify', 'record.jsonl', '--rerun')
run('draw', 'record.jsonl', '--out', 'tower.png')
run('exact', 'cogsci2021/9')
run('stimuli')
from pathlib import Path
from {PACKAGE}.trials.reading import read_records
from {PACKAGE}.trials.recordfile import RecordFile
records = RecordFile(Path('more') / 'trials.jsonl')
records.append(read_records(Path('record.jsonl'))[0])
records.close()
run('verify', 'more/trials.jsonl')
"""
    done = run_elsewhere(code, tmp_path)
    assert done.stdout.count('all consistent') == 2, done.stderr
    assert (tmp_path / 'tower.png').read_bytes().startswith(b'\x89PNG')


def test_run_says_that_ros_is_missing(tmp_path: Path) -> None:
    script = ROOT / 'config' / 'trials' / 'demo.yaml'
    code = f"""
from {PACKAGE}.cli import main
sys.argv = ['blocks-planning', 'run', {str(script)!r}]
main()
"""
    done = run_elsewhere(code, tmp_path)
    assert done.returncode == 2
    assert done.stderr.startswith('Error: ROS 2 is not installed in this Python environment: ')
    assert done.stderr.count('\n') == 1
