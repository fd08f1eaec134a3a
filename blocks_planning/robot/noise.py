"""Random numbers of the robot: each follows from the seed and from what it is for."""

from __future__ import annotations

import numpy as np

_WORDS = {'grip': 1, 'perceive': 2}


def normal(seed: int, purpose: str, *counts: int, size: int = 1) -> list[float]:
    """Numbers of a standard normal distribution, the same whenever and wherever they are drawn.

    Args:
        seed: of the trial, 0 to 2**64 - 1.
        purpose: ``'grip'`` or ``'perceive'``.
        counts: which act or which perception.
        size: how many.
    """
    generator = np.random.Generator(np.random.PCG64([seed, _WORDS[purpose], *counts]))
    return [float(value) for value in generator.standard_normal(size)]
