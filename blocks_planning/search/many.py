"""Many solves at once: equal ones are shared, and all cores are used.

A decision that weighs hundreds of regions, or sequences of them, needs many solves, and each is a
pure function of its problem, search, seed and budget. So equal problems are solved once, and the
others are distributed in portions to threads. A thread solves a portion in one compiled call
without the GIL. Searches that are not compiled (``exact``, plug-ins) solve problem by problem in
the same threads.
"""

from __future__ import annotations

import os
import queue
import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing

import numpy as np

from blocks_planning.board.geometry import area
from blocks_planning.board.task import Task
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.result import (
    DEFAULT_BUDGET,
    MAX_BUDGET,
    CancelToken,
    Problem,
    SolveResult,
)
from blocks_planning.search.searches import Compiled, Search
from blocks_planning.search.solve import solve
from blocks_planning.settings import check_whole

Done = Callable[[int, SolveResult], None]
"""Called in the caller's thread with each new result and the index of its problem."""

_LARGEST_PORTION = 64
_PORTIONS_PER_WORKER = 8
"""If several threads share the work, or a caller watches it."""


def solve_many(
    problems: Sequence[Problem],
    search: Search,
    seed: int,
    budget: int = DEFAULT_BUDGET,
    cancel: CancelToken | None = None,
    done: Done | None = None,
    workers: int | None = None,
) -> list[SolveResult]:
    """Solve problems; the results are those of :func:`.solve.solve`, one by one.

    Args:
        problems: of any tasks; equal ones are solved once.
        search: the action-level search of each attempt.
        seed: of the trial, 0 to 2**64 - 1.
        budget: b of each problem [states], 0 to 2**63 - 1.
        cancel: ends it from another thread within 0.1 s; problems that are not solved by then
            are ``cancelled``.
        done: called with every result when it is known. An exception that it raises ends the work
            and is passed on.
        workers: number of threads; by default the number of cores for this process. With 1, the
            caller's thread does all the work.

    Returns:
        The results in the order of the problems.

    Raises:
        ConfigurationError: if the seed, the budget or the workers are out of their range.
    """
    check_whole('seed', seed, 0, MAX_SEED)
    check_whole('budget', budget, 0, MAX_BUDGET)
    number = cores() if workers is None else workers
    check_whole('workers', number, 1, 4096)
    places: dict[Problem, list[int]] = {}
    for index, problem in enumerate(problems):
        places.setdefault(problem, []).append(index)
    work = _Work(
        list(places), search, seed, budget, cancel or CancelToken(), number, done is not None
    )
    results: dict[int, SolveResult] = {}
    with closing(work.results()) as solved:
        for problem, result in solved:
            for index in places[problem]:
                results[index] = result
                if done is not None:
                    done(index, result)
    return [results[index] for index in range(len(problems))]


def cores() -> int:
    """Number of cores that this process may use."""
    if hasattr(os, 'sched_getaffinity'):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


Solved = list[tuple[Problem, SolveResult]]


class _Work:
    """Different problems, and how they are solved."""

    def __init__(
        self,
        problems: list[Problem],
        search: Search,
        seed: int,
        budget: int,
        cancel: CancelToken,
        workers: int,
        in_sight: bool,
    ) -> None:
        self._search, self._seed, self._budget = search, seed, budget
        self._cancel = cancel
        self._stop = np.zeros(1, np.uint8)
        self._lock = threading.Lock()
        parts = _PORTIONS_PER_WORKER * workers if in_sight or workers > 1 else 1
        portions = [portion for mine in _by_task(problems) for portion in _portions(mine, parts)]
        self._portions = iter(portions)
        self._most_left: dict[Task, int] = {}
        for portion in portions:
            self._most_left.setdefault(portion[0].task, _left(portion[0]))
        self._workers = min(workers, len(portions))

    def results(self) -> Generator[tuple[Problem, SolveResult]]:
        """Every problem with its result, in any order; leaving early stops the threads."""
        if self._workers <= 1:
            for portion in self._solve_portions():
                yield from portion
            return
        finished: queue.SimpleQueue[Solved | None] = queue.SimpleQueue()
        with ThreadPoolExecutor(self._workers, 'solve') as pool:
            threads = [pool.submit(self._hand_over, finished) for _ in range(self._workers)]
            try:
                for _ in threads:
                    while (solved := finished.get()) is not None:
                        yield from solved
            finally:
                self._stop[0] = 1
        for thread in threads:
            thread.result()

    def _hand_over(self, finished: queue.SimpleQueue[Solved | None]) -> None:
        """Solve portions in a thread until none is left; report the end, even after an error."""
        try:
            for solved in self._solve_portions():
                finished.put(solved)
        except BaseException:
            self._stop[0] = 1
            raise
        finally:
            finished.put(None)

    def _solve_portions(self) -> Iterator[Solved]:
        """Take one portion after the other, and solve it."""
        solvers: dict[Task, Callable[[list[Problem]], Solved]] = {}
        while (portion := self._take()) is not None:
            task = portion[0].task
            if task not in solvers:
                solvers[task] = self._solver_of(task)
            yield solvers[task](portion)

    def _take(self) -> list[Problem] | None:
        with self._lock:
            return None if self._stop[0] else next(self._portions, None)

    def _solver_of(self, task: Task) -> Callable[[list[Problem]], Solved]:
        """The function that solves problems of a task in one thread."""
        if not isinstance(self._search, Compiled):
            return self._solve_one_by_one
        from blocks_planning.search.compiled import Solver

        solver = Solver(
            task,
            self._search.memory,
            self._most_left[task],
            self._seed,
            self._budget,
            self._cancel,
        )

        def run(portion: list[Problem]) -> Solved:
            results = solver.run(portion, self._stop)
            return [
                (problem, result)
                for problem, result in zip(portion, results, strict=True)
                if result is not None
            ]

        return run

    def _solve_one_by_one(self, portion: list[Problem]) -> Solved:
        return [
            (problem, solve(problem, self._search, self._seed, self._budget, self._cancel))
            for problem in portion
            if not self._stop[0]
        ]


def _left(problem: Problem) -> int:
    """Number of cells to fill."""
    return area(problem.region) - area(problem.built)


def _by_task(problems: Sequence[Problem]) -> list[list[Problem]]:
    """The problems of each task, those with most cells to fill first.

    They take longest, and at the end would keep only one thread busy.
    """
    groups: dict[Task, list[Problem]] = {}
    for problem in problems:
        groups.setdefault(problem.task, []).append(problem)
    return [sorted(group, key=_left, reverse=True) for group in groups.values()]


def _portions(problems: list[Problem], wanted: int) -> Iterator[list[Problem]]:
    """At least as many parts of a list as wanted, if it is long enough, and none too large."""
    size = min(-(-len(problems) // wanted), _LARGEST_PORTION)
    for start in range(0, len(problems), size):
        yield problems[start : start + size]
