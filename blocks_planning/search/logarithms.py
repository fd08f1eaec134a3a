"""Natural logarithms that are the same on every machine.

The last bit of a library's ``log`` differs between machines, and so would the results of a search
whose choices depend on it. These logarithms are computed from sums, products and quotients of
float64, which IEEE 754 defines to the last bit.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

_LN_2 = 0.6931471805599453
_LAST = 35


@lru_cache(maxsize=4)
def natural(most: int) -> np.ndarray:
    """The logarithms of 0 to ``most``, float64 (most + 1,), with 0 for that of 0.

    With n = m * 2**e and 1 <= m < 2, and s = (m - 1) / (m + 1), it is
    e ln 2 + 2 s (1 + s**2 / 3 + s**4 / 5 + ... + s**34 / 35), the sum by Horner's rule.
    """
    half, exponent = np.frexp(np.arange(1, most + 1, dtype=np.float64))
    mantissa = 2.0 * half
    ratio = (mantissa - 1.0) / (mantissa + 1.0)
    square = ratio * ratio
    total = np.full(most, 1.0 / _LAST)
    for divisor in range(_LAST - 2, 0, -2):
        total = total * square + 1.0 / divisor
    return np.concatenate([np.zeros(1), (exponent - 1) * _LN_2 + 2.0 * ratio * total])
