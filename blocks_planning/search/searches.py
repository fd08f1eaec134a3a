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
from blocks_planning.external import refuse_external
from blocks_planning.families import Registry
from blocks_planning.search.external import ExternalSearch
from blocks_planning.search.result import MAX_DEPTH, CancelToken, Problem, SolveResult
from blocks_planning.search.stable import StableBreadthFirst, StableRandom
from blocks_planning.settings import Configured, setting

MAX_ITERATIONS = 1_000_000
MAX_WIDTH = 1_000_000
DIVISORS = ('smallest', 'mean', 'largest')
DEAD_ENDS = ('worst', 'ignored')
EXECUTIONS = ('first', 'path')


class Search(Protocol):
    """An action-level search.

    Attributes:
        is_external: whether another program searches.
        plans_on_blocks: whether problems and queries name the blocks that fill a state.
    """

    name: ClassVar[str]
    is_external: ClassVar[bool]
    plans_on_blocks: ClassVar[bool]

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """Solve a problem within a budget [states].

        Raises:
            LimitExceeded: if the search would exceed its memory limit.
        """
        ...


class Compiled(Configured):
    """Base of the searches with compiled attempts: they differ in their memory."""

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """The memory of the search for problems of a task; its type selects the compiled search.

        Args:
            task: the task.
            tables: of the task.
            most_left: most cells that are to be filled.
            growth: how often the memory was too small so far; see :mod:`.memory`.

        Raises:
            LimitExceeded: if it would be too large.
        """
        raise NotImplementedError

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`."""
        from blocks_planning.search import compiled

        return compiled.solve_one(problem, self.memory, seed, budget, cancel)


@dataclass(frozen=True)
class RandomPlacement(Compiled):
    """Uniformly drawn legal placements, until none is left. Cost 0."""

    name: ClassVar[str] = 'random'

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        return memory.at_random(tables)


@dataclass(frozen=True)
class BreadthFirst(Compiled):
    """Breadth-first lookahead of ``depth`` placements (paper, section "Action-level planning").

    It executes the first placement towards the best state seen, uniformly among equals, and
    searches again; when a complete state is taken for expansion, its whole path is executed. More
    filled cells are better. A state without a legal placement is 'worst' of all (the published
    numbers); this needs one more level beyond ``depth``, which is not counted; or such dead ends
    are 'ignored', so that the filled cells alone decide (the paper's text).
    """

    name: ClassVar[str] = 'bfs'
    depth: int = setting(
        3, 'Number of placements to look ahead.', least=1, most=MAX_DEPTH, unit='placements'
    )
    dead_ends: str = setting(
        'worst',
        'Rank of a state without a legal placement: below all others, or by filled cells.',
        choices=DEAD_ENDS,
    )

    @property
    def dead_ends_last(self) -> bool:
        """Whether a state without a legal placement ranks below all others."""
        return self.dead_ends == 'worst'

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        return memory.breadth_first(tables, self.depth, self.dead_ends_last)


def _iterations() -> Any:
    return setting(
        4096,
        'Number of iterations of one search (nodes taken from the queue).',
        least=2,
        most=MAX_ITERATIONS,
        unit='nodes',
    )


def _execute() -> Any:
    return setting('first', 'Part of an incomplete path that is executed.', choices=EXECUTIONS)


@dataclass(frozen=True)
class AStar(Compiled):
    """A* with a limited number of iterations; f = blocks placed + cells left / divisor.

    The divisor is the 'smallest' block area (the paper's text), the 'mean' (its published numbers)
    or the 'largest' (admissible). A search that did not complete executes the 'first' placement
    of its path (the paper's text) or the whole 'path' (its published numbers).

    f is a float64, as in the paper's own program, and nodes are equal if their f is. With the
    mean divisor 4.8 some values that are equal as fractions differ in the last bit, which
    affects the results.
    """

    name: ClassVar[str] = 'astar'
    iterations: int = _iterations()
    divisor: str = setting(
        'smallest',
        'Block area by which the heuristic divides the number of cells left.',
        choices=DIVISORS,
    )
    execute: str = _execute()

    def divisor_of(self, task: Task) -> float:
        """The divisor of the cells left [cells]."""
        areas = [block.area for block in task.library]
        kinds = {'smallest': min(areas), 'mean': sum(areas) / len(areas), 'largest': max(areas)}
        return float(kinds[self.divisor])

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        whole_path = self.execute == 'path'
        divisor = self.divisor_of(task)
        return memory.queue(tables, most_left, growth, self.iterations, 1, divisor, whole_path)


@dataclass(frozen=True)
class BestFirst(Compiled):
    """A* without the blocks placed: the node with the fewest cells left comes first."""

    name: ClassVar[str] = 'best_first'
    iterations: int = _iterations()
    execute: str = _execute()

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        whole_path = self.execute == 'path'
        return memory.queue(tables, most_left, growth, self.iterations, 0, 1.0, whole_path)


@dataclass(frozen=True)
class Beam(Compiled):
    """Beam search: level by level, the ``width`` states with most cells filled are kept.

    One search is an attempt. It begins with the current state. On each level it generates and
    counts every child of every state kept, in the order in which those were generated. It keeps
    the ``width`` children with most filled cells; of those that tie for the last places it keeps
    some uniformly drawn ones. Two orders of the same blocks are two states. It stops after a level
    with a complete state, or if no state kept has a legal placement. The result is the path to the
    kept state with most filled cells of all levels, uniformly among equals, and is executed whole;
    if it is not complete, no legal placement is left in it.

    Draws: on each level where not all equals can be kept, one draw for each of them in the order of
    generation, until no place is left: it is kept if a number drawn below the number of equals
    left is below the number of places left. At the end, one draw for the best state.
    """

    name: ClassVar[str] = 'beam'
    width: int = setting(
        100, 'Number of states kept on each level.', least=1, most=MAX_WIDTH, unit='states'
    )

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        return memory.kept_states(tables, most_left, growth, self.width)


@dataclass(frozen=True)
class TreeSearch(Compiled):
    """Monte Carlo tree search with upper confidence bounds (UCT; Kocsis and Szepesvari, 2006).

    Each iteration walks from the root down the tree. At a state with legal placements that are not
    in the tree, it adds a uniformly drawn one of these, and from the new state it makes uniformly
    drawn legal placements until none is left. At a state with all legal placements in the tree, it
    goes to the child with the highest W / n + exploration * sqrt(ln N / n), uniformly
    among equals: W is the sum of the rewards of the child's n visits, and N the number of visits
    of the state. At a state without a legal placement the iteration ends. The reward is the share
    of the region's cells that is filled at its end, 1 if complete, and counts for every state of
    the tree on the walk.

    After all iterations the most visited first placement is executed, uniformly among equals, and
    a new search begins, with a new tree. A complete state does not end a search: it only gives a
    reward of 1. So an attempt makes one search for every block it places.

    States evaluated are those added to the tree and those of the placements that follow, in every
    iteration. Draws: one for each choice named above, even if there is only one option.
    """

    name: ClassVar[str] = 'mcts'
    iterations: int = setting(
        1000,
        'Number of iterations of one search (walks through the tree).',
        least=1,
        most=MAX_ITERATIONS,
        unit='iterations',
    )
    exploration: float = setting(
        0.5, 'Weight of exploration in the upper confidence bound.', least=0, most=1000
    )

    def memory(self, task: Task, tables: Any, most_left: int, growth: int) -> Any:
        """See :class:`Compiled`."""
        from blocks_planning.search import memory

        return memory.tree(tables, growth, self.iterations, self.exploration)


@dataclass(frozen=True)
class Exact(Configured):
    """The fewest blocks, or proof that there is no plan. A reference, not a model of people.

    Its cost is the number of states that its dynamic program generates by placing a block.
    """

    name: ClassVar[str] = 'exact'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`Search`. The seed and the budget have no effect.

        Raises:
            LimitExceeded: if the problem is too large (see :mod:`.exact`).
        """
        from blocks_planning.search import exact

        return exact.solve_exactly(problem, cancel)


SEARCHES = Registry(
    'search',
    'blocks_planning.searches',
    (
        *(BreadthFirst, AStar, BestFirst, Beam, TreeSearch, RandomPlacement, Exact),
        *(StableBreadthFirst, StableRandom, ExternalSearch),
    ),
)


def search_names() -> tuple[str, ...]:
    """The searches that can be run in this process."""
    return tuple(name for name, cls in SEARCHES.items() if not cls.is_external)


def make_search(name: object, values: Mapping[str, object]) -> Search:
    """The search of a name with some settings; see :meth:`.Registry.make`."""
    search: Search = SEARCHES.make(name, values)
    return search


def make_own_search(name: object, values: Mapping[str, object]) -> Search:
    """A search that can be run in this process; else as :func:`make_search`."""
    refuse_external(search=(search := make_search(name, values)))
    return search
