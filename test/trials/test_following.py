"""A trial that is followed has the record of the same trial run by its four parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

import builders
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import solvable_tasks, tasks

from blocks_planning.board.blocks import PAPER_LIBRARY, Placed
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.searches import AStar, BestFirst, BreadthFirst, Exact, RandomPlacement
from blocks_planning.search.stable import StableBreadthFirst
from blocks_planning.settings import setting
from blocks_planning.subgoals.decision import Chain, Situation
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.regions import Rectangles
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.following import Shared, follow
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

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
    StableBreadthFirst(1),
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
    shared = Shared()  # who asked first must not matter
    for spec in specs(task, search, seed, budget):
        assert follow(spec, shared).to_json() == run_trial(spec).to_json()


@pytest.mark.parametrize('tower', ['12', pytest.param('13', marks=pytest.mark.long)])
@pytest.mark.parametrize(
    'search', [BreadthFirst(2), pytest.param(AStar(256), marks=pytest.mark.long)]
)
def test_record_of_a_tower_of_the_paper(tower: str, search: object) -> None:
    [stimulus] = find_stimuli(f'cogsci2021/{tower}')
    task = Task(stimulus.board, stimulus.silhouette, PAPER_LIBRARY)
    shared = Shared()
    for spec in specs(task, search, seed=5, budget=5_000):
        assert follow(spec, shared).to_json() == run_trial(spec).to_json()


@dataclass(frozen=True)
class Choosy(Scoping):
    """Scoping that leaves out its first regions."""

    name: ClassVar[str] = 'choosy'
    skipped: int = setting(1, 'Number of regions that are left out.')

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """All but the first ones, or the last one."""
        return super().chains(situation)[self.skipped :] or super().chains(situation)[-1:]


def test_planners_that_differ_in_their_chains_share_answers_alone() -> None:
    [stimulus] = find_stimuli('cogsci2021/13')
    task = Task(stimulus.board, stimulus.silhouette, PAPER_LIBRARY)
    shared, considered = Shared(), set()
    for planner in (Scoping(), Choosy(), Choosy(skipped=2), Scoping(aim='most')):
        spec = TrialSpec('tower', task, planner, BreadthFirst(1))
        record = follow(spec, shared)
        assert record == follow(spec)
        considered.add(len(record.decisions[0].decision.candidates))
    assert len(considered) == 3


def test_same_cells_of_other_blocks_are_weighed_anew() -> None:
    """A block at the edge falls from two short blocks, and stands on a long one."""
    task = builders.task('#.../####/.##.', library='1x1,2x1,4x1')
    middle = Placed(2, 1, 1, 0)
    short = (middle, Placed(2, 1, 0, 1), Placed(2, 1, 2, 1))
    long = (middle, Placed(4, 1, 0, 1))
    search = StableBreadthFirst(1)
    specs = [TrialSpec('tower', task, Scoping(), search, built=blocks) for blocks in (short, long)]
    shared = Shared()
    records = [follow(spec, shared) for spec in specs]
    assert records == [follow(spec) for spec in specs]
    assert [record.status for record in records] == [TrialStatus.GAVE_UP, TrialStatus.SUCCESS]
