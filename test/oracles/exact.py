"""Fewest blocks that fill a region, and the number of complete arrangements, in two ways.

`by_dropping` drops blocks in every order and looks at what came out. `by_tiling` never drops
anything: it claims that a set of rectangles can be built, in some order, exactly if it tiles what
is left of the region, no rectangle lies under a cell that is already built, and every rectangle
stands on the ground or on at least one cell of the region. That both agree is the proof by
example of that claim.

An arrangement is the set of rectangles placed; neither their order nor two blocks of the same
size in the library make a difference.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from oracles.board import Block, Cells, Placement, cells_of, legal_placements, place


@dataclass(frozen=True)
class Exact:
    """Fewest blocks (None: cannot be filled) and the number of complete arrangements."""

    fewest_blocks: int | None
    arrangements: int


def by_dropping(
    width: int, height: int, library: Sequence[Block], region: Cells, built: Cells
) -> Exact:
    """Drop blocks in every order and collect the sets of placed rectangles.

    A set that was reached before is not expanded again: what is filled, and so all that can
    follow, depends on the set alone.
    """
    complete = arrangements_by_dropping(width, height, library, region, built)
    sizes = [len(arrangement) for arrangement in complete]
    return Exact(min(sizes, default=None), len(complete))


def arrangements_by_dropping(
    width: int, height: int, library: Sequence[Block], region: Cells, built: Cells
) -> set[frozenset[Placement]]:
    """All complete arrangements that dropping blocks in some order leads to."""
    start: frozenset[Placement] = frozenset()
    seen = {start}
    waiting = [start]
    complete = set()
    while waiting:
        placed = waiting.pop()
        state = place(built, sorted(placed))
        if state == region:
            complete.add(placed)
        for placement in legal_placements(width, height, library, region, state):
            more = placed | {placement}
            if more not in seen:
                seen.add(more)
                waiting.append(more)
    return complete


def by_tiling(
    width: int, height: int, library: Sequence[Block], region: Cells, built: Cells
) -> Exact:
    """Count the tilings of what is left of the region by rectangles that can be put there.

    Remembers the answer for each set of cells left, so that whole towers can be counted.
    """
    if not built <= region:
        return Exact(None, 0)

    @cache
    def count(left: Cells) -> tuple[int | None, int]:
        if not left:
            return 0, 1
        fewest, arrangements = None, 0
        for rectangle in rectangles_on_lowest_cell(library, left):
            if not can_be_put(rectangle, region, built):
                continue
            rest_fewest, rest_arrangements = count(left - cells_of(rectangle))
            arrangements += rest_arrangements
            if rest_fewest is not None and (fewest is None or rest_fewest + 1 < fewest):
                fewest = rest_fewest + 1
        return fewest, arrangements

    return Exact(*count(region - built))


def rectangles_on_lowest_cell(library: Sequence[Block], left: Cells) -> list[Placement]:
    """The rectangles inside `left` whose lower left cell is its lowest, then leftmost cell.

    Any tiling covers that cell, and no rectangle inside `left` can reach below or left of it.
    """
    row, column = min((row, column) for column, row in left)
    rectangles = [Placement(width, height, column, row) for width, height in sorted(set(library))]
    return [rectangle for rectangle in rectangles if cells_of(rectangle) <= left]


def can_be_put(rectangle: Placement, region: Cells, built: Cells) -> bool:
    """Whether a rectangle of a finished tower has support and is not under a built cell."""
    columns = range(rectangle.column, rectangle.column + rectangle.width)
    supported = rectangle.row == 0 or any((c, rectangle.row - 1) in region for c in columns)
    covered = any(c in columns and r > rectangle.row for c, r in built)
    return supported and not covered
