"""Work that Ctrl-C ends at once, and in good order."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Generic, TypeVar

from blocks_planning.search.result import CancelToken

T = TypeVar('T')
_LOOK_S = 0.5


class _Work(threading.Thread, Generic[T]):
    """A thread that keeps what a function returned or raised.

    Python looks at signals between the steps of the main thread, and a search is one step; so
    the search runs here, and the main thread waits for it.
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
        except BaseException as error:  # noqa: BLE001  raised again where it is waited for
            self._error = error
        self._ended.set()

    def wait(self) -> T:
        """What the function returned."""
        # A join() that was interrupted once would not wait again. Under Windows, Ctrl-C is seen
        # only between two calls.
        while not self._ended.wait(_LOOK_S):
            pass
        if self._error is not None:
            raise self._error
        return self._result


def interruptible(function: Callable[[CancelToken], T]) -> tuple[T, bool]:
    """Call a function; on the first Ctrl-C cancel its token, and wait for what it returns then.

    Returns:
        (what the function returned, whether it was interrupted)
    """
    cancel = CancelToken()
    work = _Work(lambda: function(cancel))
    work.start()
    try:
        return work.wait(), False
    except KeyboardInterrupt:
        cancel.cancel()
        return work.wait(), True
