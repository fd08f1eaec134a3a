"""Exact values of policies against walking through every attempt, and against sampling."""

from __future__ import annotations

import random
from collections import Counter
from collections.abc import Iterator
from fractions import Fraction

import numpy as np
import pytest

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.policy import ExactPolicy, analyse_policy
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import DEAD_ENDS, AStar, BreadthFirst, RandomPlacement, Search
from blocks_planning.search.solve import solve

Outcome = tuple[bool, int]  # success, cost [states]

SMALL = [
    (Board(2, 2), (Block(1, 1), Block(2, 1))),
    (Board(2, 2), (Block(1, 2), Block(2, 1))),
    (Board(3, 3), (Block(1, 2), Block(2, 1), Block(2, 2))),
    (Board(3, 2), (Block(1, 1), Block(1, 2), Block(3, 1))),
    (Board(4, 3), (Block(1, 2), Block(2, 1), Block(3, 1))),
    (Board(3, 4), (Block(1, 3), Block(2, 1), Block(1, 2))),
]


def children(task: Task, built: Mask) -> list[Mask]:
    return [
        built | rules.cells_of(task.board, placed)
        for placed in rules.legal_placements(task, built, task.silhouette)
    ]


def look_ahead(task: Task, built: Mask, search: BreadthFirst) -> tuple[int, bool, Counter[int]]:
    """Cost, whether a complete state was taken up, and votes by number of first placement."""
    level: list[tuple[Mask, int]] = [(built, -1)]
    nodes: list[tuple[int, int]] = []
    cost = 0
    for _ in range(search.depth):
        following = []
        for state, first in level:
            if state == task.silhouette:
                return cost, True, Counter()
            for number, child in enumerate(children(task, state)):
                following.append((child, number if first < 0 else first))
                cost += 1
        level = following
        nodes += [(_value(task, state, search.dead_ends), first) for state, first in level]
    best = max((value for value, _ in nodes), default=0)
    return cost, False, Counter(first for value, first in nodes if value == best)


def _value(task: Task, state: Mask, dead_ends: str) -> int:
    if state == task.silhouette or dead_ends == 'ignored':
        return area(state)
    return area(state) if children(task, state) else -1


def outcomes(task: Task, search: Search, built: Mask = 0) -> dict[Outcome, Fraction]:
    """The distribution of (success, cost) of one attempt, by walking through all of them."""
    if built == task.silhouette:
        return {(True, 0): Fraction(1)}
    legal = children(task, built)
    cost, found, votes = 0, False, Counter(range(len(legal)))
    if isinstance(search, BreadthFirst):
        cost, found, votes = look_ahead(task, built, search)
    if found or not legal:
        return {(found, cost): Fraction(1)}
    total: dict[Outcome, Fraction] = {}
    for first, weight in votes.items():
        for (success, more), chance in outcomes(task, search, legal[first]).items():
            key = success, cost + more
            total[key] = total.get(key, Fraction(0)) + chance * weight / votes.total()
    return total


def within(attempt: dict[Outcome, Fraction], budget: int, spent: int = 0) -> Fraction:
    """The probability that attempts succeed within a budget, by recursion."""
    total = Fraction(0)
    for (success, cost), chance in attempt.items():
        if success:
            total += chance
        elif spent + cost < budget:
            total += chance * within(attempt, budget, spent + cost)
    return total


def small_tasks() -> Iterator[Task]:
    source = random.Random(1)
    for board, library in SMALL:
        yield Task(board, board.full, library)
        for _ in range(8):
            built = 0
            for _ in range(5):
                possible = list(rules.possible_placements(board, built, library))
                if possible:
                    built |= rules.cells_of(board, source.choice(possible))
            yield Task(board, built, library)


@pytest.mark.parametrize(
    'search',
    [BreadthFirst(depth, dead_ends) for depth in (1, 2, 3) for dead_ends in DEAD_ENDS],
    ids=str,
)
def test_small_boards_by_enumeration(search: Search) -> None:
    uncertain = 0
    for task in small_tasks():
        problem = Problem(task, 0, task.silhouette)
        every = outcomes(task, search)
        for budget in (0, 1, 9, 40):
            found = analyse_policy(problem, search, budget)
            assert found is not None
            check(found, every)
            assert found.within_budget == pytest.approx(float(within(every, budget)), abs=1e-9)
        uncertain += any(0 < chance < 1 and won for (won, _), chance in every.items())
    assert uncertain >= 3


def test_dead_ends_that_rank_last_help_a_search_that_looks_one_placement_ahead() -> None:
    """Without them ranked so, more attempts of depth 1 fail on the 16 towers (paper, Table 1)."""
    success = {}
    for dead_ends in DEAD_ENDS:
        found = [
            analyse_policy(Problem(task, 0, task.silhouette), BreadthFirst(1, dead_ends), 0)
            for task in (Task(s.board, s.silhouette) for s in find_stimuli('cogsci2021'))
        ]
        success[dead_ends] = np.mean([one.success for one in found if one is not None])
    assert success['worst'] == pytest.approx(0.072, abs=0.0005)
    assert success['ignored'] == pytest.approx(0.065, abs=0.0005)


def test_random_on_small_boards_by_enumeration() -> None:
    for task in small_tasks():
        every = outcomes(task, RandomPlacement())
        found = analyse_policy(Problem(task, 0, task.silhouette), RandomPlacement(), 7)
        assert found is not None
        check(found, every)
        assert found.within_budget == pytest.approx(1 - (1 - found.success) ** 7)
        once = analyse_policy(Problem(task, 0, task.silhouette), RandomPlacement(), 0)
        assert once is not None
        assert once.within_budget == pytest.approx(found.success)


def check(found: ExactPolicy, every: dict[Outcome, Fraction]) -> None:
    success = sum(chance for (won, _), chance in every.items() if won)
    cost = sum(chance * cost for (_, cost), chance in every.items())
    assert found.success == pytest.approx(float(success), abs=1e-12)
    assert found.cost == pytest.approx(float(cost))
    if success:
        won_cost = sum(chance * cost for (won, cost), chance in every.items() if won)
        assert found.cost_of_success == pytest.approx(float(won_cost / success))
    else:
        assert found.cost_of_success is None


@pytest.mark.parametrize('tower', ['1', '9', '13'])
@pytest.mark.parametrize('search', [BreadthFirst(1), BreadthFirst(2), RandomPlacement()], ids=str)
def test_towers_by_sampling(tower: str, search: Search) -> None:
    [stimulus] = find_stimuli(f'cogsci2021/{tower}')
    task = Task(stimulus.board, stimulus.silhouette, PAPER_LIBRARY)
    problem = Problem(task, 0, task.silhouette)
    budget, seeds = 2_000 if isinstance(search, BreadthFirst) else 20, 1500
    found = analyse_policy(problem, search, budget)
    assert found is not None
    attempts = [solve(problem, search, seed, budget=0) for seed in range(seeds)]
    solves = [solve(problem, search, seed, budget=budget) for seed in range(seeds)]
    for share, exact in (
        (np.mean([result.solved for result in attempts]), found.success),
        (np.mean([result.solved for result in solves]), found.within_budget),
    ):
        assert abs(share - exact) <= 4 * np.sqrt(exact * (1 - exact) / seeds) + 1e-9
    costs = np.array([result.planning_cost for result in attempts], float)
    assert abs(costs.mean() - found.cost) <= 4 * costs.std() / np.sqrt(seeds) + 1e-6
    won = np.array([result.solution_cost for result in attempts if result.solved], float)
    if len(won) > 10:
        assert found.cost_of_success is not None
        error = 4 * won.std() / np.sqrt(len(won))
        assert abs(won.mean() - found.cost_of_success) <= error + 1e-6


def test_wide_board_is_as_good_as_a_narrow_one() -> None:
    """The same arch on 8 x 8 and on 16 x 16 cells, whose masks are of another kind."""
    rows = ['####', '#..#', '#..#']
    found = []
    for side in (8, 16):
        board = Board(side, side)
        picture = ['.' * side] * (side - 3) + [row + '.' * (side - 4) for row in rows]
        task = Task(board, board.parse(picture), PAPER_LIBRARY)
        problem = Problem(task, 0, task.silhouette)
        found.append(analyse_policy(problem, BreadthFirst(2), 500))
        found.append(analyse_policy(problem, RandomPlacement(), 500))
    assert found[0] == found[2]
    assert found[1] == found[3]


def test_larger_than_the_limit() -> None:
    [stimulus] = find_stimuli('cogsci2021/2')
    problem = Problem(Task(stimulus.board, stimulus.silhouette), 0, stimulus.silhouette)
    for search in (BreadthFirst(2), RandomPlacement()):
        with pytest.raises(LimitExceeded, match=r'more than the limit of 50 states .* 8 x 8'):
            analyse_policy(problem, search, limit=50)


def test_other_searches_are_refused() -> None:
    task = Task(Board(2, 2), 3)
    with pytest.raises(ConfigurationError, match=r"must be bfs or random .*, got 'astar'"):
        analyse_policy(Problem(task, 0, 3), AStar())
    with pytest.raises(ConfigurationError, match='budget must be a whole number from 0 to'):
        analyse_policy(Problem(task, 0, 3), BreadthFirst(), budget=10**9)


@pytest.mark.parametrize('search', [BreadthFirst(2), RandomPlacement()], ids=str)
def test_cancelled(search: Search) -> None:
    [stimulus] = find_stimuli('cogsci2021/2')
    problem = Problem(Task(stimulus.board, stimulus.silhouette), 0, stimulus.silhouette)
    token = CancelToken()
    token.cancel()
    assert analyse_policy(problem, search, cancel=token) is None
