"""Validation of message fields, and bounds of their contents."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TypeVar

from blocks_planning.errors import InvalidInput

T = TypeVar('T')
MAX_COST = 1 << 48
"""Largest cost of one solve [states]: no search reaches it in a week, and its sums over a trial fit
into 64 bits."""
MOST_OBSERVATIONS = 4096
"""Of a trial. A tower takes 256 placements at most; the rest are orders that were lost."""
MOST_QUERIES = 1 << 14
"""In a request."""
MOST_REGIONS = 1 << 15
"""In a decision: a board of 16 x 16 cells has 18 496 rectangles."""
MOST_CANDIDATES = 100_000
"""In a decision: the most sequences that scoping weighs; ``full`` has 32 768 at most."""


class MessageError(InvalidInput):
    """A message whose content is impossible."""


def refuse(field: str, value: object, expected: str) -> MessageError:
    """The error for an invalid field."""
    text = repr(value)
    shown = text if len(text) <= 60 else f'{text[:57]}...'
    return MessageError(f'{field}: expected {expected}, got {shown}')


def word(kind: Callable[[str], T], value: str, field: str, words: Iterable[str]) -> T:
    """Convert a value that must be one of some words."""
    words = list(words)
    if value not in words:
        raise refuse(field, value, f'one of {", ".join(words)}')
    return kind(value)


def cost(value: int, field: str) -> int:
    """Check a number of states."""
    if value > MAX_COST:
        raise refuse(field, value, f'up to {MAX_COST} states')
    return value


def bounded(items: Sequence[T], field: str, least: int, most: int) -> Sequence[T]:
    """Check that a list of a message has ``least`` to ``most`` entries."""
    if not least <= len(items) <= most:
        raise refuse(field, f'{len(items)} entries', f'{least} to {most} entries')
    return items


def index(value: int, items: Sequence[T], field: str) -> T:
    """The entry of a list with the index in a message."""
    if not 0 <= value < len(items):
        raise refuse(field, value, f'an index below {len(items)}')
    return items[value]
