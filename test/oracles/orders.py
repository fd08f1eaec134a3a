"""How far regions describe an order of building: every way to cut it into runs is tried."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

from oracles.board import EMPTY, Cells, Placement, cells_of, rows
from oracles.regions import rectangles


def regions(family: str, width: int, height: int, silhouette: Cells, built: Cells) -> list[Cells]:
    """The cells that each candidate of a family would add to a state."""
    if family == 'rectangles':
        return [cells for _, cells in rectangles(width, height, silhouette, built)]
    layers = [rows(silhouette, k) for k in range(1, height + 1)]
    return [layer - built for layer in layers if built < layer]


def described(
    family: str, width: int, height: int, silhouette: Cells, placements: list[Placement]
) -> int:
    """Most placements in runs of two or more that fill one region of at most 3/4 of the cells."""

    def is_run(built: Cells, run: list[Placement]) -> bool:
        cells = [cell for placement in run for cell in cells_of(placement)]
        filled = frozenset(cells)
        return (
            len(run) > 1
            and len(cells) == len(filled)
            and 4 * len(filled) <= 3 * len(silhouette)
            and filled in regions(family, width, height, silhouette, built)
        )

    most = 0
    for cut in _cuts(len(placements)):
        covered = 0
        for begin, end in pairwise(cut):
            # A block that sticks out is no part of what is built.
            before = [cells_of(p) for p in placements[:begin]]
            built = EMPTY.union(*(cells for cells in before if cells <= silhouette))
            if is_run(built, placements[begin:end]):
                covered += end - begin
        most = max(most, covered)
    return most


def _cuts(length: int) -> Iterator[list[int]]:
    """Every way to cut so many things into successive runs, as their borders."""
    for bits in range(1 << max(0, length - 1)):
        inner = [place for place in range(1, length) if bits >> (place - 1) & 1]
        yield [0, *inner, length] if length else [0]
