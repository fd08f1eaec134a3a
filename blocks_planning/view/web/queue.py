"""The running trial of a script, and the next ones."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from blocks_planning.trials.spec import TrialSpec

MOST_COMING = 5


class Place(NamedTuple):
    """The position of a trial in the script.

    Attributes:
        number: of the trial, from 0; None if it is not in the script.
        total: trials of the script; 0 if there is no script.
        coming: the next trials.
    """

    number: int | None
    total: int
    coming: tuple[TrialSpec, ...]


class Queue:
    """The trials of a script. They run in order, so the search begins at the last one found."""

    def __init__(self, specs: Sequence[TrialSpec] = ()) -> None:
        """No trial has run yet."""
        self._specs = specs
        self._next = 0

    def place_of(self, trial_id: str | None) -> Place:
        """The position of a trial; None: before the first."""
        index = None if trial_id is None else self._find(trial_id)
        start = self._next if index is None else index + 1
        if index is not None:
            self._next = index
        coming = tuple(self._specs[start : start + MOST_COMING])
        return Place(index, len(self._specs), coming)

    def _find(self, trial_id: str) -> int | None:
        total = len(self._specs)
        for offset in range(total):
            index = (self._next + offset) % total
            if self._specs[index].trial_id == trial_id:
                return index
        return None
