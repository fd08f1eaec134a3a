"""What comes in before the trial it belongs to is known."""

from __future__ import annotations

from collections import OrderedDict, deque
from typing import Any

MOST_TRIALS = 4
MOST_MESSAGES = 1000


class Inbox:
    """Messages of trials that have not been announced here yet.

    Topics are not ordered among each other: the first state of a trial may come before the trial.
    Memory is bounded: the oldest go first.
    """

    def __init__(self) -> None:
        """An empty inbox."""
        self._held: OrderedDict[str, deque[Any]] = OrderedDict()

    def hold(self, trial_id: str, message: Any) -> None:
        """Keep a message until its trial is announced."""
        held = self._held.setdefault(trial_id, deque(maxlen=MOST_MESSAGES))
        held.append(message)
        self._held.move_to_end(trial_id)
        while len(self._held) > MOST_TRIALS:
            self._held.popitem(last=False)

    def take(self, trial_id: str) -> list[Any]:
        """The messages of a trial that is known now, in the order in which they came."""
        return list(self._held.pop(trial_id, ()))
