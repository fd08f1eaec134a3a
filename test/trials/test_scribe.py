"""The part that writes the record and ends a trial."""

from __future__ import annotations

from dataclasses import replace

import pytest
from builders import CHAIR, spec
from parts import CHOSEN, HEARD, IDS, STATES, TRIAL, TRIALS, heard, only, started, tell

from blocks_planning.trials import scribe, world
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    PlacementCode,
    PlacementOutcome,
    TrialEnded,
    WorldState,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.observation import Observation


def test_scribe_writes_down_and_ends() -> None:
    memory, said = tell(scribe, HEARD)
    assert said == [TrialEnded(TRIAL.trial_id, TrialStatus.SUCCESS, '', run_trial(TRIAL))]
    assert memory.record() == run_trial(TRIAL)


def test_scribe_has_no_record_before_a_trial() -> None:
    with pytest.raises(ValueError, match='no record before a trial'):
        scribe.Memory().record()


def test_scribe_ends_a_trial_that_the_world_can_not_go_on_with() -> None:
    """With what the world says, and only on the state that it says it of."""
    memory, _ = tell(scribe, [HEARD[0], STATES[0], CHOSEN[0], STATES[1]])
    failed = PlacementOutcome(TRIAL.trial_id, 1, None, 'the arm is broken', PlacementCode.FAILED)
    for stale in (replace(failed, sequence=0), replace(failed, sequence=2)):
        assert scribe.step(memory, stale) == (memory, ())
    assert scribe.step(memory, replace(failed, code=PlacementCode.IMPOSSIBLE)) == (memory, ())
    memory, said = scribe.step(memory, failed)
    record = memory.record()
    assert (record.status, record.reason) == (TrialStatus.CANCELLED, 'the arm is broken')
    assert said == (TrialEnded(TRIAL.trial_id, record.status, record.reason, record),)
    assert memory.record().placements == STATES[1].placements


def test_record_of_a_cancelled_trial_is_cut_where_something_was_on_its_way() -> None:
    for state in STATES:
        for count in range(len(CHOSEN) + 1):
            memory, _ = tell(scribe, [HEARD[0], state, *CHOSEN[:count]])
            memory, _ = scribe.step(memory, CancelTrial(TRIAL.trial_id, 'why'))
            assert list(contradictions(memory.record())) == []


def test_record_of_a_cancelled_trial_ends_with_the_subgoal_that_is_open() -> None:
    """The plan of all subgoals was decided and begun, but only some of its blocks are seen."""
    trial = spec(CHAIR, strategy='full')
    said: list[Message] = []
    run_trial(trial, observe=said.append)
    start, *_ = said
    chosen = [message for message in said if isinstance(message, SubgoalChosen)][-1]
    assert chosen.index > 0
    for state in [message for message in said if isinstance(message, WorldState)]:
        memory, _ = tell(scribe, [start, state, chosen])
        memory, _ = scribe.step(memory, CancelTrial(trial.trial_id, 'why'))
        assert list(contradictions(memory.record())) == []


def test_scribe_says_the_usual_sentence_of_a_failure_without_one() -> None:
    memory, _ = tell(scribe, [HEARD[0], STATES[0]])
    failed = PlacementOutcome(TRIAL.trial_id, 0, None, '', PlacementCode.FAILED)
    memory, _ = scribe.step(memory, failed)
    assert memory.record().reason == 'no block can be placed any more'


def test_world_is_restored_by_placements_that_can_be_only() -> None:
    memory, _ = tell(world, [HEARD[0]])
    assert isinstance(memory, world.Memory)
    for state in STATES:
        restored = world.restored(memory, state.observations)
        assert restored is not None
        assert restored.state == state
    found, first, *rest = STATES[-1].observations
    (placed,) = first.landed
    moved = first._replace(landed=(placed._replace(row=placed.row + 1),))
    assert world.restored(memory, (found, moved, *rest)) is None
    assert world.restored(memory, (found, first, Observation(None, (placed,)))) is None
    assert world.restored(memory, (first,)) is None


def test_scribe_ends_a_cancelled_trial_as_it_stands() -> None:
    for length in range(1, len(HEARD) - 1):
        memory, before = tell(scribe, HEARD[:length])
        memory, said = tell(scribe, [CancelTrial(TRIAL.trial_id)], memory)
        if before:
            assert said == []
            continue
        record = memory.record()
        assert said == [TrialEnded(TRIAL.trial_id, TrialStatus.CANCELLED, '', record)]
        assert record.status is TrialStatus.CANCELLED
        assert list(contradictions(record)) == []
        for message in HEARD[length:]:
            assert scribe.step(memory, message) == (memory, ())


@pytest.mark.parametrize('order', ['state first', 'subgoal first'])
@pytest.mark.parametrize('trial', TRIALS, ids=IDS)
def test_scribe_that_missed_everything_but_the_end_knows_all(trial: TrialSpec, order: str) -> None:
    messages = heard(trial)
    latched = [*only(WorldState, messages)[-1:], *only(SubgoalChosen, messages)[-1:]]
    if order == 'subgoal first':
        latched.reverse()
    memory, said = tell(scribe, [started(trial), *latched])
    assert memory.record() == run_trial(trial)
    assert len(said) == 1
