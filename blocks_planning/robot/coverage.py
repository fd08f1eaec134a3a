"""The share of each cell that a block covers, from its pose or from pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, sin
from typing import TypeAlias

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Cell

Point: TypeAlias = tuple[float, float]
Coverage: TypeAlias = dict[Cell, float]
"""Share of a cell that is covered, 0 to 1; cells without a share are missing, cells outside
the board can occur."""


@dataclass(frozen=True)
class Sighting:
    """A perceived block.

    Attributes:
        number: of the block.
        block: its size when it stands upright [cells].
        coverage: of cells on and around the board.
        tilt: deviation of its sides from vertical or horizontal [degrees]; None: unknown.
        is_off_plane: whether it is outside the plane of the board, or lies on its face.
    """

    number: int
    block: Block
    coverage: Coverage
    tilt: float | None = None
    is_off_plane: bool = False


def rectangle(centre: Point, half: Point, angle: float) -> list[Point]:
    """The corners of a rectangle turned by an angle [rad], counterclockwise."""
    (x, z), (a, b) = centre, half
    along, up = cos(angle), sin(angle)
    corners = [(-a, -b), (a, -b), (a, b), (-a, b)]
    return [(x + u * along - v * up, z + u * up + v * along) for u, v in corners]


def cover(corners: Sequence[Point], cell: float) -> Coverage:
    """The cells that a convex polygon covers.

    Args:
        corners: of the polygon, counterclockwise [m].
        cell: side of a cell [m].
    """
    scaled = [(x / cell, z / cell) for x, z in corners]
    columns = _span([x for x, _ in scaled])
    rows = _span([z for _, z in scaled])
    found = {}
    for column in columns:
        strip = _cut(_cut(scaled, 0, column, 1), 0, column + 1, -1)
        for row in rows:
            share = _area(_cut(_cut(strip, 1, row, 1), 1, row + 1, -1))
            if share > 1e-9:
                found[column, row] = share
    return found


def _span(values: Sequence[float]) -> range:
    return range(int(min(values) // 1), int(max(values) // 1) + 1)


def _cut(polygon: Sequence[Point], axis: int, bound: float, sign: int) -> list[Point]:
    """The part of a polygon where ``sign * (coordinate - bound)`` is not negative."""
    kept: list[Point] = []
    for index, end in enumerate(polygon):
        start = polygon[index - 1]
        before, after = sign * (start[axis] - bound), sign * (end[axis] - bound)
        if (before < 0) != (after < 0):
            share = before / (before - after)
            kept.append(
                (
                    start[0] + share * (end[0] - start[0]),
                    start[1] + share * (end[1] - start[1]),
                )
            )
        if after >= 0:
            kept.append(end)
    return kept


def _area(polygon: Sequence[Point]) -> float:
    total = 0.0
    for index, (x, z) in enumerate(polygon):
        before_x, before_z = polygon[index - 1]
        total += before_x * z - x * before_z
    return total / 2
