"""What planners consider, decide and do, word by word."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from oracles.board import Block, Cells, Placement, legal_placements, rows
from oracles.randomness import subgoal_generator

SUCCESS = 'success'
STUCK = 'stuck'
GAVE_UP = 'gave_up'


@dataclass(frozen=True)
class Candidate:
    """What a planner considered: the region rows(k), or for full a sequence of them (k a tuple).

    cells: r, what it adds [cells]. cost: c, its planning cost [states], for a sequence up to and
    with its first unsolved subgoal. value: V, or None when unsolved (or the planner has no V).
    status: that of the solve, for a sequence that of its last subgoal solved or tried.
    """

    k: int | tuple[int, ...]
    cells: int
    cost: int
    value: float | None
    status: str


@dataclass(frozen=True)
class Decision:
    """The candidates a planner considered at a state, and the k of the chosen one, if any."""

    built: Cells
    candidates: tuple[Candidate, ...]
    chosen: int | tuple[int, ...] | None


@dataclass(frozen=True)
class Trial:
    """What a planner did with a silhouette; costs in states evaluated."""

    status: str
    placements: tuple[Placement, ...]
    blocks: int
    subgoals: int
    action_planning_cost: int
    subgoal_planning_cost: int
    solution_cost: int
    decisions: tuple[Decision, ...]


def region_heights(silhouette: Cells, height: int, built: Cells) -> list[int]:
    """Each k whose region strictly contains what is built and differs from every lower one."""
    return [
        k
        for k in range(1, height + 1)
        if built < rows(silhouette, k) and rows(silhouette, k) != rows(silhouette, k - 1)
    ]


def ended(
    width: int, height: int, library: Sequence[Block], silhouette: Cells, built: Cells
) -> str | None:
    """The status of a trial that is over before a planner is asked, else None."""
    if built == silhouette:
        return SUCCESS
    if not legal_placements(width, height, library, silhouette, built):
        return STUCK
    return None


def pick_best(
    candidates: Sequence[Candidate], seed: int, built: Cells, height: int
) -> int | tuple[int, ...] | None:
    """The k of a candidate of highest V, ties uniformly; None when none is solved."""
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return None
    ties = [candidate.k for candidate in candidates if candidate.value == max(values)]
    return ties[subgoal_generator(seed, built, height).below(len(ties))]
