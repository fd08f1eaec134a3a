"""Whole graphs as processes: scripts to run, and ``blocks-planning run`` to run them."""

from __future__ import annotations

import os
import pty
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import yaml

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.script import read_script

COMMAND = [sys.executable, '-m', 'blocks_planning.cli', 'run']
NODES = 'blocks_planning.ros.executables'
DEADLINE_S = 100.0


def write_script(folder: Path, **keys: Any) -> Path:
    """A script of trials; what is not given is small."""
    keys = {
        'stimuli': ['cogsci2021/5'],
        'seeds': 1,
        'searches': [{'name': 'bfs', 'depth': 2}],
        'strategies': [{'name': 'scoping'}],
        **keys,
    }
    path = folder / 'script.yaml'
    path.write_text(yaml.safe_dump(keys), encoding='utf-8')
    return path


def local_lines(script: Path) -> list[str]:
    """The records of a script's trials, run in this process."""
    return [run_trial(spec).to_line() for spec in read_script(script)]


def record_lines(out: Path) -> list[str]:
    """The records that a graph has written so far."""
    path = out / 'trials.jsonl'
    return path.read_text(encoding='utf-8').splitlines() if path.exists() else []


def run_graph(
    *arguments: object, environment: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """Bring a graph up, and wait until it is done."""
    with bring_up(*arguments, environment=environment) as process:
        out, err = process.communicate(timeout=DEADLINE_S)
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def run_in_terminal(*arguments: object) -> tuple[int, str]:
    """Bring a graph up in a terminal of 80 x 24; return its exit code, and all that it showed."""
    ours, its = pty.openpty()
    environment = {**os.environ, 'TERM': 'xterm-256color', 'COLUMNS': '80', 'LINES': '24'}
    command = [*COMMAND, *map(str, arguments)]
    shown = b''
    with subprocess.Popen(
        command, env=environment, stdout=subprocess.DEVNULL, stderr=its
    ) as running:
        os.close(its)
        with suppress(OSError):  # the other end is closed
            while part := os.read(ours, 1 << 16):
                shown += part
    os.close(ours)
    return running.returncode, shown.decode(errors='replace')


@contextmanager
def bring_up(
    *arguments: object, environment: Mapping[str, str] | None = None
) -> Iterator[subprocess.Popen[str]]:
    """A graph that runs; it is taken down in the end."""
    process = subprocess.Popen(
        [*COMMAND, *map(str, arguments)],
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        yield process
    finally:
        if process.poll() is None:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()
        process.wait()
        for pipe in (process.stdout, process.stderr):
            if pipe is not None:
                pipe.close()


def node_processes(bringup: int) -> dict[str, int]:
    """The process id of every node that a bring-up started, by the node's name."""
    found = {}
    for folder in Path('/proc').iterdir():
        if folder.name.isdecimal() and _parent(folder) == bringup:
            name = _node_name(folder)
            if name:
                found[name] = int(folder.name)
    return found


def is_alive(pid: int) -> bool:
    """Whether a process is there, and no zombie."""
    try:
        stat = Path(f'/proc/{pid}/stat').read_text(encoding='utf-8')
    except OSError:
        return False
    return stat.rpartition(')')[2].split()[0] != 'Z'


def wait_until(process: subprocess.Popen[str], condition: Callable[[], object]) -> None:
    """Wait until a condition holds while a process runs.

    Raises:
        AssertionError: if the process ends, or it takes too long.
    """
    deadline = os.times().elapsed + DEADLINE_S
    while not condition():
        assert os.times().elapsed < deadline, 'not in time'
        try:
            process.wait(0.01)
        except subprocess.TimeoutExpired:
            continue
        err = process.stderr.read() if process.stderr else ''
        raise AssertionError(f'ended with {process.returncode}: {err}')


def _parent(folder: Path) -> int:
    try:
        stat = (folder / 'stat').read_text(encoding='utf-8')
    except OSError:
        return 0
    return int(stat.rpartition(')')[2].split()[1])


def _node_name(folder: Path) -> str:
    try:
        words = (folder / 'cmdline').read_text(encoding='utf-8').split('\0')
    except OSError:
        return ''
    return words[3] if words[1:3] == ['-m', NODES] else ''
