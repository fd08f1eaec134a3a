"""The subgoal planners against their slow twins: whole trials, every cost and candidate."""

from __future__ import annotations

import random
from typing import Any

import pytest
from oracles import decisions
from oracles import planners as oracle
from problems import random_problem

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.decision import Candidate, Decision
from blocks_planning.subgoals.registry import make_strategy, planner_names
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec

STRATEGIES: list[tuple[str, dict[str, Any]]] = [
    ('none', {}),
    *[
        ('scoping', {'lambda': lam, 'commit': commit})
        for lam in (0.0, 0.05, 1.5)
        for commit in ('subgoal', 'action')
    ],
    ('full', {'lambda': 0.01}),
    ('full', {'lambda': 1.0}),
]
SEARCHES: list[tuple[str, dict[str, Any]]] = [
    ('random', {}),
    ('bfs', {'depth': 1}),
    ('bfs', {'depth': 2}),
    ('astar', {'iterations': 12}),
    ('best_first', {'iterations': 5, 'execute': 'path'}),
]


def _heights(candidate: Candidate) -> tuple[int, ...]:
    """The heights of regions that are rows."""
    assert all(region.label.kind == 'rows' for region in candidate.regions)
    return tuple(region.label.numbers[0] for region in candidate.regions)


def _decision(decision: Decision, board: Board) -> tuple[Any, ...]:
    """A decision as the twin writes it."""
    candidates = [
        (
            _heights(candidate),
            candidate.cells,
            candidate.planning_cost,
            candidate.value,
            candidate.status.value,
        )
        for candidate in decision.candidates
    ]
    chosen = None if decision.chosen is None else _heights(decision.candidates[decision.chosen])
    return frozenset(board.cells(decision.built)), candidates, chosen


def _twin_decision(decision: decisions.Decision) -> tuple[Any, ...]:
    def heights(k: int | tuple[int, ...] | None) -> tuple[int, ...] | None:
        return (k,) if isinstance(k, int) else k

    candidates = [(heights(c.k), c.cells, c.cost, c.value, c.status) for c in decision.candidates]
    return decision.built, candidates, heights(decision.chosen)


def _twin_trial(spec: TrialSpec, strategy: str, settings: dict[str, Any]) -> decisions.Trial:
    task, search = spec.task, spec.to_json()
    names = {'lambda': 'lam'}
    trial: decisions.Trial = getattr(oracle, strategy)(
        task.board.width,
        task.board.height,
        frozenset(task.board.cells(task.silhouette)),
        [(block.width, block.height) for block in task.library],
        *(() if strategy == 'full' else (frozenset(),)),
        spec.seed,
        search=search['search'],
        budget=spec.budget,
        **search['search_settings'],
        **{names.get(key, key): value for key, value in settings.items()},
    )
    return trial


def test_every_strategy_that_decides_has_a_twin() -> None:
    assert {name for name, _ in STRATEGIES} == set(planner_names())


@pytest.mark.parametrize('search', SEARCHES, ids=lambda search: search[0])
@pytest.mark.parametrize(
    'strategy', STRATEGIES, ids=lambda item: '-'.join(map(str, [item[0], *item[1].values()]))
)
def test_a_trial_is_that_of_the_slow_twin(
    strategy: tuple[str, dict[str, Any]], search: tuple[str, dict[str, Any]]
) -> None:
    source = random.Random(f'{strategy}{search}')
    for _ in range(8):
        task: Task = random_problem(source, widest=4, highest=5).task
        if task.board.size > 20 and strategy[0] == 'full':
            continue
        spec = TrialSpec(
            'random',
            task,
            make_strategy(*strategy),
            make_search(*search),
            seed=source.getrandbits(64),
            budget=source.choice([0, 20, 100]),
        )
        record, twin = run_trial(spec), _twin_trial(spec, *strategy)
        assert record.status.value == twin.status
        assert [tuple(placed) for placed in record.placements] == [
            tuple(placed) for placed in twin.placements
        ]
        assert [_decision(entry.decision, task.board) for entry in record.decisions] == [
            _twin_decision(decision) for decision in twin.decisions
        ]
        costs = ['blocks', 'subgoals', 'solution_cost']
        costs += ['action_planning_cost', 'subgoal_planning_cost']
        assert {cost: getattr(record, cost) for cost in costs} == {
            cost: getattr(twin, cost) for cost in costs
        }
