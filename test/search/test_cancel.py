"""Searches that would take hours end soon after they are told to."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

import pytest

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_nodes
from blocks_planning.search.exact import analyse
from blocks_planning.search.result import (
    MAX_BUDGET,
    MAX_DEPTH,
    CancelToken,
    Problem,
    SolveResult,
    SolveStatus,
)
from blocks_planning.search.searches import (
    MAX_ITERATIONS,
    Search,
    make_search,
    search_names,
)
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, Solve
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

DEADLINE_S = 30
UNDER_WAY_S = 0.05

SEARCHES = {
    'bfs': make_search('bfs', {'depth': 12}),
    'bfs, as deep as it may': make_search('bfs', {'depth': MAX_DEPTH}),
    'astar': make_search('astar', {'iterations': MAX_ITERATIONS}),
    'astar, many': make_search('astar', {'iterations': 50, 'execute': 'path', 'divisor': 'mean'}),
    'best_first': make_search('best_first', {'iterations': MAX_ITERATIONS}),
    'beam': make_search('beam', {'width': 5000}),
    'beam, many': make_search('beam', {'width': 1}),
    'mcts': make_search('mcts', {'iterations': MAX_ITERATIONS}),
    'mcts, many': make_search('mcts', {'iterations': 1}),
    'random': make_search('random', {}),
    'stable_bfs': make_search('stable_bfs', {'depth': 12}),
    'stable_random': make_search('stable_random', {}),
}


def test_every_search_is_cancelled_here() -> None:
    assert {search.name for search in SEARCHES.values()} | {'exact'} >= set(search_names())


def odd_board(side: int) -> Task:
    """All of a board but one cell: no blocks of even areas fill it, and there are many ways."""
    board = Board(side, side)
    return Task(board, board.full ^ 1 << board.size - 1)


SMALL, LARGE = odd_board(8), odd_board(16)


@dataclass
class Announced:
    """A search that says when it is begun."""

    search: Search
    begun: threading.Event
    name: ClassVar[str] = 'announced'
    is_external: ClassVar[bool] = False
    plans_on_blocks: ClassVar[bool] = False

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        self.begun.set()
        return self.search.run(problem, seed, budget, cancel)


def others_cpu_s() -> float:
    """CPU time of all threads of this process but this one."""
    return time.process_time() - time.thread_time()


def cancelled(work: Callable[[CancelToken, threading.Event], Any]) -> Any:
    """What some work returns that is cancelled after it has begun, and spent some time on it.

    It may work in threads of its own: the time is that of the process without this thread.
    """
    cancel, begun = CancelToken(), threading.Event()
    results: list[Any] = []
    thread = threading.Thread(target=lambda: results.append(work(cancel, begun)), daemon=True)
    thread.start()
    assert begun.wait(DEADLINE_S)
    enough = others_cpu_s() + UNDER_WAY_S
    deadline = time.monotonic() + DEADLINE_S
    while others_cpu_s() < enough:
        assert thread.is_alive(), 'it was over before it could be cancelled'
        assert time.monotonic() < deadline
    cancel.cancel()
    thread.join(DEADLINE_S)
    assert not thread.is_alive(), 'it goes on'
    [result] = results
    return result


@pytest.mark.parametrize('task', [SMALL, LARGE], ids=['8x8', '16x16'])
@pytest.mark.parametrize('name', SEARCHES)
def test_solve_is_cancelled_while_it_runs(name: str, task: Task) -> None:
    problem = Problem(task, 0, task.silhouette)
    corner = Problem(task, 0, task.board.rectangle(0, 0, 2, 2))
    solve(corner, SEARCHES[name], 0, 0)  # compiles it

    def work(cancel: CancelToken, begun: threading.Event) -> SolveResult:
        search = Announced(SEARCHES[name], begun)
        return solve(problem, search, seed=1, budget=MAX_BUDGET, cancel=cancel)

    result = cancelled(work)
    assert result.status is SolveStatus.CANCELLED
    assert (result.placements, result.solution_cost) == ((), 0)
    assert not result.solved


def test_proof_is_cancelled_while_it_is_sought() -> None:
    solve(Problem(LARGE, 0, LARGE.board.rectangle(0, 0, 2, 2)), make_search('exact', {}), 0)

    def work(cancel: CancelToken, begun: threading.Event) -> SolveResult:
        search = Announced(make_search('exact', {}), begun)
        return solve(Problem(LARGE, 0, LARGE.silhouette), search, seed=1, cancel=cancel)

    assert cancelled(work).status is SolveStatus.CANCELLED


def test_analysis_is_cancelled() -> None:
    analyse(Task(LARGE.board, LARGE.board.rectangle(0, 0, 2, 2)))

    def work(cancel: CancelToken, begun: threading.Event) -> object:
        begun.set()
        return analyse(LARGE, cancel)

    assert cancelled(work) is None


@pytest.mark.parametrize('task', [SMALL, LARGE], ids=['8x8', '16x16'])
def test_counting_is_cancelled(task: Task) -> None:
    assert count_nodes(task, 2, CancelToken()) is not None

    def work(cancel: CancelToken, begun: threading.Event) -> list[int] | None:
        begun.set()
        return count_nodes(task, 20, cancel)

    assert cancelled(work) is None


@pytest.mark.parametrize('name', [*SEARCHES, 'exact'])
def test_solve_that_is_cancelled_before_it_begins_ends_at_once(name: str) -> None:
    search = SEARCHES.get(name) or make_search(name, {})
    cancel = CancelToken()
    cancel.cancel()
    for task in (SMALL, LARGE):
        problem = Problem(task, 0, task.silhouette)
        result = solve(problem, search, seed=1, budget=MAX_BUDGET, cancel=cancel)
        assert result.status is SolveStatus.CANCELLED
        assert result.placements == ()
    assert count_nodes(LARGE, 20, cancel) is None
    assert analyse(LARGE, cancel) is None


def test_token_says_whether_it_was_used() -> None:
    cancel, other = CancelToken(), CancelToken()
    cancel.cancel()
    cancel.cancel()
    assert (cancel.cancelled, other.cancelled) == (True, False)


def test_nothing_to_search_is_an_answer_even_if_cancelled() -> None:
    cancel = CancelToken()
    cancel.cancel()
    done = Problem(SMALL, 0, 0)
    assert solve(done, SEARCHES['bfs'], 0, cancel=cancel) == SolveResult(SolveStatus.SOLVED)


STRATEGIES = ('none', 'scoping', 'full')


@pytest.mark.parametrize('strategy', STRATEGIES)
def test_trial_is_cancelled_while_it_searches(strategy: str) -> None:
    solve(Problem(SMALL, 0, SMALL.rows(1)), SEARCHES['bfs'], 0, 0)  # compiles it
    search = SEARCHES['bfs']
    trial = TrialSpec('odd', SMALL, make_strategy(strategy, {}), search, budget=MAX_BUDGET)

    def work(cancel: CancelToken, begun: threading.Event) -> object:
        def observe(message: Message) -> None:
            if isinstance(message, Solve):
                begun.set()

        return run_trial(trial, cancel, observe)

    record = cancelled(work)
    assert record.spec == trial
    assert record.status is TrialStatus.CANCELLED
    assert record.placements == ()
    assert list(contradictions(record)) == []


@pytest.mark.parametrize('strategy', STRATEGIES)
def test_trial_that_is_cancelled_before_it_begins_has_a_record(strategy: str) -> None:
    cancel = CancelToken()
    cancel.cancel()
    trial = TrialSpec('odd', SMALL, make_strategy(strategy, {}), SEARCHES['bfs'])
    record = run_trial(trial, cancel)
    assert record.status is TrialStatus.CANCELLED
    assert (record.placements, record.decisions) == ((), ())
    assert list(contradictions(record)) == []
