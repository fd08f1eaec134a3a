"""Writing to files that have to stay readable, whatever happens in the middle of it."""

from __future__ import annotations

import fcntl
import os
import time
from pathlib import Path

from blocks_planning.errors import RecordError

LOCK_WAIT_S = 5.0
"""For as long as a process may take to go that was told to."""
_LOOK_S = 0.02


def lock(descriptor: int, path: Path, wait_s: float = LOCK_WAIT_S) -> None:
    """Be the only one to write, until the descriptor is closed or the process ends, however.

    Raises:
        RecordError: if somebody else still writes after ``wait_s``.
    """
    deadline = time.monotonic() + wait_s
    while not _is_locked(descriptor):
        if time.monotonic() >= deadline:
            raise RecordError(
                f'{path}: is being written by another process; name another folder or end it'
            )
        time.sleep(_LOOK_S)


def _is_locked(descriptor: int) -> bool:
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def append(descriptor: int, data: bytes, sync: bool) -> None:
    """Add to the end of a file, all or nothing.

    Args:
        descriptor: of the file, open for reading and appending.
        data: to add.
        sync: whether to return only when it is on disk.

    Raises:
        OSError: if the disk does not take it; the file is as it was.
    """
    size = os.fstat(descriptor).st_size
    try:
        with memoryview(data) as rest:
            sent = 0
            while sent < len(rest):
                sent += os.write(descriptor, rest[sent:])
        if sync:
            os.fsync(descriptor)
    except OSError:
        os.ftruncate(descriptor, size)
        raise
