"""Regions: parts of the silhouette to fill next, each with a label that describes it.

A region family lists the regions that can come next in a state. The paper's family is ``rows``:
the target rows below a height (paper, section "Subgoals").
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, NamedTuple, Protocol

from blocks_planning.board.geometry import MAX_SIDE, Mask
from blocks_planning.board.task import Task
from blocks_planning.families import Registry
from blocks_planning.settings import Configured, setting
from blocks_planning.subgoals.rectangles import RectangleLabel, rectangles

MAX_CELLS = MAX_SIDE * MAX_SIDE


class Label(NamedTuple):
    """The description of a region, as data.

    >>> str(Label('rows', (4,)))
    'rows 4'
    >>> str(Label('rectangle', (0, 2, 3, 1)))
    'rectangle 0,2,3,1'
    >>> str(Label('drawn'))
    'drawn'
    """

    kind: str
    numbers: tuple[int, ...] = ()

    def __str__(self) -> str:
        numbers = ','.join(map(str, self.numbers))
        return f'{self.kind} {numbers}' if numbers else self.kind


class Region(NamedTuple):
    """Target cells to fill, and their label. Some of the cells may be filled already."""

    label: Label
    cells: Mask

    def target(self, built: Mask) -> Mask:
        """The cells that are filled when the region is filled from a state."""
        return built | self.cells


class RegionFamily(Protocol):
    """A way to divide the silhouette into regions."""

    name: ClassVar[str]

    def regions(self, task: Task, built: Mask, partial: bool = False) -> list[Region]:
        """The regions that can come next in a state, in the order in which ties are drawn.

        Each adds at least one cell to the state. No two of them have the same target.

        Args:
            task: the silhouette, of which every cell that is not built can still be filled.
            built: the filled cells.
            partial: whether a region may leave out cells that are built.
        """
        ...


@dataclass(frozen=True)
class Rows(Configured):
    """The target rows below a height (paper, section "Subgoals")."""

    name: ClassVar[str] = 'rows'

    def regions(self, task: Task, built: Mask, partial: bool = False) -> list[Region]:
        """The different regions that strictly contain the state, the lowest first.

        If several heights have the same region, the lowest is listed. The last region is the whole
        silhouette; if the state has a cell outside it, there are no regions. With ``partial``
        every height counts below which a target cell is not filled.
        """
        regions: list[Region] = []
        listed = built
        for height in range(1, task.board.height + 1):
            cells = task.rows(height)
            target = built | cells
            if target != listed and (partial or target == cells):
                regions.append(Region(rows_label(height), cells))
                listed = target
        return regions


@dataclass(frozen=True)
class Rectangles(Configured):
    """The target cells inside a rectangle of the grid.

    The conditions are in :mod:`.rectangles`.
    """

    name: ClassVar[str] = 'rectangles'
    min_cells: int = setting(
        2, 'Smallest number of target cells in a rectangle.', least=1, most=MAX_CELLS, unit='cells'
    )
    max_cells: int = setting(
        0,
        'Largest number of target cells in a rectangle; 0: three quarters of the silhouette.',
        least=0,
        most=MAX_CELLS,
        unit='cells',
    )

    def regions(self, task: Task, built: Mask, partial: bool = False) -> list[Region]:
        """See :class:`RegionFamily`. By rising row, column, height and width."""
        found = rectangles(task, built, self.min_cells, self.max_cells)
        return [_rectangle(label, cells) for label, cells in found]


@lru_cache(maxsize=1 << 15)
def _rectangle(label: RectangleLabel, cells: Mask) -> Region:
    """A rectangle as a region (cached)."""
    return Region(Label(*label), cells)


REGIONS = Registry('regions', 'blocks_planning.regions', (Rows, Rectangles))


def rows_label(height: int) -> Label:
    """The label of the target rows below a height."""
    return Label(Rows.name, (height,))


def drawn_region(task: Task, built: Mask, cells: Mask) -> Region:
    """The region that a person drew: its target cells, labelled as rows if they are such."""
    target = built | (cells & task.silhouette)
    for height in range(1, task.board.height + 1):
        if task.rows(height) == target:
            return Region(rows_label(height), target)
    return Region(Label('drawn'), cells & task.silhouette)
