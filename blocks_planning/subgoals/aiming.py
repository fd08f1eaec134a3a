"""What a planner aims at when a perfect reconstruction has become impossible.

A cell filled outside the silhouette, or a target cell that a block covers, makes a perfect
reconstruction impossible. With aim ``perfect`` a planner gives up when no candidate can be solved;
with aim ``most`` it continues until no further target cell can be filled.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.settings import setting
from blocks_planning.subgoals.regions import Region, RegionFamily

AIMS = ('perfect', 'most')


def aim_setting() -> Any:
    """The setting ``aim`` of a strategy."""
    return setting(
        'perfect', 'Aim when a perfect reconstruction has become impossible.', choices=AIMS
    )


def regions_to_aim_at(family: RegionFamily, task: Task, built: Mask, aim: str) -> list[Region]:
    """The regions of a family in a state; with aim ``most`` those that can still be filled.

    With aim ``most`` the silhouette is replaced by its cells that can still be filled, together
    with the cells that are built.
    """
    if aim == 'perfect':
        return family.regions(task, built)
    buried = rules.shadow(task.board, built) & ~built
    reachable = replace(task, silhouette=task.silhouette & ~buried | built)
    return family.regions(reachable, built, partial=True)
