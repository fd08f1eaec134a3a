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

MOST_RESTARTS = 5
_FIRST_PAUSE_S = 0.1
STOP_BOUND_S = 2.0
PARENT_VARIABLE = 'BLOCKS_PLANNING_PARENT'


@dataclass
class NodeProcess:
    """A node in a process of its own.

    Attributes:
        name: of the executable.
        arguments: behind ``--ros-args``.
        restarts: how often it was started again.
    """

    name: str
    arguments: Sequence[str]
    environment: Mapping[str, str]
    restarts: int = 0
    _process: subprocess.Popen[bytes] | None = field(default=None, repr=False)
    _not_before: float = 0.0

    def start(self) -> None:
        """Start the process, in a session of its own: Ctrl-C is for the bring-up to pass on."""
        command = [
            sys.executable,
            '-m',
            'blocks_planning.ros.executables',
            self.name,
            '--ros-args',
        ]
        command += ['--disable-external-lib-logs', *self.arguments]
        environment = {**self.environment, PARENT_VARIABLE: str(os.getpid())}
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
        """Start the process again if it has died; return False if it died too often."""
        if self._process is None or self._process.poll() is None:
            return True
        if self.restarts >= MOST_RESTARTS:
            return False
        now = time.monotonic()
        if self._not_before == 0.0:
            self._not_before = now + _FIRST_PAUSE_S * 2**self.restarts
        if now >= self._not_before:
            self.restarts += 1
            self._not_before = 0.0
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
