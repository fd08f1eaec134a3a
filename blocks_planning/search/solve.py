"""Solve: the entry point of action-level search."""

from __future__ import annotations

from blocks_planning.board import rules
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.result import (
    DEFAULT_BUDGET,
    MAX_BUDGET,
    CancelToken,
    Problem,
    SolveResult,
    SolveStatus,
)
from blocks_planning.search.searches import Search
from blocks_planning.settings import check_whole


def solve(
    problem: Problem,
    search: Search,
    seed: int,
    budget: int = DEFAULT_BUDGET,
    cancel: CancelToken | None = None,
) -> SolveResult:
    """Fill a region from a state: attempts until one succeeds or the budget is reached.

    The attempt that crosses the budget is finished, and there is always at least one, so a budget
    of 0 means a single attempt. Attempts without cost (random) are limited to the number of states
    of the budget. A pure function of its arguments, unless cancelled.

    Args:
        problem: state and region.
        search: the action-level search of each attempt.
        seed: of the trial, 0 to 2**64 - 1.
        budget: b [states], 0 to 2**63 - 1.
        cancel: ends the solve from another thread.

    Raises:
        ConfigurationError: if the seed or the budget is out of its range.
    """
    check_whole('seed', seed, 0, MAX_SEED)
    check_whole('budget', budget, 0, MAX_BUDGET)
    if problem.built == problem.region:
        return SolveResult(SolveStatus.SOLVED)
    if next(rules.legal_placements(problem.task, problem.built, problem.region), None) is None:
        return SolveResult(SolveStatus.UNSOLVABLE_PROVEN)
    try:
        return search.run(problem, seed, budget, cancel or CancelToken())
    except LimitExceeded:
        return SolveResult(SolveStatus.LIMIT_EXCEEDED, attempts=1)
