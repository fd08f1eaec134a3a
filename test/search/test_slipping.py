"""Success where blocks slip, against exact fractions, known values and simulation."""

from __future__ import annotations

import random
from fractions import Fraction
from functools import cache

import numpy as np
import pytest
from oracles.slipping import bfs_success, optimum, random_success
from oracles.tree import Task as PlainTask
from problems import random_problem

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block
from blocks_planning.board.geometry import Board, area
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search import reachable
from blocks_planning.search import slipping as subject
from blocks_planning.search.exact import analyse
from blocks_planning.search.landing import draw_landing
from blocks_planning.search.policy import analyse_policy
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import BreadthFirst, RandomPlacement
from blocks_planning.search.slipping import analyse_slips, optimal_policy, optimal_success

SLIPS = (Fraction(0), Fraction(1, 16), Fraction(1, 2), Fraction(1))


def tower(number: int) -> Problem:
    [stimulus] = find_stimuli(f'cogsci2021/{number}')
    task = Task(stimulus.board, stimulus.silhouette)
    return Problem(task, 0, task.silhouette)


def plain(problem: Problem) -> tuple[PlainTask, frozenset[tuple[int, int]]]:
    board = problem.task.board
    region, built = (frozenset(board.cells(mask)) for mask in (problem.region, problem.built))
    library = tuple((block.width, block.height) for block in problem.task.library)
    return PlainTask(board.width, board.height, library, region), built


def agrees(problem: Problem, depth: int) -> None:
    found = analyse_slips(problem, [float(slip) for slip in SLIPS], BreadthFirst(depth))
    assert found is not None
    task, built = plain(problem)
    for slip, chances in zip(SLIPS, found, strict=True):
        assert chances.optimum == pytest.approx(float(optimum(task, built, slip)), abs=1e-12)
        expected = float(random_success(task, built, slip))
        assert chances.random == pytest.approx(expected, abs=1e-12)
        expected = float(bfs_success(task, built, slip, depth))
        assert chances.bfs == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize('depth', [1, 2, 3])
def test_twin_on_small_boards(depth: int) -> None:
    """Narrow and wide boards, whose masks differ; some begin in the middle."""
    source = random.Random(depth)
    compared = 0
    while compared < 12:
        problem = random_problem(source, most_cells=7)
        if area(problem.region & ~problem.built) not in range(1, 7):
            continue
        agrees(problem, depth)
        compared += 1


@pytest.mark.parametrize('number', [1, 12])
def test_twin_on_the_last_cells_of_a_tower(number: int) -> None:
    problem = tower(number)
    answer = analyse(problem.task)
    assert answer is not None
    assert answer.placements is not None
    board = problem.task.board
    states = rules.states_along(board, 0, answer.placements)
    built = next(state for state in states if area(problem.region & ~state) <= 6)
    agrees(Problem(problem.task, built, problem.region), 2)


def test_slip_can_help_a_search_that_always_fails() -> None:
    """Depth 1 takes the largest block, under which a cell stays empty unless it slips."""
    board = Board(4, 2)
    task = Task(board, board.parse(['####', '####']), (Block(1, 1), Block(2, 2), Block(3, 1)))
    agrees(Problem(task, 0, task.silhouette), 1)
    agrees(Problem(task, 0, task.silhouette), 2)


@pytest.mark.parametrize('number', [1, 12, 13, 16])
def test_without_slips_it_is_the_exact_policy(number: int) -> None:
    problem = tower(number)
    found = analyse_slips(problem, [0.0])
    assert found is not None
    assert found[0].optimum == 1.0
    for search, success in (
        (BreadthFirst(), found[0].bfs),
        (RandomPlacement(), found[0].random),
    ):
        known = analyse_policy(problem, search)
        assert known is not None
        assert success == pytest.approx(known.success, abs=1e-12)


def test_optimum_is_1_exactly_where_it_can_be_built() -> None:
    source = random.Random(8)
    buildable = set()
    for _ in range(120):
        problem = random_problem(source, most_cells=16)
        task = Task(problem.task.board, problem.region, problem.task.library)
        if not task.silhouette:
            continue
        found, answer = optimal_success(Problem(task, 0, task.silhouette), 0.0), analyse(task)
        assert found is not None
        assert answer is not None
        assert found.success == float(answer.fewest_blocks is not None)
        buildable.add(found.success)
    assert buildable == {0.0, 1.0}


@pytest.mark.parametrize('number', [12, 13, 15])
def test_nothing_beats_the_optimum_and_slips_cost_it(number: int) -> None:
    slips = [0.0, 0.01, 0.02, 0.05, 0.1, 0.2]
    found = analyse_slips(tower(number), slips)
    assert found is not None
    assert [chances.slip for chances in found] == slips
    best = [chances.optimum for chances in found]
    assert best == sorted(best, reverse=True)
    for chances in found:
        assert chances.optimum >= max(chances.bfs, chances.random)


@pytest.mark.parametrize(('number', 'slip'), [(12, 0.05), (13, 0.2), (15, 0.1)])
def test_simulation_of_the_best_policy_meets_its_value(number: int, slip: float) -> None:
    """Worlds that draw as trials do, 4 standard errors wide; losses change nothing."""
    problem = tower(number)
    board, seeds = problem.task.board, 1000
    policy = optimal_policy(problem, slip)
    assert policy is not None
    order_in = cache(policy.order)
    wins = 0
    for seed in range(seeds):
        built, sequence = 0, 0
        while (order := order_in(built)) is not None:
            sequence += 1
            landed = draw_landing(board, built, order.placement, slip, 0.2, seed, sequence).placed
            if landed is not None:
                built |= rules.cells_of(board, landed)
        wins += built == problem.region
    value = policy.success(0)
    assert 0.1 < value < 0.99
    assert abs(wins / seeds - value) <= 4 * np.sqrt(value * (1 - value) / seeds)


def test_policy_outside_of_what_can_be_built() -> None:
    problem = tower(13)
    board = problem.task.board
    policy = optimal_policy(problem, 0.1)
    assert policy is not None
    assert policy.states == optimal_success(problem, 0.1).states  # type: ignore[union-attr]
    for built in (board.full & ~problem.region, board.full, problem.region & ~board.ground):
        assert policy.success(built) == 0.0
    assert policy.order(board.full & ~problem.region) is None
    assert policy.success(problem.region) == 1.0
    assert policy.order(problem.region) is None


def test_room_grows_with_the_states(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = tower(12)
    expected = analyse_slips(problem, [0.0, 0.1])
    monkeypatch.setattr(reachable, '_STATES_AT_FIRST', 1)
    monkeypatch.setattr(reachable, '_STATES_PER_STEP', 77)
    monkeypatch.setattr(subject, '_ENTRIES_AT_FIRST', 1)
    monkeypatch.setattr(subject, '_ORDER_PER_STEP', 77)
    assert analyse_slips(problem, [0.0, 0.1]) == expected


def test_limit_on_states() -> None:
    problem = tower(12)
    found = optimal_success(problem, 0.1)
    assert found is not None
    assert optimal_success(problem, 0.1, limit=found.states) == found
    with pytest.raises(LimitExceeded, match=r'more than the limit of \d+ states .* 8 x 8 cells'):
        optimal_success(problem, 0.1, limit=found.states - 1)
    with pytest.raises(LimitExceeded, match='more than the limit of 10 states'):
        analyse_slips(problem, [0.1], limit=10)


@pytest.mark.parametrize('stage', ['states', 'optimum', 'plans', 'bfs'])
def test_cancelled_at_any_stage(stage: str) -> None:
    cancel = CancelToken()
    seen = []

    def report(now: str, done: int, known: int) -> None:
        assert 0 <= done <= known
        seen.append(now)
        if now == stage:
            cancel.cancel()

    assert analyse_slips(tower(13), [0.1], cancel=cancel, report=report) is None
    assert seen[-1] == stage


def test_cancelled_before_it_began() -> None:
    cancel = CancelToken()
    cancel.cancel()
    assert optimal_success(tower(13), 0.1, cancel=cancel) is None
    assert optimal_policy(tower(13), 0.1, cancel=cancel) is None


@pytest.mark.parametrize('slip', [-0.1, 1.5, float('nan')])
def test_slip_out_of_range(slip: float) -> None:
    with pytest.raises(ConfigurationError, match='slip must be a number from 0 to 1'):
        optimal_success(tower(13), slip)
    with pytest.raises(ConfigurationError, match='slip must be a number from 0 to 1'):
        analyse_slips(tower(13), [0.1, slip])


def test_nothing_to_do_and_nothing_to_be_done() -> None:
    board = Board(3, 3)
    whole = Task(board, board.parse(['...', '.##', '.##']), PAPER_LIBRARY)
    done = optimal_success(Problem(whole, whole.silhouette, whole.silhouette), 0.5)
    assert done is not None
    assert (done.success, done.states) == (1.0, 1)
    dead = Problem(whole, board.parse(['...', '.#.', '...']), whole.silhouette)
    found = analyse_slips(dead, [0.5])
    assert found is not None
    assert (found[0].optimum, found[0].bfs, found[0].random) == (0, 0, 0)
    assert found[0].states == 0
