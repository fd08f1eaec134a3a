"""Searches that never plan a tower that falls: ``stable_bfs`` and ``stable_random``.

They generate only stable children (:mod:`blocks_planning.board.statics`), and are otherwise equal
to ``bfs`` and ``random``, draw for draw: if no child falls, they give the same placements at the
same cost. Here a state is a set of placed blocks, not of cells, because two towers with the
same cells can differ in stability; so states are not merged. Kernels cannot call a linear program,
therefore this module is Python. It evaluates thousands of states per second, whereas the compiled
searches evaluate tens of millions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.statics import holds
from blocks_planning.errors import InvalidInput
from blocks_planning.search.randomness import MAX_SEED, Generator, mask_words
from blocks_planning.search.result import (
    DEFAULT_BUDGET,
    MAX_BUDGET,
    MAX_DEPTH,
    CancelToken,
    Problem,
    SolveResult,
    SolveStatus,
)
from blocks_planning.settings import Configured, check_whole, setting

Stays = Callable[[tuple[Placed, ...]], bool]
"""Decides whether a tower of these blocks is stable."""
Path = tuple[Placed, ...]

_DEAD_END = -1
MOST_LOOKS = 1024
"""Most states of a problem for which the outcome of looking ahead is kept."""


class _Cancelled(Exception):
    """The token was cancelled."""


class _Tower(NamedTuple):
    """A state: the filled cells, and the blocks that fill them."""

    built: Mask
    blocks: Path


class _Node(NamedTuple):
    """A node of a search tree: its state, and the placements that led there."""

    tower: _Tower
    path: Path


class _Choice(NamedTuple):
    """The next step of a search: placements (none if it is stuck), and states evaluated."""

    path: Path
    evaluated: int


class _Look(NamedTuple):
    """What looking ahead from a state gives: the steps to draw from, and states evaluated."""

    steps: tuple[Path, ...]
    evaluated: int


@dataclass(frozen=True)
class StableBreadthFirst(Configured):
    """Breadth-first lookahead that generates only towers of loose blocks that do not fall.

    Where no child falls, it gives the placements and the cost of bfs.
    """

    name: ClassVar[str] = 'stable_bfs'
    plans_on_blocks: ClassVar[bool] = True
    depth: int = setting(
        3, 'Number of placements to look ahead.', least=1, most=MAX_DEPTH, unit='placements'
    )

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`.searches.Search`."""
        return solve_stable(problem, self.depth, seed, budget, cancel)


@dataclass(frozen=True)
class StableRandom(Configured):
    """Uniformly drawn placements after which a tower of loose blocks does not fall. Cost 0.

    Where nothing falls, it gives the placements of random.
    """

    name: ClassVar[str] = 'stable_random'
    plans_on_blocks: ClassVar[bool] = True

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`.searches.Search`."""
        return solve_stable(problem, 0, seed, budget, cancel)


def solve_stable(
    problem: Problem,
    depth: int,
    seed: int,
    budget: int = DEFAULT_BUDGET,
    cancel: CancelToken | None = None,
    stays: Stays = holds,
) -> SolveResult:
    """Fill a region by placements that keep the tower stable.

    Attempts, budget and costs are those of :func:`.solve.solve`; only stable states are generated,
    and so evaluated.

    Args:
        problem: state, the blocks that fill it, and region.
        depth: number of placements to look ahead; 0 draws each placement.
        seed: of the trial, 0 to 2**64 - 1.
        budget: b [states], 0 to 2**63 - 1.
        cancel: ends the solve from another thread.
        stays: decides which towers are stable.

    Raises:
        ConfigurationError: if the seed or the budget is out of its range, or if statics needs
            scipy and it is not installed.
        InvalidInput: if the problem's blocks do not fill exactly its built cells.
    """
    check_whole('seed', seed, 0, MAX_SEED)
    check_whole('budget', budget, 0, MAX_BUDGET)
    blocks, board = problem.blocks, problem.task.board
    if sum(rules.cells_of(board, block) for block in blocks) != problem.built:
        raise InvalidInput(
            f'blocks {[tuple(block) for block in blocks]} must fill exactly the built cells '
            f'{problem.built:#x}'
        )
    finder = _Finder(problem, depth, stays, cancel or CancelToken())
    start = _Tower(problem.built, blocks)
    if start.built == problem.region:
        return SolveResult(SolveStatus.SOLVED)
    try:
        if not finder.has_child(start):
            return SolveResult(SolveStatus.UNSOLVABLE_PROVEN)
    except _Cancelled:
        return SolveResult(SolveStatus.CANCELLED)
    return _attempts(finder, start, seed, budget)


def _attempts(finder: _Finder, start: _Tower, seed: int, budget: int) -> SolveResult:
    """Attempt after attempt until one succeeds or the budget is reached."""
    words = [*mask_words(start.built), *mask_words(finder.problem.region)]
    total = number = 0
    while True:
        generator = Generator([seed, *words, number])
        try:
            complete, path, cost = finder.attempt(start, generator)
        except _Cancelled:
            cost = finder.evaluated
            return SolveResult(SolveStatus.CANCELLED, planning_cost=cost, attempts=number)
        total += cost
        number += 1
        if complete:
            return SolveResult(SolveStatus.SOLVED, path, cost, total, number)
        if total >= budget or number >= budget:
            return SolveResult(SolveStatus.BUDGET_EXHAUSTED, (), 0, total, number, path)


class _Finder:
    """Looks ahead in one problem; ``evaluated`` counts the states of all attempts."""

    def __init__(
        self,
        problem: Problem,
        depth: int,
        stays: Stays,
        cancel: CancelToken,
    ) -> None:
        self.problem = problem
        self.evaluated = 0
        self._depth = depth
        self._stays = stays
        self._cancel = cancel
        self._looks: dict[Path, _Look] = {}

    def attempt(self, tower: _Tower, generator: Generator) -> tuple[bool, Path, int]:
        """One attempt: whether it filled the region, its placements, and states evaluated."""
        path: Path = ()
        cost = 0
        while tower.built != self.problem.region:
            choice = self._choose(tower, generator)
            cost += choice.evaluated
            if not choice.path:
                return False, path, cost
            for placed in choice.path:
                tower = self._placed(tower, placed)
            path += choice.path
        return True, path, cost

    def has_child(self, tower: _Tower) -> bool:
        """Whether a legal placement is left that keeps the tower stable."""
        return next(self._children(tower), None) is not None

    def _choose(self, tower: _Tower, generator: Generator) -> _Choice:
        if self._depth:
            return self._look_ahead(tower, generator)
        legal = [placed for placed, _ in self._children(tower)]
        return _Choice((legal[generator.below(len(legal))],) if legal else (), 0)

    def _look_ahead(self, tower: _Tower, generator: Generator) -> _Choice:
        """Breadth-first lookahead, as in the compiled search.

        A later attempt that comes to the same state only draws among what was found there.
        """
        look = self._looks.get(tower.blocks)
        if look is None:
            look = self._look(tower)
            if len(self._looks) < MOST_LOOKS:
                self._looks[tower.blocks] = look
        else:
            self.evaluated += look.evaluated
        steps = look.steps
        return _Choice(steps[generator.below(len(steps))] if steps else (), look.evaluated)

    def _look(self, tower: _Tower) -> _Look:
        level = [_Node(tower, ())]
        seen: list[_Node] = []
        for _ in range(self._depth):
            following: list[_Node] = []
            for node in level:
                if node.tower.built == self.problem.region:
                    return _Look((node.path,), len(seen) + len(following))
                for placed, child in self._children(node.tower):
                    following.append(_Node(child, (*node.path, placed)))
                    self.evaluated += 1
            seen += following
            level = following
        values = [self._value(node.tower) for node in seen]
        best = max(values, default=0)
        winners = (node for node, value in zip(seen, values, strict=True) if value == best)
        return _Look(tuple(node.path[:1] for node in winners), len(seen))

    def _value(self, tower: _Tower) -> int:
        """The value: complete is best, a dead end worst, otherwise the number of cells."""
        if tower.built == self.problem.region:
            return self.problem.task.board.size + 1
        return area(tower.built) if self.has_child(tower) else _DEAD_END

    def _children(self, tower: _Tower) -> Iterator[tuple[Placed, _Tower]]:
        """The legal placements that keep the tower stable, in order of generation."""
        if self._cancel.cancelled:
            raise _Cancelled
        task = self.problem.task
        for placed in rules.legal_placements(task, tower.built, self.problem.region):
            child = self._placed(tower, placed)
            if self._stays(child.blocks):
                yield placed, child

    def _placed(self, tower: _Tower, placed: Placed) -> _Tower:
        cells = rules.cells_of(self.problem.task.board, placed)
        return _Tower(tower.built | cells, (*tower.blocks, placed))
