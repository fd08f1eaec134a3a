"""Exponentials that are the same on every machine; see :mod:`.logarithms` for why."""

from __future__ import annotations

import math

_LN_2 = 0.6931471805599453
_SMALLEST = -745.0
"""Below it the exponential is less than the smallest float64."""
_TERMS = 20


def exponential(x: float) -> float:
    """e to the power of x, for an x of 0 or less; relative error below 1e-13.

    With x = k ln 2 + y and abs(y) <= ln(2) / 2, it is 2**k (1 + y + y**2 / 2 + ...), the sum by
    Horner's rule.

    >>> exponential(0.0), exponential(-math.inf)
    (1.0, 0.0)
    >>> abs(exponential(-1.0) * math.e - 1) < 1e-13
    True
    """
    if x < _SMALLEST:
        return 0.0
    exponent = math.floor(x / _LN_2 + 0.5)
    rest = x - exponent * _LN_2
    total = 1.0
    for divisor in range(_TERMS, 0, -1):
        total = 1.0 + rest / divisor * total
    return math.ldexp(total, exponent)
