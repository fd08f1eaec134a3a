"""Random numbers of the robot: functions of the seed and the purpose."""

from __future__ import annotations

import numpy as np

_WORDS = {'grip': 1, 'perceive': 2}


def normal(seed: int, purpose: str, *counts: int, size: int = 1) -> list[float]:
    """Numbers of a standard normal distribution, independent of time and machine.

    Args:
        seed: of the trial, 0 to 2**64 - 1.
        purpose: ``'grip'`` or ``'perceive'``.
        counts: number of the act or perception.
        size: number of values.
    """
    generator = np.random.Generator(np.random.PCG64([seed, _WORDS[purpose], *counts]))
    return [float(value) for value in generator.standard_normal(size)]
