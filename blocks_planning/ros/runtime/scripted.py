"""The order of the trials of a script, and its end."""

from __future__ import annotations

from collections.abc import Callable, Container
from pathlib import Path
from typing import Any

from blocks_planning.trials.script import read_session
from blocks_planning.trials.spec import TrialSpec


class ScriptRun:
    """Runs the trials of a script that have no record yet, one after the other.

    Attributes:
        has_begun: whether the first of them was started.
    """

    def __init__(
        self,
        path: Path,
        participant: str,
        finished: Container[str],
        make_timer: Callable[[float, Callable[[], None]], Any],
        start: Callable[[TrialSpec | None], None],
    ) -> None:
        """Read the script.

        Args:
            path: of the script.
            participant: code of the person who plans; '' for that of the script.
            finished: ids of the trials that have a record.
            make_timer: creates a timer from a period [s] and a callback.
            start: starts a trial; called with None after the last one.

        Raises:
            InvalidInput: if the script cannot be used.
        """
        script = read_session(path, participant)
        self._specs = (spec for spec in script.trials if spec.trial_id not in finished)
        self._start = start
        self.has_begun = False
        self._timer: Any = None
        if script.pause_s > 0:
            self._timer = make_timer(script.pause_s, self._after_pause)
            self._timer.cancel()

    def begin(self) -> None:
        """Start the first trial, at once."""
        self.has_begun = True
        self._start(next(self._specs, None))

    def go_on(self) -> None:
        """Start the next trial, after the pause of the script."""
        if self._timer is None:
            self._start(next(self._specs, None))
        else:
            self._timer.reset()

    def _after_pause(self) -> None:
        self._timer.cancel()
        self._start(next(self._specs, None))
