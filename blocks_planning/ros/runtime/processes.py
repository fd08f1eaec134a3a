"""The processes of a graph: started, watched, restarted, stopped."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field

MOST_DEATHS = 8
STABLE_S = 5.0
"""Who has run for so long is forgiven all its deaths."""
_FIRST_PAUSE_S = 0.1
_LONGEST_PAUSE_S = 3.2
STOP_BOUND_S = 2.0
PARENT_VARIABLE = 'BLOCKS_PLANNING_PARENT'


@dataclass
class NodeProcess:
    """A node in a process of its own.

    Attributes:
        name: of the executable.
        arguments: behind ``--ros-args``.
        restarts: how often it was started again.
        deaths: how often in a row it died soon after its start.
    """

    name: str
    arguments: Sequence[str]
    environment: Mapping[str, str]
    restarts: int = 0
    deaths: int = 0
    _process: subprocess.Popen[bytes] | None = field(default=None, repr=False)
    _started: float = 0.0
    _again_at: float | None = None

    def start(self) -> None:
        """Start the process, in a session of its own: Ctrl-C is for the bring-up to pass on."""
        command = [
            sys.executable,
            '-m',
            'blocks_planning.ros.executables',
            self.name,
            '--ros-args',
        ]
        command += ['--disable-external-lib-logs', '--log-level', 'warn', *self.arguments]
        environment = {**self.environment, PARENT_VARIABLE: str(os.getpid())}
        self._started = time.monotonic()
        self._process = subprocess.Popen(command, env=environment, start_new_session=True)

    @property
    def pid(self) -> int:
        """Process id."""
        assert self._process is not None
        return self._process.pid

    def exit_code(self) -> int | None:
        """How the process ended; None while it runs."""
        return None if self._process is None else self._process.poll()

    def keep_alive(self) -> bool:
        """Start the process again some time after it died; return False if it does so too often.

        To be called some times a second.
        """
        if self._process is None:
            return True
        now = time.monotonic()
        if self._again_at is None and now - self._started >= STABLE_S:
            self.deaths = 0
        if self._process.poll() is None:
            return True
        if self._again_at is None:
            self.deaths += 1
            pause_s = min(_FIRST_PAUSE_S * 2 ** (self.deaths - 1), _LONGEST_PAUSE_S)
            self._again_at = now + pause_s
        if self.deaths > MOST_DEATHS:
            return False
        if now >= self._again_at:
            self.restarts += 1
            self._again_at = None
            self.start()
        return True

    def signal(self, number: int) -> None:
        """Send a signal, if the process is there to take it."""
        if self._process is not None and self._process.poll() is None:
            with suppress(ProcessLookupError):
                self._process.send_signal(number)

    def wait(self, deadline: float) -> None:
        """Wait for the process to end, and end it at the deadline (of the monotonic clock)."""
        if self._process is None:
            return
        try:
            self._process.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def stop_all(processes: Sequence[NodeProcess]) -> None:
    """End processes in good order, within ``STOP_BOUND_S``."""
    for process in processes:
        process.signal(signal.SIGTERM)
    deadline = time.monotonic() + STOP_BOUND_S
    for process in processes:
        process.wait(deadline)
