"""The graph that is tried: its processes, its files, and what it says."""

from __future__ import annotations

import os
import signal
import subprocess
import time
from collections import Counter
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import graphs
from peers import DOMAIN
from rclpy.node import Node

from blocks_planning.ros.wire.topics import ACTION, OUTCOME, SEARCH_REQUEST, STATE, TRIAL

HEARD = (TRIAL, STATE, SEARCH_REQUEST, ACTION, OUTCOME)


class Observer(Node):
    """Counts what is said, by topic; ``progress`` counts what brings a trial on."""

    def __init__(self, **options: Any) -> None:
        super().__init__('observer', **options)
        self.counts: Counter[str] = Counter()
        for topic in HEARD:
            self.create_subscription(
                topic.ros_type,
                topic.name,
                partial(self._count, topic.name),
                topic.subscription_qos,
                raw=True,
            )

    def _count(self, name: str, _: bytes) -> None:
        self.counts[name] += 1

    @property
    def progress(self) -> int:
        """How often a trial went on."""
        return self.counts['state'] + self.counts['outcome'] + self.counts['trial']


class Subject:
    """A bring-up of a script, started again when it was killed."""

    def __init__(self, script: Path, out: Path, namespace: str, pace_s: float) -> None:
        self.out = out
        self.bags: list[Path] = []
        self.records = out / 'trials.jsonl'
        self.console = out.with_suffix('.console')
        self._command = [
            *(*graphs.COMMAND, str(script), '--out', str(out)),
            *('--pace', str(pace_s), '--namespace', namespace, '--domain', str(DOMAIN.number)),
        ]
        self._process: subprocess.Popen[bytes] | None = None
        self._copies: list[subprocess.Popen[str]] = []

    def start(self) -> None:
        """Bring the graph up, with another bag each time: a finished one is not gone on with."""
        self.bags.append(self.out / f'bag{len(self.bags)}')
        with self.console.open('ab') as console:
            self._process = subprocess.Popen(
                [*self._command, '--bag', str(self.bags[-1])],
                stdout=console,
                stderr=console,
                start_new_session=True,
            )

    @property
    def pid(self) -> int:
        """Of the bring-up."""
        assert self._process is not None
        return self._process.pid

    def exit_code(self) -> int | None:
        """Of the bring-up; None while it runs."""
        assert self._process is not None
        return self._process.poll()

    def pids(self) -> dict[str, int]:
        """Of the nodes that live."""
        found = graphs.node_processes(self.pid)
        return {name: pid for name, pid in found.items() if graphs.is_alive(pid)}

    def stop(self) -> None:
        """End it, if it has not ended."""
        if self._process is not None and self._process.poll() is None:
            send(self.pid, signal.SIGCONT)
            self._process.terminate()
            try:
                self._process.wait(10)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    def copy(self, pid: int) -> subprocess.Popen[str] | None:
        """Start a second copy of a node: the same words, in the same environment.

        None if the node is gone.
        """
        try:
            words, variables = _words(pid, 'cmdline'), _words(pid, 'environ')
        except OSError:
            return None
        if not words[0]:  # it has ended, and nobody has taken note
            return None
        environment = {key: value for key, _, value in (word.partition('=') for word in variables)}
        environment['BLOCKS_PLANNING_PARENT'] = str(os.getpid())
        return subprocess.Popen(
            words, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )

    def journal_size(self) -> tuple[tuple[str, int], ...]:
        """What there is in the journal: something else after every write."""
        found = []
        with suppress(OSError):
            for entry in os.scandir(self.out / 'journal'):
                with suppress(OSError):
                    found.append((entry.name, entry.stat().st_size))
        return tuple(sorted(found))

    def records_size(self) -> int:
        """Of the records [bytes]."""
        try:
            return self.records.stat().st_size
        except OSError:
            return 0

    def bag_size(self) -> int:
        """Of all files of the last bag [bytes]."""
        return sum(path.stat().st_size for path in self.bags[-1].glob('*.mcap'))

    def left_over(self, within_s: float) -> list[str]:
        """The processes that were started by it and have not ended in some time."""
        deadline = time.monotonic() + within_s
        while True:
            left = [name for name in map(self._own, Path('/proc').iterdir()) if name]
            if not left or time.monotonic() > deadline:
                return left
            time.sleep(0.05)

    def _own(self, folder: Path) -> str:
        """What a process is called that writes its log here; '' for another."""
        if not folder.name.isdecimal() or not graphs.is_alive(int(folder.name)):
            return ''
        with suppress(OSError):
            if f'ROS_LOG_DIR={self.out / "log"}' in _words(int(folder.name), 'environ'):
                return ' '.join(_words(int(folder.name), 'cmdline')[:4])
        return ''


def send(pid: int, number: int) -> None:
    """Send a signal, if the process is there to take it."""
    with suppress(ProcessLookupError):
        os.kill(pid, number)


def _words(pid: int, kind: str) -> list[str]:
    text = Path(f'/proc/{pid}/{kind}').read_bytes().decode(errors='replace')
    return text.rstrip('\0').split('\0')
