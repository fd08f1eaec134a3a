"""Messages that are stale, doubled, foreign, or come before a trial."""

from __future__ import annotations

from dataclasses import replace

import pytest
from builders import FRAME, spec
from parts import FOREIGN, FOREIGN_START, FULL, HEARD, PARTS, START, STATES, TRIAL, heard, tell

from blocks_planning.board.blocks import Block, Placement
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials import selector, world
from blocks_planning.trials.messages import (
    Message,
    PlaceBlock,
    SearchAnswer,
    SearchRequest,
    TrialEnded,
)
from blocks_planning.trials.spec import TrialSpec


def test_before_a_trial_nobody_says_anything() -> None:
    for part in PARTS.values():
        for message in HEARD[1:]:
            assert part.step(part.Memory(), message) == (part.Memory(), ())


@pytest.mark.parametrize('name', PARTS)
def test_foreign_messages_change_nothing(name: str) -> None:
    part = PARTS[name]
    memory = part.Memory()
    for message in HEARD[:-1]:
        memory, _ = part.step(memory, message)
        for foreign in HEARD[1:]:
            elsewhere = replace(foreign, trial_id=FOREIGN.trial_id)
            assert part.step(memory, elsewhere) == (memory, ())


@pytest.mark.parametrize('name', PARTS)
def test_another_trial_begins_from_nothing(name: str) -> None:
    part = PARTS[name]
    fresh = part.step(part.Memory(), FOREIGN_START)
    for end in range(1, len(HEARD) + 1):
        memory, _ = tell(part, HEARD[:end])
        assert part.step(memory, FOREIGN_START) == fresh


@pytest.mark.parametrize('name', ['world', 'selector', 'searcher'])
def test_after_the_end_nobody_does_anything(name: str) -> None:
    part = PARTS[name]
    memory, _ = tell(part, HEARD)
    assert isinstance(HEARD[-1], TrialEnded)
    for message in HEARD[1:]:
        assert part.step(memory, message) == (memory, ())


# Who asks once more is answered once more.
ANSWERED_AGAIN = {'searcher': (SearchRequest,)}


@pytest.mark.parametrize(
    'trial', [TRIAL, FULL, spec(FRAME, lam=0.05, depth=2)], ids=['scoping', 'full', 'gave up']
)
@pytest.mark.parametrize('name', PARTS)
def test_doubled_and_stale_messages_change_nothing(name: str, trial: TrialSpec) -> None:
    part = PARTS[name]
    memory = part.Memory()
    past: list[Message] = []
    for message in heard(trial):
        memory, _ = part.step(memory, message)
        past.append(message)
        for old in past[isinstance(message, TrialEnded) :]:
            after, said = part.step(memory, old)
            assert after == memory, (message, old)
            if not isinstance(old, ANSWERED_AGAIN.get(name, ())):
                assert said == (), (message, old)


@pytest.mark.parametrize('name', ['selector', 'searcher', 'scribe'])
def test_a_state_of_the_past_is_ignored(name: str) -> None:
    part = PARTS[name]
    memory, _ = tell(part, [START, STATES[3]])
    for old in STATES[:4]:
        assert part.step(memory, old) == (memory, ())


def test_placement_for_another_state_is_ignored() -> None:
    memory, _ = tell(world, [START])
    for sequence in (-1, 1, 2):
        stale = PlaceBlock(TRIAL.trial_id, sequence, Placement(Block(1, 2), 0))
        assert world.step(memory, stale) == (memory, ())


def test_answer_that_was_not_asked_for_is_no_reason_to_decide() -> None:
    for length in (1, 2):
        memory, _ = tell(selector, HEARD[:length])
        unasked = SearchAnswer(TRIAL.trial_id, Query(0b1, 0b11), SolveResult(SolveStatus.SOLVED))
        assert selector.step(memory, unasked) == (memory, ())
