"""From a problem to the kernels' arguments, and back to a result."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.kernels.masks import pack, words_of
from blocks_planning.board.kernels.moves import Tables, make_tables
from blocks_planning.board.task import Task
from blocks_planning.errors import BlocksPlanningError, LimitExceeded
from blocks_planning.search.kernels import best_first, breadth_first, lookahead, random_placement
from blocks_planning.search.kernels.attempts import Question, run_attempts
from blocks_planning.search.kernels.outcomes import CANCELLED, COMPLETE, OUT_OF_MEMORY, STUCK
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus

_STATUS = {
    COMPLETE: SolveStatus.SOLVED,
    STUCK: SolveStatus.BUDGET_EXHAUSTED,
    CANCELLED: SolveStatus.CANCELLED,
}

_NODES_PER_ITERATION = 64
_MOST_NODES_AT_FIRST = 1 << 20
MAX_NODES = 1 << 27
"""Most places in the queue of a best-first search, 8 bytes each."""

tables_of = lru_cache(maxsize=4096)(make_tables)
"""The tables of (task, region), made once."""


def solve_at_random(problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
    """Solve by random placements."""
    tables = tables_of(problem.task, problem.region)
    return _solve(random_placement.make_search(tables), tables, problem, seed, budget, cancel)


def solve_breadth_first(
    problem: Problem,
    depth: int,
    dead_ends_last: bool,
    seed: int,
    budget: int,
    cancel: CancelToken,
) -> SolveResult:
    """Solve by breadth-first lookahead of ``depth`` placements."""
    tables = tables_of(problem.task, problem.region)
    search = lookahead.make_search(tables, depth, dead_ends_last)
    return _solve(search, tables, problem, seed, budget, cancel)


def solve_best_first(
    problem: Problem,
    iterations: int,
    g_weight: int,
    divisor: float,
    whole_path: bool,
    seed: int,
    budget: int,
    cancel: CancelToken,
) -> SolveResult:
    """Solve by A* or best-first search: f = g_weight * blocks placed + cells left / divisor."""
    tables = tables_of(problem.task, problem.region)
    most_left = tables.target - area(problem.built)
    most_blocks = most_left // int(tables.area.min()) + 1
    search = best_first.make_search(
        tables,
        iterations,
        _buckets(most_blocks, most_left, g_weight, divisor),
        whole_path,
        nodes=min(_NODES_PER_ITERATION * iterations, _MOST_NODES_AT_FIRST),
    )
    return _solve(search, tables, problem, seed, budget, cancel)


@lru_cache(maxsize=4096)
def _buckets(most_blocks: int, most_left: int, g_weight: int, divisor: float) -> np.ndarray:
    """The rank of f, from 0, by blocks placed and cells left: int64 (blocks + 1, left + 1).

    f is the float64 that the formula gives. Values that are equal as fractions can differ in
    their last bit, and then are not equal.
    """
    placed, left = np.indices((most_blocks + 1, most_left + 1))
    f = g_weight * placed + left / divisor
    _, rank = np.unique(f, return_inverse=True)
    return rank.reshape(f.shape).astype(np.int64)


def _solve(
    search: Any, tables: Tables, problem: Problem, seed: int, budget: int, cancel: CancelToken
) -> SolveResult:
    path = np.zeros(tables.cells, np.int64)
    question = Question(
        shadow=pack([rules.shadow(problem.task.board, problem.built)], tables.cells),
        filled=area(problem.built),
        seed_words=_seed_words(seed, problem),
        budget=budget,
        generator=np.zeros(1, np.uint64),
        cancel=cancel.flag,
        path=path,
    )
    while (answer := run_attempts(search, tables, question))[0] == OUT_OF_MEMORY:
        search = search._replace(arena=_larger(search.arena))
    outcome, length, solution_cost, planning_cost, attempts = answer
    solved = outcome == COMPLETE
    return SolveResult(
        status=_STATUS[outcome],
        placements=placements_of(problem, path[:length].tolist()) if solved else (),
        solution_cost=solution_cost if solved else 0,
        planning_cost=planning_cost,
        attempts=attempts,
    )


def _larger(arena: np.ndarray) -> np.ndarray:
    """Room for more nodes in the queue of a search."""
    if 4 * arena.size > MAX_NODES:
        raise LimitExceeded(
            f'the queue of the search outgrows {arena.size} nodes; allow fewer iterations'
        )
    return np.empty(4 * arena.size, np.int64)


def _seed_words(seed: int, problem: Problem) -> np.ndarray:
    masks = words_of([problem.built, problem.region])
    return np.concatenate([np.array([seed], np.uint64), masks.ravel()])


def placements_of(problem: Problem, moves: list[int]) -> tuple[Placed, ...]:
    """The placements of some moves (see :class:`Tables`), replayed through the rules.

    Raises:
        BlocksPlanningError: if a move is not legal, which would be a defect of a kernel.
    """
    task = problem.task
    built: Mask = problem.built
    placements = []
    for move in moves:
        block, bit = divmod(move, task.board.size)
        size, (column, row) = task.library[block], task.board.cell(bit)
        placed = Placed(*size, column, row)
        cells = rules.cells_of(task.board, placed)
        if rules.drop(task.board, built, placed.placement) != placed or cells & ~problem.region:
            raise BlocksPlanningError(f'a search proposed {placed}, which is not legal')
        placements.append(placed)
        built |= cells
    return tuple(placements)


def count_states(
    task: Task, depth: int, cancel: CancelToken, counts: np.ndarray | None = None
) -> list[int] | None:
    """Tree nodes at depths 1 to n, summed, for n = 1 to ``depth``; None if cancelled.

    It is what a breadth-first search from the empty board evaluates when nothing is found.

    Args:
        task: silhouette and blocks.
        depth: n, 1 or more.
        cancel: ends it from another thread.
        counts: int64 (depth,), all 0: each number is written there as soon as it is known, also
            if the count is cancelled later.
    """
    nowhere = tables_of(task, task.silhouette)._replace(target=-1)
    counts = np.zeros(depth, np.int64) if counts is None else counts
    search = lookahead.make_search(nowhere, depth + 1)
    empty = pack([0], nowhere.cells)
    finished = breadth_first.count_from(search, nowhere, empty, cancel.flag, counts)
    return counts.tolist() if finished else None


def warm_up() -> None:
    """Have every kernel for boards of up to 64 cells compiled, or loaded from the cache."""
    board = Board(2, 2)
    problem = Problem(Task(board, board.full), 0, board.full)
    cancel = CancelToken()
    solve_at_random(problem, 0, 0, cancel)
    solve_breadth_first(problem, 2, True, 0, 0, cancel)
    solve_best_first(problem, 4, 1, 2.0, False, 0, 0, cancel)
    count_states(problem.task, 2, cancel)
