"""Slow trials without subgoals and with all sequences of them, and trials of all planners."""

from __future__ import annotations

import random
from collections.abc import Callable
from typing import Any

import pytest
from oracles import decisions, planners
from oracles.board import EMPTY, legal_placements, place, read_picture
from oracles.randomness import attempt_generator, subgoal_generator
from small_boards import DOMINOES, LYING, STANDING, STEP, full_board, random_board

# Planners: no subgoals.


def test_none_plans_the_whole() -> None:
    # 2 x 2 with lying blocks: one child, then one.
    trial = planners.none(2, 2, full_board(2, 2), LYING, search='bfs', depth=1)
    assert trial.status == 'success'
    assert trial.placements == ((2, 1, 0, 0), (2, 1, 0, 1))
    assert (trial.blocks, trial.subgoals) == (2, 1)
    assert trial.action_planning_cost == trial.solution_cost == 2
    assert trial.subgoal_planning_cost == 0
    assert trial.decisions == (
        decisions.Decision(EMPTY, (decisions.Candidate(2, 4, 2, None, 'solved'),), 2),
    )


def test_none_carries_out_its_last_attempt() -> None:
    # The step with dominoes: standing or lying, both dead ends: 2 + 2 >= 3.
    width, height, step = read_picture(STEP)
    trial = planners.none(width, height, step, DOMINOES, search='bfs', depth=1, budget=3)
    assert trial.status == 'stuck'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (1, 1, 4)
    (decision,) = trial.decisions
    assert decision.candidates == (decisions.Candidate(2, 3, 4, None, 'budget_exhausted'),)
    assert decision.chosen == 2


@pytest.mark.parametrize('planner', [planners.none, planners.scoping, planners.full])
def test_trials_that_are_over_before_they_begin(planner: Callable[..., decisions.Trial]) -> None:
    settings = {} if planner is planners.none else {'lam': 1.0}
    trial = planner(2, 2, EMPTY, LYING, search='random', **settings)
    assert trial == decisions.Trial('success', (), 0, 0, 0, 0, 0, ())
    floating = frozenset({(0, 1), (1, 1)})
    trial = planner(2, 2, floating, LYING, search='random', **settings)
    assert trial == decisions.Trial('stuck', (), 0, 0, 0, 0, 0, ())


# Planners: full.


def test_sequences_are_all_that_end_in_the_whole() -> None:
    assert planners.sequences_of([1, 2, 5]) == [(1, 2, 5), (1, 5), (2, 5), (5,)]
    assert planners.sequences_of([3]) == [(3,)]
    assert len(planners.sequences_of(range(1, 9))) == 128


def test_full_counts_every_subgoal_of_every_sequence() -> None:
    # (1, 2): 1 + 1. (2): 2. V = 4 - 2 lambda for both: a tie.
    seen = set()
    for seed in range(20):
        trial = planners.full(2, 2, full_board(2, 2), LYING, seed, search='bfs', depth=1)
        assert trial.status == 'success'
        assert trial.placements == ((2, 1, 0, 0), (2, 1, 0, 1))
        assert trial.action_planning_cost == trial.solution_cost == 2
        assert trial.subgoal_planning_cost == 2 + 2
        (decision,) = trial.decisions
        assert decision.candidates == (
            decisions.Candidate((1, 2), 4, 2, 2.0, 'solved'),
            decisions.Candidate((2,), 4, 2, 2.0, 'solved'),
        )
        expected = [(1, 2), (2,)][subgoal_generator(seed, EMPTY, 2).below(2)]
        assert decision.chosen == expected
        assert trial.subgoals == len(expected)
        seen.add(expected)
    assert len(seen) == 2


def test_full_stops_along_a_sequence_at_the_first_unsolved_subgoal() -> None:
    # 2 x 4 with standing blocks: an odd number of rows cannot be filled.
    # rows(1): nothing legal, 0. rows(2) from nothing: 2 + 1. rows(4) from rows(2): 3 again.
    # rows(3) from rows(2): nothing legal, 0. rows(3) from nothing: 2 + 1, then it is stuck, and
    # the budget of 3 is reached. rows(4) from nothing: 2; 2; then, if the first two blocks are
    # in one column, the other is left, 1, else 2; 1.
    chosen = set()
    for seed in range(20):
        trial = planners.full(
            2, 4, full_board(2, 4), STANDING, seed, search='bfs', depth=1, lam=0.5, budget=3
        )
        draws = attempt_generator(seed, EMPTY, full_board(2, 4), 4, 0)
        whole = 6 if draws.below(2) == draws.below(2) else 7
        proven, exhausted = 'unsolvable_proven', 'budget_exhausted'
        (decision,) = trial.decisions
        assert decision.candidates == (
            decisions.Candidate((1, 2, 3, 4), 8, 0, None, proven),
            decisions.Candidate((1, 2, 4), 8, 0, None, proven),
            decisions.Candidate((1, 3, 4), 8, 0, None, proven),
            decisions.Candidate((1, 4), 8, 0, None, proven),
            decisions.Candidate((2, 3, 4), 8, 3, None, proven),
            decisions.Candidate((2, 4), 8, 6, 8 - 0.5 * 6, 'solved'),
            decisions.Candidate((3, 4), 8, 3, None, exhausted),
            decisions.Candidate((4,), 8, whole, 8 - 0.5 * whole, 'solved'),
        )
        tie = subgoal_generator(seed, EMPTY, 4).below(2)
        assert decision.chosen == ((2, 4) if whole == 7 else [(2, 4), (4,)][tie])
        assert trial.subgoal_planning_cost == 3 + 6 + 3 + whole
        assert trial.action_planning_cost == (6 if decision.chosen == (2, 4) else whole)
        assert (trial.blocks, trial.subgoals) == (4, len(decision.chosen))
        chosen.add((whole, decision.chosen))
    assert chosen == {(7, (2, 4)), (6, (2, 4)), (6, (4,))}


def test_full_gives_up() -> None:
    # The step with dominoes: (1, 2): 1, then nothing legal; (2): fails twice for 2.
    width, height, step = read_picture(STEP)
    trial = planners.full(width, height, step, DOMINOES, search='bfs', depth=1, budget=3)
    assert trial.status == 'gave_up'
    assert (trial.blocks, trial.subgoals, trial.action_planning_cost) == (0, 0, 0)
    assert trial.subgoal_planning_cost == 1 + 4
    assert trial.decisions[0].candidates == (
        decisions.Candidate((1, 2), 3, 1, None, 'unsolvable_proven'),
        decisions.Candidate((2,), 3, 4, None, 'budget_exhausted'),
    )


# All planners.


def test_trials_can_be_replayed() -> None:
    rng = random.Random(1893)
    statuses = set()
    for seed in range(150):
        width, height, library, silhouette, _ = random_board(rng)
        searches: list[dict[str, Any]] = [
            {'search': 'random'},
            {'search': 'bfs', 'depth': 2},
            {'search': 'astar', 'iterations': 4},
            {'search': 'best_first', 'iterations': 4},
        ]
        settings = {**rng.choice(searches), 'budget': 8}
        board = width, height, silhouette, library
        for trial in (
            planners.none(*board, EMPTY, seed, **settings),
            planners.scoping(*board, EMPTY, seed, lam=0.1, **settings),
            planners.scoping(*board, EMPTY, seed, lam=0.1, commit='action', **settings),
            planners.full(*board, seed, **settings),
        ):
            state = EMPTY
            for placement in trial.placements:
                assert placement in legal_placements(width, height, library, silhouette, state)
                state = place(state, [placement])
            assert (trial.status == 'success') == (state == silhouette)
            assert trial.blocks == len(trial.placements)
            statuses.add(trial.status)
    assert statuses == {'success', 'stuck', 'gave_up'}
