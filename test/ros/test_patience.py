"""What a world owes a trial, without any node."""

from __future__ import annotations

from dataclasses import replace

import pytest
from builders import CHAIR, spec

from blocks_planning.ros.runtime.patience import Patience
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import MAX_OBSERVATIONS, Observation

SPEC = spec(CHAIR, lam=0.2, depth=2)
BEGUN = TrialStarted('one', SPEC)
HEARD: list[Message] = []
run_trial(SPEC, observe=HEARD.append)
STATES = [replace(m, trial_id='one') for m in HEARD if isinstance(m, WorldState)]
ORDERS = [replace(m, trial_id='one') for m in HEARD if isinstance(m, PlaceBlock)]


def told(code: PlacementCode, reason: str = '', at: int = 0) -> PlacementOutcome:
    """What the world says of an order."""
    return PlacementOutcome('one', at, None, reason, code)


def patience(*messages: Message, retries: int = 2) -> Patience:
    """With 10 s of patience, after some messages at time 0."""
    made = Patience(10.0, retries)
    for message in (BEGUN, *messages):
        assert made.hear(message, 0.0) == ''
    return made


def test_first_state_is_due_and_then_nothing_is() -> None:
    made = patience()
    assert made.overdue(9.9) == ''
    silent = 'the world has been silent for 10.0 s after the trial was announced'
    assert made.overdue(10.0) == silent
    made.hear(STATES[0], 10.0)
    assert made.overdue(1e6) == ''


def test_every_order_is_due_until_a_later_state() -> None:
    made = patience(STATES[0])
    made.hear(ORDERS[0], 5.0)
    made.hear(ORDERS[0], 14.0)  # given again: it is due since the first time
    made.hear(STATES[0], 14.0)
    made.hear(told(PlacementCode.PLACED), 14.0)
    block, column = ORDERS[0].placement
    assert made.overdue(14.9) == ''
    assert made.overdue(15.0).endswith(f'after block {block} was ordered in column {column}')
    made.hear(STATES[1], 15.0)
    assert made.overdue(1e6) == ''


def test_what_is_stale_early_or_foreign_changes_nothing() -> None:
    made = patience(*STATES[:2])
    for message in (ORDERS[0], ORDERS[2], replace(ORDERS[1], trial_id='other')):
        made.hear(message, 0.0)
    assert made.overdue(1e6) == ''
    made.hear(ORDERS[1], 0.0)
    for at in (0, 2):
        made.hear(told(PlacementCode.IN_PROGRESS, at=at), 9.0)
    made.hear(replace(STATES[2], trial_id='other'), 9.0)
    assert made.overdue(10.0)


@pytest.mark.parametrize('before', [(), (STATES[0], ORDERS[0])], ids=['first state', 'order'])
def test_world_may_be_in_progress_as_long_as_it_lasts(before: tuple[Message, ...]) -> None:
    made = patience(*before)
    for second in range(0, 900, 9):
        assert made.overdue(second) == ''
        made.hear(told(PlacementCode.IN_PROGRESS), second)
    assert made.overdue(902) == 'the world has been silent for 11.0 s after ' + made._after


@pytest.mark.parametrize('code', [PlacementCode.TRY_AGAIN, PlacementCode.IMPOSSIBLE])
@pytest.mark.parametrize('retries', [0, 2])
def test_order_is_given_again_so_often(code: PlacementCode, retries: int) -> None:
    made = patience(STATES[0], retries=retries)
    for _ in range(retries):
        made.hear(ORDERS[0], 0.0)
        assert made.hear(told(code), 0.0) == ''
        assert made.hear(told(code), 0.0) == ''  # an answer that is repeated counts once
        assert made.overdue(1e6) == ''
    made.hear(ORDERS[0], 0.0)
    reason = made.hear(told(code, 'the gripper is open'), 0.0)
    assert reason.endswith('the last answer: the gripper is open')
    assert ('3 times' if retries else 'once') in reason


def test_every_order_has_its_own_retries() -> None:
    made = patience(STATES[0])
    for number in range(3):
        for _ in range(2):
            made.hear(ORDERS[number], 0.0)
            assert made.hear(told(PlacementCode.TRY_AGAIN, at=number), 0.0) == ''
        made.hear(STATES[number + 1], 0.0)


def test_refused_states_are_named_and_the_next_state_forgets_them() -> None:
    made = patience(STATES[0], ORDERS[0])
    made.refused('placements: block 1x2 in column 0 and row 3 rests on nothing')
    assert made.overdue(10.0).endswith('; its last state was refused: ' + made._refused)
    made.hear(STATES[1], 0.0)
    made.hear(ORDERS[1], 0.0)
    assert 'refused' not in made.overdue(10.0)


def test_absence_is_no_silence() -> None:
    made = patience(STATES[0], ORDERS[0])
    made.excuse(8.0)
    assert made.overdue(17.9) == ''
    assert made.overdue(18.0)


def test_board_may_be_set_back_so_often_in_a_trial() -> None:
    made = patience(*STATES[:3])
    assert [made.set_back(0.0) for _ in range(2)] == ['', '']
    made.hear(STATES[0], 0.0)
    assert made.set_back(0.0) == 'the world went back to an earlier state 3 times'
    made.hear(BEGUN, 0.0)
    assert made.set_back(0.0) == ''


def test_observations_are_bounded() -> None:
    changes = (Observation(),) * MAX_OBSERVATIONS
    board = SPEC.task.board
    last = observed('one', board, changes, TrialStatus.BUILDING)
    made = patience(STATES[0], last)
    beyond = observed('one', board, (*changes, Observation()), TrialStatus.BUILDING)
    assert made.hear(beyond, 0.0) == 'the trial would need more than 1024 observations'
