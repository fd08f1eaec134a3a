"""Many solves at once: the results of solves one by one, told as they come, and ended early."""

from __future__ import annotations

import random
import threading
from collections import Counter
from dataclasses import dataclass
from typing import Any, ClassVar

import pytest
from problems import random_problem

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.search import memory
from blocks_planning.search.many import cores, solve_many
from blocks_planning.search.result import (
    MAX_BUDGET,
    CancelToken,
    Problem,
    SolveResult,
    SolveStatus,
)
from blocks_planning.search.searches import AStar, BreadthFirst, Search, make_search, search_names
from blocks_planning.search.solve import solve
from blocks_planning.settings import Configured

BUDGET = 300


def random_problems(count: int, key: object) -> list[Problem]:
    """Problems of many tasks; some are equal, some filled already, some have no placement."""
    source = random.Random(str(key))
    problems = [random_problem(source) for _ in range(count)]
    problems += [Problem(p.task, p.region, p.region) for p in problems[:3]]
    tall = Task(Board(3, 3), 0b111, (Block(1, 4),))
    problems += [Problem(tall, 0, 0b111), *problems[3:8]]
    source.shuffle(problems)
    return problems


def regions_of_one_task(side: int) -> list[Problem]:
    """Every rectangle that stands in the lower left corner of a board."""
    board = Board(side, side)
    task = Task(board, board.full)
    return [
        Problem(task, 0, board.rectangle(0, 0, width, height))
        for width in range(1, side + 1)
        for height in range(1, side + 1)
    ]


@pytest.mark.parametrize('workers', [1, 3])
@pytest.mark.parametrize('name', search_names())
def test_results_are_those_of_solves_one_by_one(name: str, workers: int) -> None:
    search = make_search(name, {})
    if search.plans_on_blocks:  # problems of other boards do not say which blocks fill them
        problems = regions_of_one_task(4)
    else:
        problems = random_problems(20, name) + regions_of_one_task(5)
    expected = [solve(problem, search, 7, BUDGET) for problem in problems]
    told: dict[int, SolveResult] = {}

    def done(index: int, result: SolveResult) -> None:
        assert index not in told
        told[index] = result

    assert solve_many(problems, search, 7, BUDGET, done=done, workers=workers) == expected
    assert told == dict(enumerate(expected))


def test_every_kind_of_ending_is_among_them() -> None:
    problems = random_problems(20, 'bfs') + regions_of_one_task(5)
    results = solve_many(problems, BreadthFirst(1), 7, BUDGET)
    assert {result.status for result in results} == {
        SolveStatus.SOLVED,
        SolveStatus.UNSOLVABLE_PROVEN,
        SolveStatus.BUDGET_EXHAUSTED,
    }


@dataclass(frozen=True)
class Counting(Configured):
    """A search that counts its problems; not compiled."""

    name: ClassVar[str] = 'counting'
    asked: ClassVar[Counter[Problem]] = Counter()

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        self.asked[problem] += 1
        return BreadthFirst(1).run(problem, seed, budget, cancel)


def test_equal_problems_are_solved_once() -> None:
    problems = regions_of_one_task(4) * 3
    Counting.asked.clear()
    results = solve_many(problems, Counting(), 0, BUDGET, workers=2)
    assert results == solve_many(problems, BreadthFirst(1), 0, BUDGET)
    # 1 x 1 has no legal placement, which is known without a search.
    assert set(Counting.asked.values()) == {1}
    assert len(Counting.asked) == 4 * 4 - 1


def test_nothing_is_done_for_no_problem() -> None:
    assert solve_many([], BreadthFirst(), 0) == []


def test_results_are_told_in_the_thread_that_asked() -> None:
    threads = set()

    def done(_index: int, _result: SolveResult) -> None:
        threads.add(threading.get_ident())

    solve_many(regions_of_one_task(4), BreadthFirst(1), 0, BUDGET, done=done, workers=2)
    assert threads == {threading.get_ident()}


@pytest.mark.parametrize('workers', [1, 2])
@pytest.mark.parametrize('search', [BreadthFirst(1), Counting()], ids=str)
def test_an_error_of_the_listener_ends_the_work(search: Search, workers: int) -> None:
    told = []

    def done(index: int, _result: SolveResult) -> None:
        told.append(index)
        raise RuntimeError('enough')

    with pytest.raises(RuntimeError, match='enough'):
        solve_many(regions_of_one_task(6), search, 0, BUDGET, done=done, workers=workers)
    assert len(told) == 1


@dataclass(frozen=True)
class Broken(Configured):
    """A search that fails."""

    name: ClassVar[str] = 'broken'

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        raise RuntimeError('broken search')


@pytest.mark.parametrize('workers', [1, 2])
def test_an_error_of_a_search_is_raised(workers: int) -> None:
    with pytest.raises(RuntimeError, match='broken search'):
        solve_many(regions_of_one_task(4), Broken(), 0, BUDGET, workers=workers)


@pytest.mark.parametrize('workers', [1, 2])
def test_what_is_not_solved_when_it_is_cancelled_is_cancelled(workers: int) -> None:
    """Single cells fill any rectangle; an odd number of cells takes dominoes for ever."""
    board = Board(8, 8)
    task = Task(board, board.full, (Block(1, 2), Block(2, 1)))
    endless = [
        Problem(task, 0, board.rectangle(0, 0, width, height))
        for width in (5, 7)
        for height in (5, 7)
    ]
    easy = Problem(task, 0, board.rectangle(0, 0, 1, 2))
    nothing = Problem(task, 0, 0)
    cancel = CancelToken()
    solve(easy, BreadthFirst(2), 0, 0)  # compiles it
    timer = threading.Timer(0.2, cancel.cancel)
    timer.start()
    results = solve_many(
        [*endless, nothing], BreadthFirst(2), 0, MAX_BUDGET, cancel, workers=workers
    )
    timer.join()
    assert [result.status for result in results[:-1]] == [SolveStatus.CANCELLED] * 4
    assert results[-1].status is SolveStatus.SOLVED
    assert solve_many([easy], BreadthFirst(2), 0, MAX_BUDGET, cancel)[0] == SolveResult(
        SolveStatus.CANCELLED
    )


def test_a_search_that_outgrows_its_memory_says_so_for_that_problem_only(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(memory, '_MOST_NODES_AT_FIRST', 300)
    monkeypatch.setattr(memory, 'MAX_NODES', 5_000)
    board = Board(9, 9)
    task = Task(board, board.full, (Block(1, 2), Block(2, 1)))
    problems = [Problem(task, 0, board.rectangle(0, 0, 9, height)) for height in range(1, 10)]
    search = AStar(5_000, 'largest', 'path')
    expected = [solve(problem, search, 1, 0) for problem in problems]
    assert {r.status for r in expected} >= {SolveStatus.SOLVED, SolveStatus.LIMIT_EXCEEDED}
    assert solve_many(problems, search, 1, 0, workers=2) == expected


@pytest.mark.parametrize(
    ('settings', 'message'),
    [
        ({'seed': -1}, 'seed must be a whole number from 0'),
        ({'budget': -1}, 'budget must be a whole number from 0'),
        ({'workers': 0}, 'workers must be a whole number from 1'),
    ],
)
def test_bad_numbers_are_refused(settings: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        solve_many([], BreadthFirst(), **{'seed': 0, **settings})


def test_there_is_a_core() -> None:
    assert cores() >= 1
