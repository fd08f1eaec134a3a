"""The same specification gives the same record, bit for bit, wherever and whenever it is run."""

from __future__ import annotations

import multiprocessing
import os
import random
import subprocess
import sys
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    EMPTY,
    FRAME,
    NOTHING_FITS,
    PLANNERS,
    SQUARE,
    planner_id,
    record,
    spec,
)

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

WIDE = '/'.join(['#' * 12] * 6)
"""More than 64 cells."""
SPECS = [
    *(
        spec(rows, seed=7, budget=300, **planner)
        for rows in (CHAIR, FRAME)
        for planner in PLANNERS
    ),
    spec(WIDE, seed=7, budget=300, depth=2, lam=0.1),
    spec(WIDE, seed=7, budget=300, search='astar', iterations=50, strategy='none'),
]
LINES = [run_trial(trial).to_line() for trial in SPECS]

FRESH = """
import json, sys
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.reading import record_from_json
for line in sys.stdin:
    print(run_trial(record_from_json(json.loads(line), 'stdin').spec).to_line())
"""


def _line(trial: TrialSpec) -> str:
    return run_trial(trial).to_line()


@pytest.mark.parametrize('shuffle', range(3))
def test_order_of_trials_plays_no_part(shuffle: int) -> None:
    order = list(range(len(SPECS)))
    random.Random(shuffle).shuffle(order)
    assert {index: _line(SPECS[index]) for index in order} == dict(enumerate(LINES))


def test_threads_play_no_part() -> None:
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(_line, SPECS * 3)) == LINES * 3


@pytest.mark.long
def test_processes_play_no_part() -> None:
    context = multiprocessing.get_context('spawn')
    with ProcessPoolExecutor(2, mp_context=context) as pool:
        assert [found.to_line() for found in pool.map(run_trial, SPECS)] == LINES


@pytest.mark.parametrize('hash_seed', ['1', pytest.param('4242', marks=pytest.mark.long)])
def test_interpreter_plays_no_part(hash_seed: str) -> None:
    done = subprocess.run(
        [sys.executable, '-c', FRESH],
        input='\n'.join(LINES),
        env={**os.environ, 'PYTHONHASHSEED': hash_seed},
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.stderr == ''
    assert done.stdout.splitlines() == LINES


def test_name_of_the_stimulus_plays_no_part() -> None:
    for trial in SPECS[:8]:
        other = run_trial(replace(trial, stimulus='other'))
        assert other.spec.trial_id != trial.trial_id
        assert replace(other, spec=trial).to_line() == _line(trial)


@pytest.mark.parametrize(
    'planner',
    [
        pytest.param({'strategy': 'none', 'search': 'random'}, id='random'),
        pytest.param({'strategy': 'none', 'search': 'bfs', 'depth': 2}, id='bfs'),
        pytest.param({'strategy': 'none', 'search': 'astar', 'iterations': 9}, id='astar'),
        pytest.param(
            {'strategy': 'none', 'search': 'best_first', 'iterations': 9}, id='best_first'
        ),
        pytest.param({'strategy': 'full', 'search': 'random', 'library': '1x1'}, id='tie of full'),
    ],
)
def test_seeds_make_a_difference(planner: dict[str, Any]) -> None:
    rows = SQUARE if 'library' in planner else CHAIR
    decisions = {record(rows, seed=seed, **planner).decisions for seed in range(10)}
    assert len(decisions) > 1


def test_seed_draws_between_equal_subgoals() -> None:
    chosen = {
        record(SQUARE, strategy='full', search='random', library='1x1', seed=seed)
        .decisions[0]
        .decision.chosen
        for seed in range(20)
    }
    assert len(chosen) > 3


def test_seed_plays_no_part_in_proofs() -> None:
    lines = {
        replace(record(ARCH, search='exact', seed=seed), spec=spec()).to_line()
        for seed in range(5)
    }
    assert len(lines) == 1


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_empty_silhouette_is_a_success_without_a_decision(planner: dict[str, Any]) -> None:
    done = record(EMPTY, **planner)
    assert done.status is TrialStatus.SUCCESS
    assert (done.placements, done.decisions) == ((), ())
    assert _numbers(done.to_json()) == [0, 0, 0, 0, 0]


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
@pytest.mark.parametrize(
    'rows',
    [NOTHING_FITS, '#', '##../....', '.#/..'],
    ids=['one cell', 'board of one cell', 'row', 'in the air'],
)
def test_where_nothing_is_legal_the_trial_is_stuck(rows: str, planner: dict[str, Any]) -> None:
    done = record(rows, **planner)
    assert done.status is TrialStatus.STUCK
    assert (done.placements, done.decisions) == ((), ())
    assert _numbers(done.to_json()) == [0, 0, 0, 0, 0]


def _numbers(data: dict[str, Any]) -> list[int]:
    costs = ('action_planning_cost', 'subgoal_planning_cost', 'solution_cost')
    return [data[key] for key in ('blocks', 'subgoals', *costs)]
