"""Searches with loose blocks: the compiled ones where nothing falls, and what they refuse."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import builders
import pytest
from oracles import statics as twin
from oracles.board import Placement as PlainPlacement
from problems import random_problem

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Placed
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, InvalidInput
from blocks_planning.search import stable
from blocks_planning.search.result import CancelToken, Problem, SolveStatus
from blocks_planning.search.searches import BreadthFirst, RandomPlacement
from blocks_planning.search.solve import solve
from blocks_planning.search.stable import StableBreadthFirst, StableRandom, solve_stable
from blocks_planning.trials.following import follow
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun
from blocks_planning.worlds.world import make_world


def nothing_falls(blocks: tuple[Placed, ...]) -> bool:
    return True


def from_scratch(source: random.Random, most_cells: int) -> Problem:
    problem = random_problem(source, most_cells=most_cells)
    return Problem(problem.task, 0, problem.region)


@pytest.mark.parametrize('depth', range(4))
def test_is_the_compiled_search_where_nothing_falls(depth: int) -> None:
    """Same placements, costs and number of attempts, for several seeds and budgets."""
    search = BreadthFirst(depth) if depth else RandomPlacement()
    source = random.Random(6)
    solved = set()
    for seed in range(15):
        problem = from_scratch(source, most_cells=8)
        for budget in (0, 40):
            expected = solve(problem, search, seed, budget)
            found = solve_stable(problem, depth, seed, budget, stays=nothing_falls)
            assert found == expected
            solved.add(found.status)
    assert SolveStatus.SOLVED in solved


def test_every_tower_on_the_way_stays_up() -> None:
    """Judged by the exact twin; the same seed without statics leads to one that falls."""
    board = Board(6, 2)
    library = (Block(6, 1), Block(3, 1), Block(2, 1))
    task = Task(board, board.parse(['######', '..##..']), library)
    problem = Problem(task, 0, task.silhouette)
    budget = 50

    def worst(found: tuple[Placed, ...]) -> set[str]:
        plain = [PlainPlacement(*block) for block in found]
        margin = Fraction(1, 50)
        lengths = range(1, len(plain) + 1)
        return {twin.stability(plain[:number], Fraction(1, 2), margin) for number in lengths}

    careless: set[str] = set()
    for seed in range(12):
        careless |= worst(solve(problem, RandomPlacement(), seed, budget).placements)
        careful = solve(problem, StableRandom(), seed, budget)
        assert careful.solved
        assert 'falls' not in worst(careful.placements)
    assert 'falls' in careless


def test_only_what_stays_up_is_generated_and_counted() -> None:
    """On a post of one cell, of the two slabs that fit only the middle one stays up."""
    board = Board(3, 2)
    task = Task(board, board.parse(['###', '.#.']), (Block(1, 1), Block(2, 1), Block(3, 1)))
    post = Placed(1, 1, 1, 0)
    problem = Problem(task, rules.cells_of(board, post), task.silhouette, (post,))
    loose = solve(problem, StableBreadthFirst(1), 0, 0)
    assert (loose.status, loose.placements) == (SolveStatus.SOLVED, (Placed(3, 1, 0, 1),))
    # 1x1 on the post, 2x1 to the left and right (both on the edge), 3x1.
    assert loose.planning_cost == 4
    strict = solve_stable(problem, 1, 0, 0, stays=lambda blocks: blocks[-1].width != 2)
    assert strict.planning_cost == 2


def test_nothing_that_stays_up_is_proof() -> None:
    board = Board(4, 2)
    task = Task(board, board.parse(['####', '#...']), (Block(4, 1),))
    post = Placed(1, 1, 0, 0)
    problem = Problem(task, rules.cells_of(board, post), task.silhouette, (post,))
    assert solve(problem, BreadthFirst(1), 0).status is SolveStatus.SOLVED
    found = solve(problem, StableBreadthFirst(1), 0)
    assert found.status is SolveStatus.UNSOLVABLE_PROVEN


def test_nothing_to_do() -> None:
    board = Board(2, 1)
    block = Placed(2, 1, 0, 0)
    problem = Problem(Task(board, 3, (Block(2, 1),)), 3, 3, (block,))
    assert solve_stable(problem, 3, 0).status is SolveStatus.SOLVED


def test_cancelled_in_the_middle() -> None:
    board = Board(6, 4)
    problem = Problem(Task(board, board.full), 0, board.full)
    cancel = CancelToken()
    asked = []

    def stays(blocks: tuple[Placed, ...]) -> bool:
        asked.append(blocks)
        if len(asked) == 5:
            cancel.cancel()
        return True

    found = solve_stable(problem, 3, 0, cancel=cancel, stays=stays)
    assert found.status is SolveStatus.CANCELLED
    assert found.placements == ()


def test_bad_input() -> None:
    board = Board(2, 2)
    task = Task(board, board.full)
    with pytest.raises(InvalidInput, match=r'blocks \[\] must fill exactly the built cells'):
        solve(Problem(task, board.ground, board.full), StableBreadthFirst(), 0)
    with pytest.raises(ConfigurationError, match='budget must be'):
        solve_stable(Problem(task, 0, board.full), 3, 0, -1)


@pytest.mark.parametrize('strategy', ['none', 'scoping', 'full'])
def test_planner_that_knows_what_falls_builds_no_tower_that_does(strategy: str) -> None:
    """With the same seeds, a planner that does not know it builds towers that fall."""
    rows, library = '######/..##../..##..', '6x1,3x1,2x1'
    loose = make_world('simulated', {'blocks': 'loose'})
    ends: dict[str, set[TrialStatus]] = {'random': set(), 'stable_random': set()}
    for name, found in ends.items():
        for seed in range(8):
            spec = builders.spec(
                rows, library=library, strategy=strategy, search=name, seed=seed, budget=50
            )
            record = run_trial(replace(spec, world=loose))
            found.add(record.status)
            assert [*contradictions(record), *differs_from_rerun(record)] == []
            assert follow(record.spec) == record
    assert ends['random'] == {TrialStatus.SUCCESS, TrialStatus.COLLAPSED}
    assert ends['stable_random'] == {TrialStatus.SUCCESS}


def test_kept_looks_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    source = random.Random(11)
    problems = [from_scratch(source, most_cells=8) for _ in range(20)]
    kept = [solve(problem, StableBreadthFirst(2), 5, 400) for problem in problems]
    assert max(result.attempts for result in kept) > 20
    monkeypatch.setattr(stable, 'MOST_LOOKS', 0)
    assert [solve(problem, StableBreadthFirst(2), 5, 400) for problem in problems] == kept
