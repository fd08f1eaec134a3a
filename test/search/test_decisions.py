"""Decisions that bfs keeps for later attempts: the results are those of looking each time."""

from __future__ import annotations

import random

import pytest
from problems import random_problem

from blocks_planning.search.kernels import decisions
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.search.solve import solve

BUDGET = 3000


def problems() -> list[Problem]:
    source = random.Random('decisions')
    return [random_problem(source, 6, 6) for _ in range(60)]


def results(search: BreadthFirst) -> list[SolveResult]:
    return [solve(problem, search, 3, BUDGET) for problem in problems()]


@pytest.mark.parametrize('depth', [1, 2, 3])
def test_room_for_decisions_changes_nothing(monkeypatch: pytest.MonkeyPatch, depth: int) -> None:
    with_room = results(BreadthFirst(depth))
    assert max(result.attempts for result in with_room) > 100
    for most, choices in ((1, 0), (2, 1), (8, 0), (8, 1), (64, 2)):
        with monkeypatch.context() as patch:
            patch.setattr(decisions, '_MOST', most)
            patch.setattr(decisions, '_CHOICES', choices)
            assert results(BreadthFirst(depth)) == with_room
