"""Refusing what a message can't say."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TypeVar

from blocks_planning.errors import InvalidInput

T = TypeVar('T')
MAX_COST = 1 << 48
"""No search counts so many states in a week, and no sum over a trial outgrows 64 bits."""


class MessageError(InvalidInput):
    """A message that says what can't be."""


def refuse(field: str, value: object, expected: str) -> MessageError:
    """The error that a field is not as it must be."""
    text = repr(value)
    shown = text if len(text) <= 60 else f'{text[:57]}...'
    return MessageError(f'{field}: expected {expected}, got {shown}')


def word(kind: Callable[[str], T], value: str, field: str, words: Iterable[str]) -> T:
    """A value that must be one of some words, made into what it stands for."""
    words = list(words)
    if value not in words:
        raise refuse(field, value, f'one of {", ".join(words)}')
    return kind(value)


def cost(value: int, field: str) -> int:
    """A number of states that parts can add up."""
    if value > MAX_COST:
        raise refuse(field, value, f'up to {MAX_COST} states')
    return value
