"""Logarithms that are made of exactly defined operations."""

from __future__ import annotations

import math

import numpy as np
from oracles.monte_carlo import natural_logarithm

from blocks_planning.search.logarithms import natural


def test_they_are_logarithms() -> None:
    found = natural(5000)
    assert found[0] == found[1] == 0
    expected = [math.log(number) for number in range(1, 5001)]
    np.testing.assert_allclose(found[1:], expected, rtol=4e-16, atol=0)


def test_every_bit_is_that_of_the_twin() -> None:
    assert natural(3000)[1:].tolist() == [natural_logarithm(number) for number in range(1, 3001)]
