"""Messages that arrive before their trial is announced."""

from __future__ import annotations

from collections import OrderedDict, deque
from typing import Any

MOST_TRIALS = 4
MOST_MESSAGES = 1000
MOST_BYTES = 32 << 20


class Inbox:
    """Messages of trials that have not been announced yet.

    Topics are not ordered among each other: the first state of a trial may come before the trial.
    Memory is bounded: the oldest messages are dropped.
    """

    def __init__(self) -> None:
        """An empty inbox."""
        self._held: OrderedDict[str, deque[tuple[int, Any]]] = OrderedDict()
        self._bytes = 0

    def hold(self, trial_id: str, message: Any, size: int = 0) -> None:
        """Keep a message of ``size`` bytes until its trial is announced."""
        held = self._held.setdefault(trial_id, deque())
        held.append((size, message))
        self._bytes += size
        self._held.move_to_end(trial_id)
        while len(held) > MOST_MESSAGES:
            self._bytes -= held.popleft()[0]
        while len(self._held) > MOST_TRIALS or (self._bytes > MOST_BYTES and len(self._held) > 1):
            self.take(next(iter(self._held)))
        while self._bytes > MOST_BYTES:
            self._bytes -= held.popleft()[0]

    def take(self, trial_id: str) -> list[Any]:
        """Remove and return the messages of a trial, in the order of arrival."""
        held = self._held.pop(trial_id, ())
        self._bytes -= sum(size for size, _ in held)
        return [message for _, message in held]
