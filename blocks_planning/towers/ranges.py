"""Wanted values of a measure: a number or a range."""

from __future__ import annotations

import re
from math import inf
from typing import NamedTuple

from blocks_planning.errors import ConfigurationError, shown

_NUMBER = r'[0-9]{1,15}(?:\.[0-9]{1,15})?'
_RANGE = re.compile(rf'({_NUMBER})?(-)?({_NUMBER})?')


class Range(NamedTuple):
    """The numbers from ``least`` to ``most``, both included."""

    least: float = 0.0
    most: float = inf

    def __contains__(self, number: object) -> bool:
        return isinstance(number, (int, float)) and self.least <= number <= self.most

    def __str__(self) -> str:
        if self.least == self.most:
            return f'{self.least:g}'
        return f'{self.least:g}-' + ('' if self.most == inf else f'{self.most:g}')


def parse_range(text: str, origin: str) -> Range:
    """Read '3', '3-5', '3-' (at least) or '-5' (at most).

    Raises:
        ConfigurationError: with a message that begins with ``origin``, for other texts, or if the
            first end is larger.
    """
    match = _RANGE.fullmatch(text.strip())
    low, dash, high = match.groups() if match else (None, None, None)
    if (low is None and high is None) or (low and high and not dash):
        raise ConfigurationError(
            f'{origin}: expected a number or a range such as 3, 3-5, 3- or -5, got {shown(text)}'
        )
    if not dash:
        return Range(float(low or 0), float(low or 0))
    found = Range(float(low or 0), float(high) if high else inf)
    if found.least > found.most:
        raise ConfigurationError(
            f'{origin}: the first end must be the smaller one, got {shown(text)}'
        )
    return found
