"""Measures of the order in which a tower is built, for people and planners alike.

Each measure of a build is a :class:`Count`, so that shares can be taken over any set of builds.
Cells outside the silhouette never count as built: people could place blocks there.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Iterator
from functools import cache
from itertools import pairwise
from typing import NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask, Row, area
from blocks_planning.board.task import Task
from blocks_planning.people.families import Family

Placements = tuple[Placed, ...]

LARGEST_SHARE = 0.75
"""Largest region that can describe an order, as a share of the silhouette: the whole silhouette
would describe every complete build."""


class Count(NamedTuple):
    """Number of hits, and number of cases."""

    hits: int
    chances: int


def lies_on(board: Board, placed: Placed) -> bool:
    """Whether all of a block lies on the board."""
    return (
        placed.column >= 0
        and placed.row >= 0
        and placed.column + placed.width <= board.width
        and placed.row + placed.height <= board.height
    )


def cells_inside(task: Task, placed: Placed) -> Mask | None:
    """The cells of a block; None if it does not lie wholly inside the silhouette."""
    if not lies_on(task.board, placed):
        return None
    cells = rules.cells_of(task.board, placed)
    return None if cells & ~task.silhouette else cells


def inside(task: Task, placements: Placements) -> Count:
    """Placements wholly inside the silhouette, of all placements."""
    hits = sum(cells_inside(task, placed) is not None for placed in placements)
    return Count(hits, len(placements))


def perfect(task: Task, placements: Placements) -> Count:
    """Builds that fill the silhouette and nothing else, of all builds."""
    parts = [cells_inside(task, placed) for placed in placements]
    built = 0
    for part in parts:
        if part is None or part & built:
            return Count(0, 1)
        built |= part
    return Count(int(built == task.silhouette), 1)


def upwards(_: Task, placements: Placements) -> Count:
    """Placements whose lowest row is at or above the previous one's, of all except the first."""
    pairs = list(pairwise(placements))
    return Count(sum(later.row >= earlier.row for earlier, later in pairs), len(pairs))


def rightwards(_: Task, placements: Placements) -> Count:
    """Placements to the right of the one before, of those on the same row as the one before."""
    level = [
        later.column > earlier.column
        for earlier, later in pairwise(placements)
        if later.row == earlier.row and later.column != earlier.column
    ]
    return Count(sum(level), len(level))


def lowest_row(task: Task, placements: Placements) -> Count:
    """Placements that stand on the lowest unfinished row, of those made before all are finished."""
    hits = chances = built = 0
    for placed in placements:
        row = _lowest_unfinished(task, built)
        if row is None:
            break
        hits += placed.row == row
        chances += 1
        built |= cells_inside(task, placed) or 0
    return Count(hits, chances)


def _lowest_unfinished(task: Task, built: Mask) -> Row | None:
    return min((row for _, row in task.board.cells(task.silhouette & ~built)), default=None)


MEASURES: dict[str, Callable[[Task, Placements], Count]] = {
    'upwards': upwards,
    'lowest_row': lowest_row,
    'rightwards': rightwards,
    'inside': inside,
    'perfect': perfect,
}
"""Every measure that does not depend on a region family, by name."""


class Describer:
    """Measures how well a region family describes the order of building.

    An order is described where successive placements, at least two, fill exactly one region of
    the family in the state in which the first of them was placed. A single block contains no
    information about an order, nor does the whole silhouette; see ``LARGEST_SHARE``.
    """

    def __init__(self, family: Family) -> None:
        """Use the regions of a family."""
        self._regions = cache(lambda task, built: self._proper(task, family(task, built)))

    def _proper(self, task: Task, regions: list[Mask]) -> frozenset[Mask]:
        most = LARGEST_SHARE * area(task.silhouette)
        return frozenset(cells for cells in regions if area(cells) <= most)

    def described(self, task: Task, placements: Placements) -> Count:
        """Placements in such runs (chosen to cover as many as possible), of all placements."""
        best = [0] * (len(placements) + 1)
        parts = [cells_inside(task, placed) for placed in placements]
        states = list(_states(parts))
        for begin in reversed(range(len(parts))):
            best[begin] = best[begin + 1]
            for end in self._ends(task, parts, begin, states[begin]):
                best[begin] = max(best[begin], end - begin + best[end])
        return Count(best[0], len(placements))

    def _ends(
        self, task: Task, parts: list[Mask | None], begin: int, built: Mask
    ) -> Iterator[int]:
        """The ends of the runs that begin at a placement: the index after their last placement."""
        filled = 0
        for number, part in enumerate(parts[begin:], start=begin):
            if part is None or part & (built | filled):
                return
            filled |= part
            if number > begin and filled in self._regions(task, built):
                yield number + 1


def _states(parts: list[Mask | None]) -> Iterator[Mask]:
    built = 0
    for part in parts:
        yield built
        built |= part or 0


def shuffled(placements: Placements, source: random.Random) -> Placements:
    """The same blocks in a random order in which they could be dropped: the chance level.

    Repeatedly draws uniformly among the blocks that have no remaining block below them.
    """
    left = list(placements)
    order = []
    while left:
        free = [placed for placed in left if not any(_is_below(one, placed) for one in left)]
        order.append(source.choice(free))
        left.remove(order[-1])
    return tuple(order)


def _is_below(low: Placed, high: Placed) -> bool:
    return (
        low.row < high.row
        and low.column < high.column + high.width
        and high.column < low.column + low.width
    )
