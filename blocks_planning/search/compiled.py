"""Converts problems to arguments of the kernels, and their output to results."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Library, Placed
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.kernels.masks import pack
from blocks_planning.board.kernels.moves import Tables, footprints_of, make_tables
from blocks_planning.board.task import Task
from blocks_planning.errors import BlocksPlanningError, LimitExceeded
from blocks_planning.search.kernels import breadth_first, lookahead
from blocks_planning.search.kernels.attempts import Conditions
from blocks_planning.search.kernels.batch import Batch, solve_batch
from blocks_planning.search.kernels.outcomes import (
    CANCELLED,
    COMPLETE,
    NO_PLACEMENT,
    NOT_ASKED,
    OUT_OF_MEMORY,
    SOLVED_ALREADY,
    STUCK,
)
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus

_STATUS = {
    COMPLETE: SolveStatus.SOLVED,
    STUCK: SolveStatus.BUDGET_EXHAUSTED,
    CANCELLED: SolveStatus.CANCELLED,
    SOLVED_ALREADY: SolveStatus.SOLVED,
    NO_PLACEMENT: SolveStatus.UNSOLVABLE_PROVEN,
}
_MASK_BYTES = 32

MakeMemory = Callable[[Task, Tables, int, int], Any]
"""The memory of a search: of (task, its tables, most cells to fill, growth); see :mod:`.memory`."""

tables_of = lru_cache(maxsize=4096)(make_tables)
"""The tables of (task, region), made once."""


class Solver:
    """Solves problems of one task with one search, seed and budget; for one thread."""

    def __init__(
        self,
        task: Task,
        make_memory: MakeMemory,
        most_left: int,
        seed: int,
        budget: int,
        cancel: CancelToken,
    ) -> None:
        """A solver.

        Args:
            task: of every problem.
            make_memory: the memory of the search.
            most_left: most cells that are to be filled in a problem.
            seed: of the trial.
            budget: b [states].
            cancel: ends a solve from another thread.
        """
        self._task, self._make, self._most_left = task, make_memory, most_left
        self._footprints = footprints_of(task.board, task.library)
        nowhere = tables_of(task, 0)
        self._tables: Tables = nowhere._replace(legal=nowhere.legal.copy())
        self._most_placements = most_left // int(nowhere.area.min())
        seed_words = np.zeros(9, np.uint64)
        seed_words[0] = seed
        self._conditions = Conditions(
            seed_words=seed_words,
            budget=budget,
            generator=np.zeros(1, np.uint64),
            cancel=cancel.flag,
            path=np.zeros(task.board.size, np.int64),
        )
        self._growth = 0
        self._memory = make_memory(task, self._tables, most_left, 0)

    def run(self, problems: Sequence[Problem], stop: np.ndarray) -> list[SolveResult | None]:
        """Solve problems without the GIL.

        Args:
            problems: of the task.
            stop: uint8 (1,); if it is not 0, no further problem is started.

        Returns:
            Their results; None for problems that were not started.
        """
        batch = self._batch(problems, stop)
        self._solve(batch)
        return [
            self._answer(batch, index, problem, outcome)
            for index, (problem, outcome) in enumerate(
                zip(problems, batch.outcome.tolist(), strict=True)
            )
        ]

    def run_one(self, problem: Problem) -> SolveResult:
        """Solve a problem; repeat with more memory if the search had too little.

        Raises:
            LimitExceeded: if it would exceed its memory limit.
        """
        while True:
            batch = self._batch([problem], np.zeros(1, np.uint8))
            self._solve(batch)
            if batch.outcome[0] != OUT_OF_MEMORY:
                return _result(batch, 0, problem)
            growth = self._growth + 1
            self._memory = self._make(self._task, self._tables, self._most_left, growth)
            self._growth = growth

    def _answer(
        self, batch: Batch, index: int, problem: Problem, outcome: int
    ) -> SolveResult | None:
        if outcome == NOT_ASKED:
            return None
        if outcome != OUT_OF_MEMORY:
            return _result(batch, index, problem)
        try:
            return self.run_one(problem)
        except LimitExceeded:
            return SolveResult(SolveStatus.LIMIT_EXCEEDED, attempts=1)

    def _batch(self, problems: Sequence[Problem], stop: np.ndarray) -> Batch:
        cells, number = self._tables.cells, len(problems)
        masks = b''.join(
            mask.to_bytes(_MASK_BYTES, 'little')
            for problem in problems
            for mask in (problem.built, problem.region)
        )
        words = np.frombuffer(masks, '<u8').astype(np.uint64).reshape(number, 8)
        wide = cells > 64
        return Batch(
            built=np.ascontiguousarray(words[:, :4] if wide else words[:, 0]),
            region=np.ascontiguousarray(words[:, 4:] if wide else words[:, 4]),
            seed_words=words,
            steps=self._task.board.height,
            stop=stop,
            outcome=np.full(number, NOT_ASKED, np.int64),
            length=np.zeros(number, np.int64),
            path=np.zeros((number, self._most_placements), np.int64),
            solution_cost=np.zeros(number, np.int64),
            planning_cost=np.zeros(number, np.int64),
            attempts=np.zeros(number, np.int64),
        )

    def _solve(self, batch: Batch) -> None:
        solve_batch(self._memory, self._tables, self._footprints.mask, batch, self._conditions)


def _result(batch: Batch, index: int, problem: Problem) -> SolveResult:
    status = _STATUS[int(batch.outcome[index])]
    solved = status is SolveStatus.SOLVED
    was_tried = solved or status is SolveStatus.BUDGET_EXHAUSTED
    path = batch.path[index, : batch.length[index]].tolist() if was_tried else []
    placements = placements_of(problem, path)
    return SolveResult(
        status=status,
        placements=placements if solved else (),
        last_attempt=() if solved else placements,
        solution_cost=int(batch.solution_cost[index]) if solved else 0,
        planning_cost=int(batch.planning_cost[index]),
        attempts=int(batch.attempts[index]),
    )


def solve_one(
    problem: Problem, make_memory: MakeMemory, seed: int, budget: int, cancel: CancelToken
) -> SolveResult:
    """Solve a problem with a compiled search.

    Raises:
        LimitExceeded: if the search would exceed its memory limit.
    """
    left = area(problem.region) - area(problem.built)
    return Solver(problem.task, make_memory, left, seed, budget, cancel).run_one(problem)


class _Step(NamedTuple):
    """A move as a placement; masks."""

    placed: Placed
    cells: Mask
    below: Mask  # the cells just below it; 0 on the ground
    shadow: Mask


class _Steps:
    """The moves of a library on a board, cached."""

    def __init__(self, board: Board, library: Library) -> None:
        self._board, self._library = board, library
        self._known: dict[int, _Step] = {}

    def __getitem__(self, move: int) -> _Step:
        if move not in self._known:
            self._known[move] = self._find(move)
        return self._known[move]

    def _find(self, move: int) -> _Step:
        board = self._board
        block, bit = divmod(move, board.size)
        size, (column, row) = self._library[block], board.cell(bit)
        placed = Placed(*size, column, row)
        cells = rules.cells_of(board, placed)
        below = board.rectangle(column, row - 1, size.width, 1) if row > 0 else 0
        return _Step(placed, cells, below, rules.shadow(board, cells))


_steps_of = lru_cache(maxsize=64)(_Steps)


def placements_of(problem: Problem, moves: list[int]) -> tuple[Placed, ...]:
    """The placements of some moves (see :class:`Tables`), each checked against the rules.

    Raises:
        BlocksPlanningError: if a move is not legal, which indicates a defect of a kernel.
    """
    if not moves:
        return ()
    task = problem.task
    steps = _steps_of(task.board, task.library)
    shadow, outside = rules.shadow(task.board, problem.built), ~problem.region
    placements = []
    for move in moves:
        step = steps[move]
        rests = not step.below or step.below & shadow
        if step.cells & (shadow | outside) or not rests:
            raise BlocksPlanningError(f'a search proposed {step.placed}, which is not legal')
        placements.append(step.placed)
        shadow |= step.shadow
    return tuple(placements)


def count_nodes(
    task: Task, depth: int, cancel: CancelToken, counts: np.ndarray | None = None
) -> list[int] | None:
    """Tree nodes at depths 1 to n, summed, for n = 1 to ``depth``; None if cancelled.

    A breadth-first search from the empty board evaluates that many states if it finds no solution.

    Args:
        task: silhouette and blocks.
        depth: n, 1 or more.
        cancel: ends it from another thread.
        counts: int64 (depth,), all 0: each number is written there as soon as it is known, even
            if the count is cancelled later.
    """
    nowhere = tables_of(task, task.silhouette)._replace(target=-1)
    counts = np.zeros(depth, np.int64) if counts is None else counts
    search = lookahead.make_search(nowhere, depth + 1)
    empty = pack([0], nowhere.cells)
    finished = breadth_first.count_from(search, nowhere, empty, cancel.flag, counts)
    return counts.tolist() if finished else None
