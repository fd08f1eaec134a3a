"""What holds for every trial of every planner on any board."""

from __future__ import annotations

import json
from typing import Any

from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import solvable_tasks, tasks

from blocks_planning.board import rules
from blocks_planning.board.task import Task
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun

LAMBDAS = st.floats(0, 10, exclude_min=True)
PLANNERS = st.one_of(
    st.just(make_strategy('none', {})),
    st.builds(
        lambda lam, commit: make_strategy('scoping', {'lambda': lam, 'commit': commit}),
        st.one_of(st.just(0), LAMBDAS),
        st.sampled_from(['subgoal', 'action']),
    ),
    st.fixed_dictionaries(
        {
            'regions': st.sampled_from(['rows', 'rectangles']),
            'horizon': st.integers(1, 3),
            'max_sequences': st.sampled_from([1, 20]),
            'choice': st.sampled_from(['best', 'softmax']),
            'temperature': LAMBDAS,
            'aggregate': st.sampled_from(['best', 'softmax']),
            'aim': st.sampled_from(['perfect', 'most']),
        }
    ).map(lambda chosen: make_strategy('scoping', chosen)),
    st.builds(lambda lam: make_strategy('full', {'lambda': lam}), LAMBDAS),
)


def _search(name: str, **options: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    return st.fixed_dictionaries(options).map(lambda chosen: make_search(name, chosen))


ITERATIONS = st.integers(2, 50)
EXECUTE = st.sampled_from(['first', 'path'])
SEARCHES = st.one_of(
    _search('random'),
    _search('exact'),
    _search('bfs', depth=st.integers(1, 3)),
    _search('best_first', iterations=ITERATIONS, execute=EXECUTE),
    _search(
        'astar',
        iterations=ITERATIONS,
        execute=EXECUTE,
        divisor=st.sampled_from(['smallest', 'mean', 'largest']),
    ),
)


def specs(silhouettes: st.SearchStrategy[Task]) -> st.SearchStrategy[TrialSpec]:
    return st.builds(
        TrialSpec,
        stimulus=st.text(max_size=8),
        task=silhouettes,
        strategy=PLANNERS,
        search=SEARCHES,
        seed=st.integers(0, (1 << 64) - 1),
        budget=st.integers(0, 500),
    )


@settings(max_examples=300)
@given(specs(st.one_of(tasks(most=6), solvable_tasks())))
def test_placements_never_overlap_never_float_and_stay_inside(spec: TrialSpec) -> None:
    record, board = run_trial(spec), spec.task.board
    filled: set[tuple[int, int]] = set()
    for width, height, left, bottom in record.placements:
        cells = {(c, r) for c in range(left, left + width) for r in range(bottom, bottom + height)}
        assert all(0 <= c < board.width and 0 <= r < board.height for c, r in cells)
        assert not cells & filled
        assert bottom == 0 or any((c, bottom - 1) in filled for c in range(left, left + width))
        filled |= cells
    assert filled <= set(board.cells(spec.task.silhouette))
    assert (filled == set(board.cells(spec.task.silhouette))) == (
        record.status is TrialStatus.SUCCESS
    )


@settings(max_examples=200)
@given(specs(st.one_of(tasks(most=6), solvable_tasks())))
def test_records_hold_after_a_round_trip_and_a_rerun(spec: TrialSpec) -> None:
    record = run_trial(spec)
    again = record_from_json(json.loads(record.to_line()), 'test')
    assert again == record
    assert list(contradictions(again)) == []
    assert list(differs_from_rerun(again)) == []


@given(solvable_tasks(most=6, most_blocks=10), st.integers(0, 9))
def test_exact_solves_what_was_built(task: Task, seed: int) -> None:
    spec = TrialSpec('built', task, make_strategy('none', {}), make_search('exact', {}), seed)
    record = run_trial(spec)
    assert record.status is TrialStatus.SUCCESS
    assert next(rules.legal_placements(task, task.silhouette, task.silhouette), None) is None
