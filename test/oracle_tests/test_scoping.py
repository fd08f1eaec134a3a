"""Slow scoping against numbers worked out in the comments."""

from __future__ import annotations

from typing import Any

import pytest
from oracles import decisions, planners
from oracles.board import EMPTY, read_picture, rows
from oracles.randomness import subgoal_generator
from small_boards import DOMINOES, LYING, STANDING, STEP, full_board


def test_region_heights_skip_what_adds_nothing() -> None:
    # Ground row empty: rows(1) is what is built. Row 3 empty: rows(4) is rows(3).
    picture = read_picture('# . # # .')[2]
    assert decisions.region_heights(picture, 5, EMPTY) == [2, 3, 5]
    assert decisions.region_heights(picture, 5, rows(picture, 2)) == [3, 5]
    # Rows 1 and 2 are partly built: rows(1) does not contain that, rows(2) equals it.
    square = full_board(2, 3)
    assert decisions.region_heights(square, 3, frozenset({(0, 0)})) == [1, 2, 3]
    assert decisions.region_heights(square, 3, frozenset({(0, 0), (0, 1)})) == [2, 3]
    assert decisions.region_heights(square, 3, square) == []


def scope_square(lam: float, seed: int = 0, **settings: Any) -> decisions.Trial:
    return planners.scoping(
        2, 2, full_board(2, 2), LYING, EMPTY, seed, search='bfs', depth=1, lam=lam, **settings
    )


def test_scoping_weighs_cells_against_cost() -> None:
    # rows(1): 2 cells for 1; rows(2): 4 cells for 2. lambda 1: V = 1 and 2.
    trial = scope_square(1.0)
    assert trial.status == 'success'
    assert (trial.blocks, trial.subgoals) == (2, 1)
    assert trial.action_planning_cost == trial.solution_cost == 2
    assert trial.subgoal_planning_cost == 1 + 2
    (decision,) = trial.decisions
    assert decision.candidates == (
        decisions.Candidate(1, 2, 1, 1.0, 'solved'),
        decisions.Candidate(2, 4, 2, 2.0, 'solved'),
    )
    assert decision.chosen == 2


def test_scoping_takes_small_steps_when_planning_is_dear() -> None:
    # lambda 3: V = -1 and -2: rows(1); then rows(2): 2 cells for 1.
    trial = scope_square(3.0)
    assert trial.status == 'success'
    assert (trial.blocks, trial.subgoals) == (2, 2)
    assert trial.action_planning_cost == trial.solution_cost == 1 + 1
    assert trial.subgoal_planning_cost == (1 + 2) + 1
    assert [decision.chosen for decision in trial.decisions] == [1, 2]
    assert trial.decisions[1].built == {(0, 0), (1, 0)}
    assert trial.decisions[1].candidates == (decisions.Candidate(2, 2, 1, -1.0, 'solved'),)


def test_scoping_breaks_ties_with_its_own_generator() -> None:
    # lambda 2: V = 0 and 0.
    seen = set()
    for seed in range(20):
        chosen = scope_square(2.0, seed).decisions[0].chosen
        assert chosen == [1, 2][subgoal_generator(seed, EMPTY, 2).below(2)]
        seen.add(chosen)
    assert seen == {1, 2}


def test_scoping_that_commits_to_actions_scopes_after_each() -> None:
    # lambda 1: rows(2) is chosen for 2 (rows(1) costs 1), its first block placed; then for 1.
    trial = scope_square(1.0, commit='action')
    assert trial.status == 'success'
    assert [decision.chosen for decision in trial.decisions] == [2, 2]
    assert (trial.blocks, trial.subgoals) == (2, 2)
    assert trial.action_planning_cost == trial.solution_cost == 2 + 1
    assert trial.subgoal_planning_cost == (1 + 2) + 1


def test_scoping_gets_stuck() -> None:
    # The step with dominoes: rows(1) is one lying block for 1; rows(2) fails twice for 2. On the
    # lying block nothing fits.
    width, height, step = read_picture(STEP)
    trial = planners.scoping(
        width, height, step, DOMINOES, search='bfs', depth=1, lam=0.0, budget=3
    )
    assert trial.status == 'stuck'
    assert trial.placements == ((2, 1, 0, 0),)
    assert (trial.subgoals, trial.action_planning_cost, trial.solution_cost) == (1, 1, 1)
    assert trial.subgoal_planning_cost == 1 + 4
    assert trial.decisions[0].candidates == (
        decisions.Candidate(1, 2, 1, 2.0, 'solved'),
        decisions.Candidate(2, 3, 4, None, 'budget_exhausted'),
    )


def test_scoping_gives_up() -> None:
    # The step with standing blocks: rows(1) has nothing legal; rows(2) fails three times for 1.
    width, height, step = read_picture(STEP)
    trial = planners.scoping(
        width, height, step, STANDING, search='bfs', depth=1, lam=0.0, budget=3
    )
    assert trial.status == 'gave_up'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (0, 0, 0)
    assert trial.subgoal_planning_cost == 0 + 3
    (decision,) = trial.decisions
    assert decision.chosen is None
    assert decision.candidates == (
        decisions.Candidate(1, 2, 0, None, 'unsolvable_proven'),
        decisions.Candidate(2, 3, 3, None, 'budget_exhausted'),
    )


def test_scoping_goes_on_from_what_is_built() -> None:
    built = frozenset({(0, 0), (1, 0)})
    trial = planners.scoping(2, 2, full_board(2, 2), LYING, built, search='bfs', depth=1, lam=0.0)
    assert trial.placements == ((2, 1, 0, 1),)
    assert trial.decisions[0].candidates == (decisions.Candidate(2, 2, 1, 2.0, 'solved'),)


def test_scoping_knows_its_commit_modes() -> None:
    with pytest.raises(ValueError, match='commit'):
        scope_square(1.0, commit='plan')
