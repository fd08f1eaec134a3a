"""Region families by name, as functions that list the cells that each region adds."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TypeAlias

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.subgoals.regions import REGIONS, RegionFamily

Family: TypeAlias = Callable[[Task, Mask], list[Mask]]
"""The cells that each candidate region of a state would add, in the order of the family."""


def find_family(name: str) -> Family:
    """The family of a name, with its default settings.

    Raises:
        ConfigurationError: for an unknown name; it lists those that exist.
    """
    return partial(_added, REGIONS.make(name, {}))


def _added(family: RegionFamily, task: Task, built: Mask) -> list[Mask]:
    return [region.cells & ~built for region in family.regions(task, built)]


def family_names() -> tuple[str, ...]:
    """The families that measures can use."""
    return tuple(REGIONS)
