"""What the processes of a graph take, from ``/proc``."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

NODES = 'blocks_planning.ros.executables'


class Taken(NamedTuple):
    """What a process takes.

    Attributes:
        memory: resident [MB].
        threads: number of them.
        files: number of open file descriptors, sockets among them.
        shared: resident memory that it shares by a file in memory, ``RssShmem`` [MB].
    """

    memory: float
    threads: int
    files: int
    shared: float


def resources(bringup: int) -> dict[str, Taken]:
    """What a bring-up and all nodes that it started take, by name."""
    found = {}
    for folder in Path('/proc').iterdir():
        if folder.name.isdecimal():
            with suppress(OSError):  # it has just ended
                status = _status(folder)
                if bringup in (int(status['PPid']), int(folder.name)) and 'VmRSS' in status:
                    words = (folder / 'cmdline').read_text(encoding='utf-8').split('\0')
                    name = words[3] if NODES in words else 'bring-up'
                    found[name] = Taken(
                        _megabytes(status['VmRSS']),
                        int(status['Threads']),
                        len(os.listdir(folder / 'fd')),  # noqa: PTH208  quicker, and just counted
                        _megabytes(status['RssShmem']),
                    )
    return found


def _status(folder: Path) -> dict[str, str]:
    lines = (folder / 'status').read_text(encoding='utf-8').splitlines()
    pairs = (line.partition(':') for line in lines)
    return {key: value.strip() for key, _, value in pairs}


def _megabytes(text: str) -> float:
    return int(text.split(maxsplit=1)[0]) / 1024


@contextmanager
def process(command: list[str]) -> Iterator[subprocess.Popen[bytes]]:
    """A process that is ended in the end."""
    started = subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        cwd=Path(__file__).parents[1],
    )
    try:
        yield started
    finally:
        started.terminate()
        try:
            started.wait(10)
        except subprocess.TimeoutExpired:
            started.kill()
            started.wait()
