"""Work that Ctrl-C or a time limit ends at once, and cleanly."""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic
from typing import Generic, NamedTuple, TypeVar

from blocks_planning.search.result import CancelToken

T = TypeVar('T')
TICK_S = 0.1
"""Period at which the main thread checks the time limit and shows progress [s]."""


class Ended(NamedTuple, Generic[T]):
    """How a piece of work ended.

    Attributes:
        result: what the function returned.
        interrupted: whether Ctrl-C ended it.
        timed_out: whether the time limit ended it.
    """

    result: T
    interrupted: bool
    timed_out: bool


class _Work(threading.Thread, Generic[T]):
    """A thread that stores the result or the exception of a function.

    Python handles signals between bytecodes of the main thread, and a compiled search is one
    call; so the search runs here, and the main thread waits for it.
    """

    def __init__(self, function: Callable[[], T]) -> None:
        super().__init__(daemon=True)
        self._function = function
        self._error: BaseException | None = None
        self._ended = threading.Event()
        self._result: T

    def run(self) -> None:
        try:
            self._result = self._function()
        except BaseException as error:  # noqa: BLE001  raised again in wait()
            self._error = error
        self._ended.set()

    def ends_within(self, duration_s: float) -> bool:
        """Wait for at most a duration [s]; return whether the function has ended."""
        return self._ended.wait(duration_s)

    def wait(self) -> T:
        """Wait, and return the result of the function, or raise its exception."""
        self._ended.wait()  # a join() that was interrupted once would not wait again
        if self._error is not None:
            raise self._error
        return self._result


def supervised(
    function: Callable[[CancelToken], T],
    tick: Callable[[], None] = lambda: None,
    time_limit_s: float | None = None,
) -> Ended[T]:
    """Call a function; cancel its token on the first Ctrl-C, or when the time limit is reached.

    Args:
        function: called in its own thread; it must return soon after its token is cancelled.
        tick: called every ``TICK_S`` in this thread while the function runs.
        time_limit_s: time limit of the function [s]; None for no limit.
    """
    cancel = CancelToken()
    work = _Work(lambda: function(cancel))
    began = monotonic()
    work.start()
    try:
        while not work.ends_within(TICK_S):
            tick()
            if time_limit_s is not None and monotonic() - began >= time_limit_s:
                cancel.cancel()
                return Ended(work.wait(), False, True)
        return Ended(work.wait(), False, False)
    except KeyboardInterrupt:
        cancel.cancel()
        return Ended(work.wait(), True, False)


def interruptible(function: Callable[[CancelToken], T]) -> tuple[T, bool]:
    """Call a function; on the first Ctrl-C cancel its token, and wait for its result.

    Returns:
        (what the function returned, whether it was interrupted)
    """
    ended = supervised(function)
    return ended.result, ended.interrupted
