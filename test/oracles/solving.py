"""Solving a region by attempts, word by word.

Nothing is cached: a region is solved again each time somebody asks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from oracles.board import Block, Cells, Placement, legal_placements
from oracles.search import attempt
from oracles.tree import check_at_least

SOLVED = 'solved'
UNSOLVABLE_PROVEN = 'unsolvable_proven'
BUDGET_EXHAUSTED = 'budget_exhausted'

DEFAULT_BUDGET = 100_000


@dataclass(frozen=True)
class Solution:
    """What solving a region gave; costs in states evaluated.

    solution_cost is the cost of the successful attempt (0 if none), planning_cost that of all.
    """

    status: str
    placements: tuple[Placement, ...]
    solution_cost: int
    planning_cost: int
    attempts: int
    last_attempt: tuple[Placement, ...] = ()


def solve(
    width: int,
    height: int,
    library: Sequence[Block],
    region: Cells,
    built: Cells,
    seed: int,
    /,
    *,
    search: str,
    budget: int = DEFAULT_BUDGET,
    **settings: Any,
) -> Solution:
    """Attempt after attempt until one fills `region` or the budget [states] is used up.

    settings: those of the search, e.g. depth, iterations, divisor, execute.
    Raises ValueError when something is built outside the region.
    """
    check_at_least('budget', budget, 0)
    if not built <= region:
        raise ValueError(f'built outside the region: {sorted(built - region)}')
    if built == region:
        return Solution(SOLVED, (), 0, 0, 0)
    if not legal_placements(width, height, library, region, built):
        return Solution(UNSOLVABLE_PROVEN, (), 0, 0, 0)
    cost = 0
    for number in range(max(1, budget)):
        result = attempt(
            width, height, library, region, built, seed, number, search=search, **settings
        )
        cost += result.cost
        if result.success:
            return Solution(SOLVED, result.placements, result.cost, cost, number + 1)
        if cost >= budget:
            break
    return Solution(BUDGET_EXHAUSTED, (), 0, cost, number + 1, tuple(result.placements))
