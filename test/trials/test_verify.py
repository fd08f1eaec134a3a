"""Records of real trials hold against the rules; what the rules allow, a rerun may find."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from builders import (
    ARCH,
    CHAIR,
    EMPTY,
    FRAME,
    NEVER_SOLVED,
    NOTHING_FITS,
    ODD,
    PLANNERS,
    TOWERS,
    cancelled_record,
    planner_id,
    record,
    record_json,
    remade,
    spec,
)
from lies import Lie, both, one_more, put

from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun

# What is true.


@pytest.mark.parametrize('planner', PLANNERS, ids=planner_id)
def test_real_records_hold(planner: dict[str, Any]) -> None:
    for rows in TOWERS:
        real = record(rows, budget=300, **planner)
        assert list(contradictions(real)) == []
        assert list(differs_from_rerun(real)) == []


@pytest.mark.parametrize(
    ('rows', 'planner', 'status'),
    [
        (ARCH, {}, TrialStatus.SUCCESS),
        (EMPTY, {}, TrialStatus.SUCCESS),
        (NOTHING_FITS, {}, TrialStatus.STUCK),
        (ODD, {}, TrialStatus.STUCK),
        (ODD, {'strategy': 'none', 'budget': 10}, TrialStatus.STUCK),
        (NEVER_SOLVED, {}, TrialStatus.GAVE_UP),
        (FRAME, {'lam': 0.05, 'depth': 2}, TrialStatus.GAVE_UP),
    ],
)
def test_records_of_every_status_hold(
    rows: str, planner: dict[str, Any], status: TrialStatus
) -> None:
    real = record(rows, **planner)
    assert real.status is status
    assert list(contradictions(real)) == []


CANCELLED = [
    (CHAIR, {'lam': 0.2, 'depth': 2}),
    (CHAIR, {'commit': 'action', 'lam': 0.1, 'depth': 1}),
    (CHAIR, {'strategy': 'full', 'depth': 1}),
    (ARCH, {'strategy': 'none'}),
    (FRAME, {'lam': 0.05, 'depth': 2}),
    (NOTHING_FITS, {}),
    (EMPTY, {}),
]


@pytest.mark.parametrize(('rows', 'planner'), CANCELLED)
def test_cancelled_records_hold_wherever_they_end(rows: str, planner: dict[str, Any]) -> None:
    trial = spec(rows, **planner)
    messages: list[Message] = []
    whole = run_trial(trial, observe=messages.append)
    for number in range(1, len(messages) + 1):
        real = cancelled_record(trial, number)
        assert real.status in (TrialStatus.CANCELLED, whole.status)
        assert list(contradictions(real)) == []
        assert list(differs_from_rerun(real)) == []
        assert real.placements == whole.placements[: len(real.placements)]


@pytest.mark.parametrize('rows', TOWERS)
def test_trial_that_is_cancelled_before_it_begins_has_a_record(rows: str) -> None:
    cancel = CancelToken()
    cancel.cancel()
    real = run_trial(spec(rows), cancel)
    assert real.status is TrialStatus.CANCELLED
    assert (real.placements, real.decisions) == ((), ())
    assert list(contradictions(real)) == []


# Only a rerun can know.


@pytest.mark.parametrize(
    ('lie', 'keys'),
    [
        pytest.param(
            both(
                put('decisions', 0, 'candidates', 0, 'planning_cost', to=one_more),
                put('decisions', 0, 'subgoals', 0, 'planning_cost', to=one_more),
                put('decisions', 0, 'subgoals', 0, 'solution_cost', to=one_more),
            ),
            {'action_planning_cost', 'solution_cost', 'decisions'},
            id='cost changed everywhere',
        ),
        pytest.param(
            put('seed', to=2), {'placements', 'observations', 'decisions'}, id='another seed'
        ),
    ],
)
def test_rerun_finds_what_is_consistent_but_not_true(lie: Lie, keys: set[str]) -> None:
    data = record_json(CHAIR, strategy='none', depth=2, seed=0)
    lie(data)
    lied = record_from_json(remade(data), 'x')
    assert list(contradictions(lied)) == []
    said = set(differs_from_rerun(lied))
    assert {f'a new run gives another value of {key}' for key in keys} <= said


def test_cancelled_record_is_not_run_again() -> None:
    cancelled = cancelled_record(spec(CHAIR), 5)
    assert list(differs_from_rerun(cancelled)) == []
    as_success = replace(cancelled, status=TrialStatus.SUCCESS)
    assert list(differs_from_rerun(as_success)) != []
