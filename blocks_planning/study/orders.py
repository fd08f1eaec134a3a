"""In which order a participant gets things: a pure function of a row number and a seed."""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from types import MappingProxyType
from typing import TypeAlias, TypeVar

T = TypeVar('T')
Order: TypeAlias = Callable[[int, int, str], list[int]]
"""Gives indices in order, of a count of things, a row and a text that seeds its draws."""


def fixed(count: int, row: int, seed: str) -> list[int]:
    """As they are listed."""
    return list(range(count))


def shuffled(count: int, row: int, seed: str) -> list[int]:
    """In a random order, another one in each row.

    >>> shuffled(4, 0, 'a') == shuffled(4, 0, 'a')
    True
    """
    indices = list(range(count))
    random.Random(f'{seed}/{row}').shuffle(indices)
    return indices


def latin_square(count: int, row: int, seed: str) -> list[int]:
    """A row of a Latin square; after ``count`` rows each thing was once in each place.

    The square is Williams': for an even count, each thing follows each other one equally often.

    >>> [latin_square(4, row, '') for row in range(2)]
    [[0, 1, 3, 2], [1, 2, 0, 3]]
    """
    steps = [(place + 1) // 2 * (1 if place % 2 else -1) for place in range(count)]
    return [(step + row) % count for step in steps]


ORDERS: Mapping[str, Order] = MappingProxyType(
    {'fixed': fixed, 'shuffled': shuffled, 'latin square': latin_square}
)


def ordered(things: Sequence[T], order: Order, row: int, seed: str) -> list[T]:
    """Some things in the order of a row."""
    return [things[index] for index in order(len(things), row, seed)]
