"""The three subgoal-level planners, word by word."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import Any

from oracles.board import EMPTY, Block, Cells, Placement, place, rows
from oracles.decisions import (
    GAVE_UP,
    STUCK,
    SUCCESS,
    Candidate,
    Decision,
    Trial,
    ended,
    pick_best,
    region_heights,
)
from oracles.solving import DEFAULT_BUDGET, SOLVED, Solution, solve


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
