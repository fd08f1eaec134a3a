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
"""Number of crashes in a row after which a node is not restarted."""
MOST_KILLS = 64
"""Number of kills in a row, each before the node was ready, after which it is not restarted."""
STABLE_S = 5.0
"""After being ready for this time [s], the earlier deaths of a node no longer count."""
FROM_OUTSIDE = (0, *(-number for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT)))
"""Exit codes of a process that another process ended."""
_FIRST_PAUSE_S = 0.1
_LONGEST_PAUSE_S = 3.2
STOP_BOUND_S = 2.0
PARENT_VARIABLE = 'BLOCKS_PLANNING_PARENT'
READY_VARIABLE = 'BLOCKS_PLANNING_READY'
"""The file descriptor on which a node reports to its bring-up that it is ready."""


def tell_ready() -> None:
    """Tell the bring-up that started this process, if one did, that the node is ready."""
    number = os.environ.pop(READY_VARIABLE, '')
    if number:
        with suppress(OSError):  # the bring-up is gone, or this process has re-executed itself
            os.write(int(number), b'ready')
            os.close(int(number))


@dataclass
class NodeProcess:
    """A node in a process of its own.

    Attributes:
        name: of the executable.
        arguments: those after ``--ros-args``.
        restarts: number of restarts.
        deaths: number of crashes in a row, before or soon after it was ready.
        kills: number of times in a row that another process ended it before it was ready.
        is_given_up: whether it will not be restarted.
    """

    name: str
    arguments: Sequence[str]
    environment: Mapping[str, str]
    restarts: int = 0
    deaths: int = 0
    kills: int = 0
    is_given_up: bool = False
    _process: subprocess.Popen[bytes] | None = field(default=None, repr=False)
    _ready: int | None = field(default=None, repr=False)
    _ready_at: float | None = None
    _again_at: float | None = None

    def start(self) -> None:
        """Start the process in its own session, so that only the bring-up receives Ctrl-C."""
        command = [
            sys.executable,
            '-m',
            'blocks_planning.ros.executables',
            self.name,
            '--ros-args',
        ]
        command += ['--disable-external-lib-logs', '--log-level', 'warn', *self.arguments]
        self._close_ready()
        self._ready, told = os.pipe()
        os.set_blocking(self._ready, False)
        environment = {
            **self.environment,
            PARENT_VARIABLE: str(os.getpid()),
            READY_VARIABLE: str(told),
        }
        try:
            self._process = subprocess.Popen(
                command, env=environment, start_new_session=True, pass_fds=(told,)
            )
        finally:
            os.close(told)
        self._ready_at = None

    @property
    def pid(self) -> int:
        """Process id."""
        assert self._process is not None
        return self._process.pid

    def exit_code(self) -> int | None:
        """The exit code of the process; None while it runs."""
        return None if self._process is None else self._process.poll()

    def keep_alive(self) -> bool:
        """Restart the process some time after it ended; return False if it ended too often.

        A crash counts unless the node had been ready for a while. A kill from outside counts only
        if the node had not been ready. To be called several times a second.
        """
        if self._process is None or self.is_given_up:
            return True
        now = time.monotonic()
        self._look_whether_ready(now)
        if self._process.poll() is None:
            return True
        if self._again_at is None:
            self._count_death(self._process.returncode)
            in_a_row = max(1, self.deaths + self.kills)
            pause_s = min(_FIRST_PAUSE_S * 2 ** (in_a_row - 1), _LONGEST_PAUSE_S)
            self._again_at = now + pause_s
        if self.deaths > MOST_DEATHS or self.kills > MOST_KILLS:
            return False
        if now >= self._again_at:
            self.restarts += 1
            self._again_at = None
            self.start()
        return True

    def _look_whether_ready(self, now: float) -> None:
        if self._ready_at is None and self._ready is not None:
            with suppress(BlockingIOError):
                if os.read(self._ready, 16):
                    self._ready_at = now
                self._close_ready()  # also if the process ended before it was ready
        lives = self._ready_at is not None and self._again_at is None
        if lives and now - (self._ready_at or now) >= STABLE_S:
            self.deaths = self.kills = 0

    def _count_death(self, code: int) -> None:
        if code not in FROM_OUTSIDE:
            self.deaths += 1
        elif self._ready_at is None:
            self.kills += 1
        else:
            self.kills = 0

    def _close_ready(self) -> None:
        if self._ready is not None:
            os.close(self._ready)
            self._ready = None

    def signal(self, number: int) -> None:
        """Send a signal, if the process is running."""
        if self._process is not None and self._process.poll() is None:
            with suppress(ProcessLookupError):
                self._process.send_signal(number)

    def wait(self, deadline: float) -> None:
        """Wait for the process to end; kill it at the deadline (monotonic clock) [s]."""
        self._close_ready()
        if self._process is None:
            return
        try:
            self._process.wait(max(0.0, deadline - time.monotonic()))
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()


def stop_all(processes: Sequence[NodeProcess]) -> None:
    """Stop processes cleanly, within ``STOP_BOUND_S``."""
    for process in processes:
        process.signal(signal.SIGTERM)
    deadline = time.monotonic() + STOP_BOUND_S
    for process in processes:
        process.wait(deadline)
