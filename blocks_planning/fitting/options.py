"""The options of a state and their values: the interface for planners.

A model of choice needs, for every option, the cells that it names and the sequences of subgoals
that begin with it, each with its cells r and its cost c. :class:`Ahead` gives them for a region
family, one or more subgoals ahead.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from typing import NamedTuple, Protocol

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.fitting.points import Asking
from blocks_planning.people.families import find_family
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.search.searches import make_search
from blocks_planning.search.solve import solve

QUICK_BUDGET = 2_000
"""Budget of the first attempt to solve a region [states]."""


class Sequence(NamedTuple):
    """A sequence of subgoals that begins with an option: r [cells] and c [states]."""

    cells: int
    cost: int


@dataclass(frozen=True)
class Option:
    """A region that can be chosen.

    Attributes:
        cells: that it adds.
        sequences: solvable ones that begin with it; empty if there are none, as when the region
            cannot be built.
        placements: that fill it.
    """

    cells: Mask
    sequences: tuple[Sequence, ...]
    placements: tuple[Placed, ...] = ()


class OptionMaker(Protocol):
    """Gives the options of a state."""

    def options(self, task: Task, built: Mask, asking: Asking) -> tuple[Option, ...]:
        """All options of a state, in a fixed order; no two add the same cells."""
        ...


class Solves:
    """Answers of solves, shared by all models and sessions."""

    def __init__(self) -> None:
        """Start without answers."""
        self._known: dict[tuple[Task, Mask, Mask, Asking], SolveResult | None] = {}

    def __len__(self) -> int:
        return len(self._known)

    def solved(self, task: Task, built: Mask, region: Mask, asking: Asking) -> SolveResult | None:
        """The solve of a region from a state; None if it is not solved.

        A solve that succeeds within a small budget has the same result within a larger one. If it
        fails, the exact search first checks whether the region is unsolvable, which is cheaper
        than using up the budget.
        """
        key = task, built, region, asking
        if key not in self._known:
            self._known[key] = _solved(Problem(task, built, region), asking)
        return self._known[key]


def _solved(problem: Problem, asking: Asking) -> SolveResult | None:
    quick = solve(problem, asking.search, asking.seed, min(QUICK_BUDGET, asking.budget))
    if quick.solved or asking.budget <= QUICK_BUDGET:
        return quick if quick.solved else None
    if _is_impossible(problem):
        return None
    result = solve(problem, asking.search, asking.seed, asking.budget)
    return result if result.solved else None


def _is_impossible(problem: Problem) -> bool:
    try:
        return not solve(problem, make_search('exact', {}), 0).solved
    except LimitExceeded:
        return False


class Ahead:
    """The regions of a family with the sequences that a scoping planner weighs.

    Of the sequences that begin with an option, those are kept that can be the best one for some
    lambda: each of fewer cells has a lower cost.
    """

    def __init__(self, regions: str, solves: Solves, horizon: int = 1) -> None:
        """Use the regions of a family.

        Args:
            regions: name of the family.
            solves: shared with others.
            horizon: number of subgoals of a sequence; fewer if it completes the silhouette.

        Raises:
            ConfigurationError: for an unknown family.
        """
        self._family = find_family(regions)
        self._solves = solves
        self._horizon = horizon
        self._made: dict[tuple[Task, Mask, Asking, int], tuple[Option, ...]] = {}

    def options(self, task: Task, built: Mask, asking: Asking) -> tuple[Option, ...]:
        """See :class:`OptionMaker`."""
        return self._options(task, built, asking, self._horizon)

    def _options(self, task: Task, built: Mask, asking: Asking, ahead: int) -> tuple[Option, ...]:
        key = task, built, asking, ahead
        if key not in self._made:
            regions = self._family(task, built)
            self._made[key] = tuple(self._option(*key, cells) for cells in regions)
        return self._made[key]

    def _option(self, task: Task, built: Mask, asking: Asking, ahead: int, cells: Mask) -> Option:
        target = built | cells
        result = self._solves.solved(task, built, target, asking)
        if result is None:
            return Option(cells, ())
        first = Sequence(area(cells), result.planning_cost)
        if ahead == 1 or not task.silhouette & ~target:
            return Option(cells, (first,), result.placements)
        following = self._options(task, target, asking, ahead - 1)
        sequences = (
            Sequence(first.cells + one.cells, first.cost + one.cost)
            for option in following
            for one in option.sequences
        )
        return Option(cells, undominated(sequences), result.placements)


def undominated(sequences: Iterable[Sequence]) -> tuple[Sequence, ...]:
    """Those to which no other is at least equal in both cells and cost; most cells first.

    >>> undominated([Sequence(2, 9), Sequence(4, 9), Sequence(2, 5), Sequence(1, 7)])
    (Sequence(cells=4, cost=9), Sequence(cells=2, cost=5))
    """
    found: list[Sequence] = []
    for one in sorted(sequences, key=lambda one: (-one.cells, one.cost)):
        if not found or one.cost < found[-1].cost:
            found.append(one)
    return tuple(found)


def drawable(task: Task, built: Mask) -> int:
    """Number of different regions that can be drawn in a state, any of which a lapse can choose.

    One for every set of :func:`drawn_by_rectangle`, and one more for all other shapes together.
    """
    return len(drawn_by_rectangle(task.board, task.silhouette & ~built)) + 1


@lru_cache(maxsize=4096)
def drawn_by_rectangle(board: Board, left: Mask) -> tuple[Mask, ...]:
    """Every set of unfinished target cells that a rectangle of the board cuts out, sorted.

    The candidates of ``rows`` and of ``rectangles`` are among them.
    """
    return tuple(sorted({inside & left for inside in _all_rectangles(board)} - {0}))


@lru_cache(maxsize=8)
def _all_rectangles(board: Board) -> tuple[Mask, ...]:
    columns = [(a, b) for a, b in product(range(board.width), repeat=2) if a <= b]
    rows = [(a, b) for a, b in product(range(board.height), repeat=2) if a <= b]
    return tuple(
        board.rectangle(left, low, right - left + 1, high - low + 1)
        for (left, right), (low, high) in product(columns, rows)
    )
