"""What a stripe of Figure 3 shows."""

from __future__ import annotations

import pytest

from blocks_planning.analysis.stripes import subgoal_of_rows


@pytest.mark.parametrize(
    ('heights', 'numbers'),
    [
        ([4], [1, 1, 1, 1]),
        ([1, 3, 4], [1, 2, 2, 3]),
        ([2], [1, 1, 0, 0]),
        ([], [0, 0, 0, 0]),
        # One action at a time the same region is chosen again, or a lower one.
        ([2, 2, 1, 4], [1, 1, 2, 2]),
    ],
)
def test_row_belongs_to_the_first_subgoal_that_holds_it(
    heights: list[int], numbers: list[int]
) -> None:
    assert subgoal_of_rows(heights, 4) == numbers
