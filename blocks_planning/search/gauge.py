"""How far a computation is."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass
class Gauge:
    """How far a computation is: written by its thread, read by any other at any time.

    Attributes:
        done: steps that are finished.
        total: steps in all; 0 as long as it is not known.
        states: states stored or looked at so far [states].
    """

    done: int = 0
    total: int = 0
    states: int = 0

    def __str__(self) -> str:
        share = f'{100 * self.done / self.total:.0f} %, ' if self.total else ''
        return f'{share}{self.states:,} states'
