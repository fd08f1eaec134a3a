"""The progress of a computation."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Gauge:
    """The progress of a computation: written by its thread, read by any thread at any time.

    Attributes:
        done: number of finished steps.
        total: number of all steps; 0 while it is unknown.
        states: states stored or examined so far [states].
    """

    done: int = 0
    total: int = 0
    states: int = 0

    def __str__(self) -> str:
        share = f'{100 * self.done / self.total:.0f} %, ' if self.total else ''
        return f'{share}{self.states:,} states'
