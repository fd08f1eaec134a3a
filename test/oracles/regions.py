"""Regions of space, straight from their definitions, on frozensets of cells."""

from __future__ import annotations

from itertools import combinations_with_replacement
from math import floor

from oracles.board import Cells

Sides = tuple[int, int, int, int]


def rectangles(
    width: int,
    height: int,
    silhouette: Cells,
    built: Cells,
    min_cells: int = 2,
    max_cells: int = 0,
) -> list[tuple[Sides, Cells]]:
    """Corners of every rectangle that is a region, as (column, row, width, height), and cells.

    Every rectangle is looked at, in the order of row, column, height and width; of those with the
    same target cells the smallest stands for all.
    """
    if max_cells == 0:
        max_cells = floor(0.75 * len(silhouette))
    smallest: dict[Cells, Sides] = {}
    for left, right in combinations_with_replacement(range(width), 2):
        for low, high in combinations_with_replacement(range(height), 2):
            inside = {(c, r) for c in range(left, right + 1) for r in range(low, high + 1)}
            cells = frozenset(inside & silhouette)
            sides = (left, low, right - left + 1, high - low + 1)
            if inside & built or not min_cells <= len(cells) <= max_cells:
                continue
            if any(r == 0 or (c, r - 1) in built for c, r in cells):
                before = smallest.get(cells, sides)
                smallest[cells] = min(before, sides, key=lambda one: one[2] * one[3])
    regions = [(sides, cells) for cells, sides in smallest.items()]
    return sorted(regions, key=lambda one: (one[0][1], one[0][0], one[0][3], one[0][2]))
