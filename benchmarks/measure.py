"""Taking times."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import NamedTuple


class Figure(NamedTuple):
    """A number that was measured; ``target`` says what it should be, '' if nothing is asked."""

    name: str
    value: float
    unit: str
    target: str = ''

    def __str__(self) -> str:
        value = f'{self.value:,.3g}' if abs(self.value) < 1000 else f'{self.value:,.0f}'
        target = f'   ({self.target})' if self.target else ''
        return f'{self.name:<58} {value:>12} {self.unit}{target}'


def best_rate(work: Callable[[], int], rounds: int) -> float:
    """Units of work done per second in the best of some rounds, after one that is not counted."""
    work()
    best = 0.0
    for _ in range(rounds):
        start = time.perf_counter()
        done = work()
        best = max(best, done / (time.perf_counter() - start))
    return best


def seconds(work: Callable[[], object]) -> float:
    """How long some work takes, once."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start
