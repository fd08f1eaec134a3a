"""The options of a state and their values: the interface for planners.

A model of choice needs, for every option, the cells that it names and the sequences of subgoals
that begin with it, each with its cells r and its cost c. :class:`OneAhead` gives them for a region
family one subgoal ahead. A planner that looks further ahead needs another :class:`OptionMaker`.
"""

from __future__ import annotations

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
        sequences: solvable ones that begin with it; empty if the region cannot be built.
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


class OneAhead:
    """The regions of a family, one subgoal ahead: the paper's scoping planner."""

    def __init__(self, regions: str, solves: Solves) -> None:
        """Use the regions of a family.

        Args:
            regions: name of the family.
            solves: shared with others.

        Raises:
            ConfigurationError: for an unknown family.
        """
        self._family = find_family(regions)
        self._solves = solves
        self._made: dict[tuple[Task, Mask, Asking], tuple[Option, ...]] = {}

    def options(self, task: Task, built: Mask, asking: Asking) -> tuple[Option, ...]:
        """See :class:`OptionMaker`."""
        key = task, built, asking
        if key not in self._made:
            self._made[key] = tuple(
                self._option(task, built, cells, asking) for cells in self._family(task, built)
            )
        return self._made[key]

    def _option(self, task: Task, built: Mask, cells: Mask, asking: Asking) -> Option:
        result = self._solves.solved(task, built, built | cells, asking)
        if result is None:
            return Option(cells, ())
        sequence = Sequence(area(cells), result.planning_cost)
        return Option(cells, (sequence,), result.placements)


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
