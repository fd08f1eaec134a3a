from __future__ import annotations

from math import cos, pi, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from blocks_planning.robot.coverage import cover, rectangle

CELL = 0.04


def test_upright_block_covers_its_cells() -> None:
    found = cover(rectangle((2 * CELL, CELL / 2), (CELL, CELL / 2), 0.0), CELL)
    assert found == pytest.approx({(1, 0): 1.0, (2, 0): 1.0})


def test_block_between_cells_covers_parts_of_both() -> None:
    found = cover(rectangle((0.75 * CELL, 0.5 * CELL), (CELL / 2, CELL / 2), 0.0), CELL)
    assert found == pytest.approx({(0, 0): 0.75, (1, 0): 0.25})


def test_quarter_turn_swaps_the_sides() -> None:
    found = cover(rectangle((CELL / 2, CELL), (CELL, CELL / 2), pi / 2), CELL)
    assert found == pytest.approx({(0, 0): 1.0, (0, 1): 1.0})


@given(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.3, 2), st.floats(0.3, 2), st.floats(-4, 4))
def test_shares_agree_with_points_counted(
    x: float, z: float, a: float, b: float, angle: float
) -> None:
    """Count points of a fine grid that lie in the rectangle: slow, and no code in common."""
    found = cover(rectangle((x * CELL, z * CELL), (a * CELL, b * CELL), angle), CELL)
    assert sum(found.values()) == pytest.approx(4 * a * b)
    fine = 12
    for (column, row), share in found.items():
        inside = 0
        for i in range(fine):
            for j in range(fine):
                dx = column + (i + 0.5) / fine - x
                dz = row + (j + 0.5) / fine - z
                along = dx * cos(angle) + dz * sin(angle)
                across = dz * cos(angle) - dx * sin(angle)
                inside += abs(along) <= a and abs(across) <= b
        assert share == pytest.approx(inside / fine**2, abs=0.2)
