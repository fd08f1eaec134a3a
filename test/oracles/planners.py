"""Solving a region by attempts, and the three subgoal-level planners, word by word.

Nothing is cached: a region is solved again each time somebody asks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from oracles.board import EMPTY, Block, Cells, Placement, legal_placements, place, rows
from oracles.randomness import subgoal_generator
from oracles.search import attempt, check_at_least

SOLVED = 'solved'
UNSOLVABLE_PROVEN = 'unsolvable_proven'
BUDGET_EXHAUSTED = 'budget_exhausted'

SUCCESS = 'success'
STUCK = 'stuck'
GAVE_UP = 'gave_up'

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


def none(
    width: int,
    height: int,
    silhouette: Cells,
    library: Sequence[Block],
    built: Cells = EMPTY,
    seed: int = 0,
    /,
    *,
    search: str,
    budget: int = DEFAULT_BUDGET,
    **settings: Any,
) -> Trial:
    """No subgoals: the whole silhouette at once."""
    status = ended(width, height, library, silhouette, built)
    if status is not None:
        return Trial(status, (), 0, 0, 0, 0, 0, ())
    heights = region_heights(silhouette, height, built)
    if not heights:
        return Trial(GAVE_UP, (), 0, 0, 0, 0, 0, (Decision(built, (), None),))
    whole = heights[-1]
    solution = solve(
        width, height, library, silhouette, built, seed, search=search, budget=budget, **settings
    )
    cells = len(silhouette) - len(built)
    candidate = Candidate(whole, cells, solution.planning_cost, None, solution.status)
    if solution.last_attempt:
        return Trial(
            status=STUCK,
            placements=solution.last_attempt,
            blocks=len(solution.last_attempt),
            subgoals=1,
            action_planning_cost=solution.planning_cost,
            subgoal_planning_cost=0,
            solution_cost=0,
            decisions=(Decision(built, (candidate,), whole),),
        )
    if solution.status != SOLVED:
        return Trial(GAVE_UP, (), 0, 0, 0, 0, 0, (Decision(built, (candidate,), None),))
    return Trial(
        status=SUCCESS,
        placements=solution.placements,
        blocks=len(solution.placements),
        subgoals=1,
        action_planning_cost=solution.planning_cost,
        subgoal_planning_cost=0,
        solution_cost=solution.solution_cost,
        decisions=(Decision(built, (candidate,), whole),),
    )


def scoping(
    width: int,
    height: int,
    silhouette: Cells,
    library: Sequence[Block],
    built: Cells = EMPTY,
    seed: int = 0,
    /,
    *,
    search: str,
    lam: float,
    commit: str = 'subgoal',
    budget: int = DEFAULT_BUDGET,
    **settings: Any,
) -> Trial:
    """Weigh every next subgoal, execute the one of highest V, and so on until complete.

    commit: 'subgoal' to execute the whole plan of the chosen one, 'action' its first placement.
    """
    if commit not in ('subgoal', 'action'):
        raise ValueError(f"commit must be 'subgoal' or 'action', got {commit!r}")
    placements: list[Placement] = []
    decisions: list[Decision] = []
    subgoals = action_planning_cost = subgoal_planning_cost = solution_cost = 0
    status = ended(width, height, library, silhouette, built)
    while status is None:
        candidates, solutions = scoping_candidates(
            width, height, silhouette, library, built, seed, lam, search, budget, settings
        )
        chosen = pick_best(candidates, seed, built, height)
        decisions.append(Decision(built, tuple(candidates), chosen))
        subgoal_planning_cost += sum(candidate.cost for candidate in candidates)
        if chosen is None:
            status = GAVE_UP
            break
        solution = solutions[chosen]
        executed = solution.placements if commit == 'subgoal' else solution.placements[:1]
        placements.extend(executed)
        built = place(built, executed)
        subgoals += 1
        action_planning_cost += solution.planning_cost
        solution_cost += solution.solution_cost
        status = ended(width, height, library, silhouette, built)
    return Trial(
        status=status,
        placements=tuple(placements),
        blocks=len(placements),
        subgoals=subgoals,
        action_planning_cost=action_planning_cost,
        subgoal_planning_cost=subgoal_planning_cost,
        solution_cost=solution_cost,
        decisions=tuple(decisions),
    )


def scoping_candidates(
    width: int,
    height: int,
    silhouette: Cells,
    library: Sequence[Block],
    built: Cells,
    seed: int,
    lam: float,
    search: str,
    budget: int,
    settings: dict[str, Any],
) -> tuple[list[Candidate], dict[int | tuple[int, ...], Solution]]:
    """All candidate subgoals at a state, in ascending k, and the solution of each k."""
    candidates: list[Candidate] = []
    solutions: dict[int | tuple[int, ...], Solution] = {}
    for k in region_heights(silhouette, height, built):
        region = rows(silhouette, k)
        solution = solve(
            width, height, library, region, built, seed, search=search, budget=budget, **settings
        )
        cells = len(region) - len(built)
        cost = solution.planning_cost
        value = cells - lam * cost if solution.status == SOLVED else None
        candidates.append(Candidate(k, cells, cost, value, solution.status))
        solutions[k] = solution
    return candidates, solutions


def pick_best(
    candidates: Sequence[Candidate], seed: int, built: Cells, height: int
) -> int | tuple[int, ...] | None:
    """The k of a candidate of highest V, ties uniformly; None when none is solved."""
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return None
    ties = [candidate.k for candidate in candidates if candidate.value == max(values)]
    return ties[subgoal_generator(seed, built, height).below(len(ties))]


def sequences_of(heights: Sequence[int]) -> list[tuple[int, ...]]:
    """Every increasing sequence of region heights that ends with the last, in lexical order."""
    lower, last = heights[:-1], heights[-1]
    choices = [combinations(lower, length) for length in range(len(lower) + 1)]
    return sorted((*chosen, last) for choice in choices for chosen in choice)


def full(
    width: int,
    height: int,
    silhouette: Cells,
    library: Sequence[Block],
    seed: int = 0,
    /,
    *,
    search: str,
    lam: float = 1.0,
    budget: int = DEFAULT_BUDGET,
    **settings: Any,
) -> Trial:
    """Solve along every sequence of subgoals from the empty board; execute the best complete."""
    status = ended(width, height, library, silhouette, EMPTY)
    if status is not None:
        return Trial(status, (), 0, 0, 0, 0, 0, ())
    candidates: list[Candidate] = []
    solutions: dict[int | tuple[int, ...], list[Solution]] = {}
    for sequence in sequences_of(region_heights(silhouette, height, EMPTY)):
        steps = solve_along(
            width, height, silhouette, library, sequence, seed, search, budget, settings
        )
        cost = sum(step.planning_cost for step in steps)
        last_status = steps[-1].status
        value = len(silhouette) - lam * cost if last_status == SOLVED else None
        candidates.append(Candidate(sequence, len(silhouette), cost, value, last_status))
        solutions[sequence] = steps
    considered_cost = sum(candidate.cost for candidate in candidates)
    chosen = pick_best(candidates, seed, EMPTY, height)
    decision = Decision(EMPTY, tuple(candidates), chosen)
    if chosen is None:
        return Trial(GAVE_UP, (), 0, 0, 0, considered_cost, 0, (decision,))
    steps = solutions[chosen]
    placements = tuple(placement for step in steps for placement in step.placements)
    return Trial(
        status=SUCCESS,
        placements=placements,
        blocks=len(placements),
        subgoals=len(steps),
        action_planning_cost=sum(step.planning_cost for step in steps),
        subgoal_planning_cost=considered_cost,
        solution_cost=sum(step.solution_cost for step in steps),
        decisions=(decision,),
    )


def solve_along(
    width: int,
    height: int,
    silhouette: Cells,
    library: Sequence[Block],
    sequence: Sequence[int],
    seed: int,
    search: str,
    budget: int,
    settings: dict[str, Any],
) -> list[Solution]:
    """The solutions of the subgoals of one sequence, up to and with the first unsolved one."""
    built = EMPTY
    steps: list[Solution] = []
    for k in sequence:
        region = rows(silhouette, k)
        solution = solve(
            width, height, library, region, built, seed, search=search, budget=budget, **settings
        )
        steps.append(solution)
        if solution.status != SOLVED:
            break
        built = place(built, solution.placements)
    return steps
