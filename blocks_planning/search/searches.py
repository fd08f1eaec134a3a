"""The action-level searches by name, with their settings.

A search is a frozen dataclass whose fields are its settings (:mod:`blocks_planning.settings`). Its
``run(problem, seed, budget, cancel)`` may assume that the problem is neither solved already nor
without a legal placement: :func:`.solve.solve` checks both first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from blocks_planning.board.task import Task
from blocks_planning.families import Registry
from blocks_planning.search.result import CancelToken, Problem, SolveResult
from blocks_planning.settings import Configured, setting

MAX_DEPTH = 64
MAX_ITERATIONS = 1_000_000
DIVISORS = ('smallest', 'mean', 'largest')
DEAD_ENDS = ('worst', 'ignored')
EXECUTIONS = ('first', 'path')


class Search(Protocol):
    """An action-level search."""

    name: ClassVar[str]

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """Solve a problem within a budget [states].

        Raises:
            LimitExceeded: if the search would outgrow its memory.
        """
        ...


@dataclass(frozen=True)
class RandomPlacement(Configured):
    """A legal placement, uniformly, until none is left. Cost 0."""

    name: ClassVar[str] = 'random'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`."""
        from blocks_planning.search import compiled

        return compiled.solve_at_random(problem, seed, budget, cancel)


@dataclass(frozen=True)
class BreadthFirst(Configured):
    """Breadth-first lookahead of ``depth`` placements (paper, section "Action-level planning").

    It executes the first placement towards the best state seen, uniformly among equals, and
    looks again; a complete state that is taken up for expansion is built whole. More filled cells
    are better. A state without a legal placement is 'worst' of all (the published numbers), which
    takes a look one level beyond ``depth`` that is not counted; or such dead ends are 'ignored',
    so that the filled cells alone decide (the paper's text).
    """

    name: ClassVar[str] = 'bfs'
    depth: int = setting(
        3, 'Placements that the search looks ahead.', least=1, most=MAX_DEPTH, unit='placements'
    )
    dead_ends: str = setting(
        'worst', 'How a state without a legal placement is ranked.', choices=DEAD_ENDS
    )

    @property
    def dead_ends_last(self) -> bool:
        """Whether a state without a legal placement ranks below all others."""
        return self.dead_ends == 'worst'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`."""
        from blocks_planning.search import compiled

        return compiled.solve_breadth_first(
            problem, self.depth, self.dead_ends_last, seed, budget, cancel
        )


def _iterations() -> Any:
    return setting(
        4096,
        'Nodes taken from the queue in one search.',
        least=2,
        most=MAX_ITERATIONS,
        unit='nodes',
    )


def _execute() -> Any:
    return setting(
        'first', 'Placements executed of a path that is not complete.', choices=EXECUTIONS
    )


@dataclass(frozen=True)
class AStar(Configured):
    """A* for some iterations; f = blocks placed + cells left / divisor.

    The divisor is the 'smallest' block area (the paper's text), the 'mean' (its published numbers)
    or the 'largest' (admissible). A search that did not complete executes the 'first' placement
    of its path (the paper's text) or the whole 'path' (its published numbers).

    f is a float64, as in the paper's own program, and nodes are equal if their f is. With the
    mean divisor 4.8 some values that are equal as fractions differ in the last bit, which the
    results show.
    """

    name: ClassVar[str] = 'astar'
    iterations: int = _iterations()
    divisor: str = setting(
        'smallest', 'Block area that divides the cells left in the heuristic.', choices=DIVISORS
    )
    execute: str = _execute()

    def divisor_of(self, task: Task) -> float:
        """The divisor of the cells left [cells]."""
        areas = [block.area for block in task.library]
        kinds = {'smallest': min(areas), 'mean': sum(areas) / len(areas), 'largest': max(areas)}
        return float(kinds[self.divisor])

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`."""
        from blocks_planning.search import compiled

        return compiled.solve_best_first(
            problem,
            self.iterations,
            1,
            self.divisor_of(problem.task),
            self.execute == 'path',
            seed,
            budget,
            cancel,
        )


@dataclass(frozen=True)
class BestFirst(Configured):
    """A* with the blocks placed left out: the fewest cells left come first."""

    name: ClassVar[str] = 'best_first'
    iterations: int = _iterations()
    execute: str = _execute()

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`."""
        from blocks_planning.search import compiled

        return compiled.solve_best_first(
            problem, self.iterations, 0, 1.0, self.execute == 'path', seed, budget, cancel
        )


@dataclass(frozen=True)
class Exact(Configured):
    """The fewest blocks, or proof that there is no way. Not a model of people: the yardstick.

    Its cost is the number of states that its dynamic program generates by placing a block.
    """

    name: ClassVar[str] = 'exact'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`. The seed and the budget play no part.

        Raises:
            LimitExceeded: if the problem is too large (see :mod:`.exact`).
        """
        from blocks_planning.search import exact

        return exact.solve_exactly(problem, cancel)


SEARCHES = Registry(
    'search',
    'blocks_planning.searches',
    (BreadthFirst, AStar, BestFirst, RandomPlacement, Exact),
)


def make_search(name: object, values: Mapping[str, object]) -> Search:
    """The search of a name with some settings; see :meth:`.Registry.make`."""
    search: Search = SEARCHES.make(name, values)
    return search
