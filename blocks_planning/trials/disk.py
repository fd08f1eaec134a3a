"""Writing to files that must stay readable, even if writing is interrupted."""

from __future__ import annotations

import os
import time
from pathlib import Path

from blocks_planning.errors import RecordError

LOCK_WAIT_S = 5.0
"""Grace period after a stop request: time that a process may take to end [s]."""
_LOOK_S = 0.02


def lock(descriptor: int, path: Path, wait_s: float = LOCK_WAIT_S) -> None:
    """Lock a file for one writing process; or a folder, on systems that can open folders.

    The lock ends when the descriptor is closed or the process ends, for any reason. It excludes
    only processes that call this function; but under Windows no other process can read the first
    64 KiB of a locked file.

    Args:
        descriptor: of the file or folder, open.
        path: of it, for the message.
        wait_s: how long to wait for another holder of the lock [s].

    Raises:
        RecordError: if another process still holds the lock after ``wait_s``.
        OSError: if the file system has no locks.
    """
    deadline = time.monotonic() + wait_s
    while not _is_locked(descriptor):
        if time.monotonic() >= deadline:
            raise RecordError(
                f'{path}: another process is writing it; choose another folder or end that process'
            )
        time.sleep(_LOOK_S)


def _is_locked(descriptor: int) -> bool:
    # Imported here, because most commands import this module but need no lock.
    import portalocker

    try:
        portalocker.lock(
            descriptor, portalocker.LockFlags.EXCLUSIVE | portalocker.LockFlags.NON_BLOCKING
        )
    except portalocker.AlreadyLocked:
        return False
    except portalocker.LockException as error:
        if isinstance(error.__cause__, BlockingIOError):  # releases before 3 raise this instead
            return False
        raise error.__cause__ or error from None
    return True


def append(descriptor: int, data: bytes, sync: bool) -> None:
    """Add to the end of a file, all or nothing.

    Args:
        descriptor: of the file, open for reading and appending.
        data: to add.
        sync: whether to return only when it is on disk.

    Raises:
        OSError: if the data cannot be written; the file is then unchanged.
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
