"""Region families by name, as this package measures with them: the cells that a region adds."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, shown
from blocks_planning.subgoals.rectangles import rectangles
from blocks_planning.subgoals.regions import regions_above

Family: TypeAlias = Callable[[Task, Mask], list[Mask]]
"""The cells that each candidate region of a state would add, in the order of the family."""


def _rows(task: Task, built: Mask) -> list[Mask]:
    return [region.cells & ~built for region in regions_above(task, built)]


def _rectangles(task: Task, built: Mask) -> list[Mask]:
    return [cells for _, cells in rectangles(task, built)]


FAMILIES: dict[str, Family] = {'rows': _rows, 'rectangles': _rectangles}


def find_family(name: str) -> Family:
    """The family of a name.

    Raises:
        ConfigurationError: for an unknown name; it lists those that exist.
    """
    if name not in FAMILIES:
        raise ConfigurationError(
            f'region family must be one of {", ".join(FAMILIES)}, got {shown(name)}'
        )
    return FAMILIES[name]
