"""A trial that is followed has the record of the same trial run by its four parts."""

from __future__ import annotations

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import solvable_tasks, tasks

from blocks_planning.board.blocks import PAPER_LIBRARY
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.result import SolveResult
from blocks_planning.search.searches import AStar, BestFirst, BreadthFirst, Exact, RandomPlacement
from blocks_planning.subgoals.decision import Query
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.regions import Rectangles
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.following import follow
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec

PLANNERS = [
    NoSubgoals(),
    *(Scoping(lam, commit) for lam in (0.0, 0.002, 0.05) for commit in ('subgoal', 'action')),
    Scoping(0.01, regions=Rectangles(), horizon=2),
    Scoping(0.01, horizon=2, max_sequences=3, choice='softmax', aggregate='softmax'),
    FullSubgoals(),
    FullSubgoals(0.001),
]
SEARCHES = [
    BreadthFirst(1),
    BreadthFirst(2),
    AStar(64),
    AStar(64, 'mean', 'path'),
    BestFirst(16),
    RandomPlacement(),
    Exact(),
]


def specs(task: Task, search: object, seed: int, budget: int) -> list[TrialSpec]:
    return [TrialSpec('tower', task, p, search, seed, budget) for p in PLANNERS]  # type: ignore[arg-type]


@settings(max_examples=60)
@given(
    task=st.one_of(tasks(4), solvable_tasks()),
    search=st.sampled_from(SEARCHES),
    seed=st.integers(0, 2**64 - 1),
    budget=st.sampled_from([0, 50, 2000]),
)
def test_record_is_that_of_the_parts(task: Task, search: object, seed: int, budget: int) -> None:
    answers: dict[Query, SolveResult] = {}  # shared: who asked first must not matter
    for spec in specs(task, search, seed, budget):
        assert follow(spec, answers).to_json() == run_trial(spec).to_json()


@pytest.mark.parametrize('tower', ['12', pytest.param('13', marks=pytest.mark.long)])
@pytest.mark.parametrize(
    'search', [BreadthFirst(2), pytest.param(AStar(256), marks=pytest.mark.long)]
)
def test_record_of_a_tower_of_the_paper(tower: str, search: object) -> None:
    [stimulus] = find_stimuli(f'cogsci2021/{tower}')
    task = Task(stimulus.board, stimulus.silhouette, PAPER_LIBRARY)
    answers: dict[Query, SolveResult] = {}
    for spec in specs(task, search, seed=5, budget=5_000):
        assert follow(spec, answers).to_json() == run_trial(spec).to_json()
