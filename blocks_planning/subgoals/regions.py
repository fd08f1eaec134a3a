"""Subgoals as regions of space: the target rows below a height (paper, section "Subgoals")."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task


class Region(NamedTuple):
    """The target cells of the rows below a height: ``rows(height)``."""

    height: int
    cells: Mask


def regions_above(task: Task, built: Mask) -> list[Region]:
    """The different regions that strictly contain what is built, the lowest first.

    Of heights with the same region the lowest stands for all. The last region is the whole
    silhouette, unless that does not strictly contain what is built: then there is none.
    """
    regions: list[Region] = []
    previous = 0
    for height in range(1, task.board.height + 1):
        cells = task.rows(height)
        if cells != previous and cells != built and not built & ~cells:
            regions.append(Region(height, cells))
        previous = cells
    return regions


def height_of(task: Task, region: Mask) -> int | None:
    """The lowest height below which the target rows are a region; None for another shape."""
    heights = range(1, task.board.height + 1)
    return next((height for height in heights if task.rows(height) == region), None)
