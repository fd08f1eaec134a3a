"""A JSON object that is read key by key, with an error for every invalid value."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, TypeVar

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import MAX_SIDE, Mask
from blocks_planning.errors import RecordError, shown
from blocks_planning.search.result import MAX_BUDGET

T = TypeVar('T')


class Fields:
    """A JSON object, and its place in the file for messages."""

    def __init__(self, data: object, place: str) -> None:
        if not isinstance(data, dict):
            raise RecordError(f'{place}: expected an object, got {short(data)}')
        self.data: dict[str, Any] = data
        self.place = place

    def get(self, key: str, kind: type | None = None) -> Any:
        """The value of a key, of a JSON type."""
        if key not in self.data:
            raise RecordError(f'{self.place}: missing key {key!r}')
        value = self.data[key]
        if kind is not None and type(value) is not kind:
            raise self.error(key, f'must be of type {kind.__name__}')
        return value

    def error(self, key: str, what: str) -> RecordError:
        """An error about the value of a key."""
        return RecordError(f'{self.place}: {key} {what}, got {short(self.data[key])}')

    def count(self, key: str) -> int:
        """A whole number of 0 or more."""
        value: int = self.get(key, int)
        if not 0 <= value <= MAX_BUDGET:
            raise self.error(key, f'must be from 0 to {MAX_BUDGET}')
        return value

    def number(self, key: str) -> float | None:
        """A number, or null."""
        return None if self.get(key) is None else float(self.get(key, float))

    def item(self, key: str, items: Sequence[T]) -> T:
        """The item of ``items`` whose index is the value of a key."""
        (item,) = self._named((self.get(key),), key, items)
        return item

    def items(self, key: str, items: Sequence[T]) -> tuple[T, ...]:
        """The items of ``items`` whose indices are the value of a key."""
        return self._named(self.get(key, list), key, items)

    def _named(self, numbers: Sequence[object], key: str, items: Sequence[T]) -> tuple[T, ...]:
        found = []
        for number in numbers:
            if type(number) is not int or not 0 <= number < len(items):
                raise self.error(key, f'must contain indices below {len(items)}')
            found.append(items[number])
        return tuple(found)

    def numbers(self, key: str, length: int | None = None) -> tuple[int, ...]:
        """A list of small whole numbers."""
        values = self.get(key, list)
        small = all(type(value) is int and 0 <= value <= MAX_SIDE for value in values)
        if not small or length not in (None, len(values)):
            many = '' if length is None else f'{length} '
            raise self.error(key, f'must be a list of {many}whole numbers from 0 to {MAX_SIDE}')
        return tuple(values)

    def mask(self, key: str) -> Mask:
        """A hexadecimal mask."""
        value = self.get(key, str)
        try:
            mask = int(value, 16)
        except ValueError:
            mask = -1
        if not 0 <= mask < 1 << MAX_SIDE * MAX_SIDE or hex(mask) != value:
            raise self.error(key, 'must be a hexadecimal mask such as 0x1f')
        return mask

    def word(self, key: str, words: Any) -> Any:
        """A member of an enumeration, by its value."""
        value = self.get(key, str)
        if value not in [word.value for word in words]:
            raise self.error(key, f'must be one of {", ".join(word.value for word in words)}')
        return words(value)

    def parts(self, key: str) -> list[Fields]:
        """A list of objects."""
        values = self.get(key, list)
        return [
            Fields(value, f'{self.place}, {key}[{index}]') for index, value in enumerate(values)
        ]

    def placements(self, key: str = 'placements') -> tuple[Placed, ...]:
        """The list of placed blocks, each [width, height, column, row]."""
        listed = dict(enumerate(self.get(key, list)))
        places = Fields({f'{key}[{index}]': item for index, item in listed.items()}, self.place)
        placements = [Placed(*places.numbers(place, 4)) for place in places.data]
        for place, placed in zip(places.data, placements, strict=True):
            if not (placed.width and placed.height):
                raise places.error(place, 'must be a block with width and height above 0')
        return tuple(placements)

    def compare(self, expected: dict[str, Any]) -> None:
        """Refuse unknown keys, and values that contradict the rest of the record."""
        for key in self.data:
            if key not in expected:
                raise RecordError(f'{self.place}: unknown key {shown(key)}')
        # The trial id depends on most other keys, so errors of the others are reported first.
        for key in sorted(self.data, key=lambda key: key == 'trial_id'):
            if not _same(self.data[key], expected[key]):
                what = f'contradicts the rest of the record, which gives {short(expected[key])}'
                raise self.error(key, what)
        for key in expected:
            self.get(key)


def _same(one: object, other: object) -> bool:
    """Whether two JSON values are equal and of equal types: 1, 1.0 and true are not."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return type(one) is type(other) and one == other


def short(value: object) -> str:
    """A JSON value as an error message shows it."""
    try:
        text = json.dumps(value)
    except RecursionError:
        text = 'a value that is nested too deeply'
    return text if len(text) <= 60 else f'{text[:57]}...'
