"""Records that are made from bags alone, also where messages were missed."""

from __future__ import annotations

import copy
import os
import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bag_builders import (
    START_NS,
    Said,
    held_complaints,
    only_trial,
    open_bag,
    said_of,
    trial_said,
    write_bag,
)
from builders import CHAIR, SQUARE, cancelled_record, ended, spec

from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.bagging.repair import repair
from blocks_planning.ros.wire.topics import OUTCOME, STATE, SUBGOAL, TOPICS, TRIAL
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus

# Read back


def test_records_are_made_from_the_bag_alone(
    bag: Path, trials: list[tuple[TrialRecord, list[Said]]]
) -> None:
    found = list(trials_of(bag))
    assert [one.record for one in found] == [record for record, _ in trials]
    assert [one.record.to_line() for one in found] == [record.to_line() for record, _ in trials]
    assert {record.status for record, _ in trials} >= {TrialStatus.SUCCESS, TrialStatus.GAVE_UP}
    assert held_complaints(bag) == []


def test_topics_need_no_order_among_each_other(
    tmp_path: Path, said: list[Said], trials: list[tuple[TrialRecord, list[Said]]]
) -> None:
    order = [OUTCOME, STATE, SUBGOAL, TRIAL]
    rank = {topic: order.index(topic) if topic in order else 9 for topic in TOPICS}
    shuffled = [one for _, some in trials for one in sorted(some, key=lambda one: rank[one.topic])]
    bag = write_bag(tmp_path / 'bag', shuffled)
    assert [one.record for one in trials_of(bag)] == [record for record, _ in trials]
    assert held_complaints(bag) == []


def test_many_trials_are_read_one_by_one(tmp_path: Path) -> None:
    pairs = [trial_said(spec(SQUARE, seed=seed)) for seed in range(30)]
    bag = write_bag(tmp_path / 'bag', [one for _, some in pairs for one in some])
    assert [one.record for one in trials_of(bag)] == [record for record, _ in pairs]
    assert held_complaints(bag) == []


def test_trial_that_the_bag_does_not_see_the_end_of(
    tmp_path: Path, cli: Callable[..., Any]
) -> None:
    record, said = trial_said(spec(CHAIR))
    last = max(n for n, one in enumerate(said) if one.topic is STATE)
    bag = write_bag(tmp_path / 'bag', said[:last])
    trial = only_trial(bag)
    assert not trial.is_over
    assert trial.outcome is None
    assert trial.record.placements == record.placements[:-1]
    assert list(trial.contradictions()) == []
    code, out, _ = cli('verify', bag, '--rerun')
    assert code == 0
    assert "record 1 ('small'): its end is not in the bag" in out
    assert cli('draw', bag, '--out', tmp_path / 'x.gif')[0] == 0


def test_tower_that_stood_before_its_decisions_is_no_contradiction(tmp_path: Path) -> None:
    """A world that was started again has its journal; the recorder went before the rest came."""
    _, said = trial_said(spec(CHAIR))
    states = [one for one in said if one.topic is STATE]
    bag = write_bag(tmp_path / 'bag', [said[0], states[-1]])
    trial = only_trial(bag)
    assert trial.outcome is None
    assert list(trial.contradictions()) == []


def test_states_that_were_missed_do_not_matter(tmp_path: Path) -> None:
    """A recorder that was away, and came back, hears the latest of everything."""
    record, said = trial_said(spec(CHAIR))
    last = {
        topic: max(n for n, o in enumerate(said) if o.topic is topic) for topic in (STATE, SUBGOAL)
    }
    kept = [o for n, o in enumerate(said) if n >= last.get(o.topic, 0)]
    trial = only_trial(write_bag(tmp_path / 'bag', kept))
    assert trial.record == record
    assert list(trial.contradictions()) == []


def test_subgoals_that_were_missed_are_named(tmp_path: Path) -> None:
    """Nobody says them again when the next trial has begun."""
    _, said = trial_said(spec(CHAIR))
    bag = write_bag(tmp_path / 'bag', [one for one in said if one.topic is not SUBGOAL])
    [sentence] = only_trial(bag).contradictions()
    assert sentence.startswith("the outcome has status 'success', but the bag lacks")


@pytest.mark.parametrize('after', range(0, 24, 3))
def test_cancelled_trial(tmp_path: Path, after: int) -> None:
    """What the other parts still did when the trial was cancelled is not in its record."""
    trial = spec(CHAIR)
    record = cancelled_record(trial, after + 1)
    heard: list[Message] = []
    run_trial(trial, CancelToken(), heard.append)
    over = ended(trial.trial_id, record)
    for extra in (0, 1, 5):
        said = said_of(trial, [*heard[: after + 1 + extra], over])
        found = only_trial(write_bag(tmp_path / f'bag{extra}', said))
        if record.status is TrialStatus.CANCELLED:
            assert found.record == record
        assert list(found.contradictions()) == []


# A recorder that was killed, and started again later


def with_absence(path: Path, said: list[Said], gone: int, back: int, seed: int) -> Path:
    """A bag whose recorder was killed before a message, and was there again before another.

    It then finds one topic after the other, and hears what is latched there.
    """
    chance = random.Random(seed)
    found = {topic: back + chance.randrange(30) * (seed % 3) for topic in TOPICS}
    again = []
    for place, one in enumerate(said[back:], start=back):
        for topic in (topic for topic in TOPICS if found[topic] == place and topic.latched):
            again += [earlier for earlier in said[:place] if earlier.topic is topic][-1:]
        if place >= found[one.topic]:
            again.append(one)
    time_ns = START_NS
    for part in (said[:gone], again):
        writer = open_bag(path)
        for one in part:
            time_ns += 1_000_000
            writer.add(f'/{one.topic.name}', one.data, time_ns, time_ns)
        writer.flush()
        os.close(writer._lock)
    repair(path)
    return path


@pytest.mark.parametrize('seed', range(16))
def test_absence_of_the_recorder_is_no_contradiction(
    seed: int, said: list[Said], trials: list[tuple[TrialRecord, list[Said]]], tmp_path: Path
) -> None:
    """And of the trials that it was there for nothing is lost."""
    chance = random.Random(seed)
    gone = chance.randrange(1, len(said) - 1) if seed else 0
    back = chance.randrange(gone, len(said))
    bag = with_absence(tmp_path / 'bag', said, gone, back, seed)
    refused: list[str] = []
    found = list(trials_of(bag, refused.append))
    assert refused == []
    assert [list(one.contradictions()) for one in found] == [[] for _ in found]
    ended = {one.record.to_line() for one in found if one.is_over}
    at = 0
    for record, messages in trials:
        if at + len(messages) <= gone or at >= back + 60:
            assert record.to_line() in ended
        at += len(messages)


def test_absence_hides_no_lie(said: list[Said], tmp_path: Path, bag: Path) -> None:
    """What is there of a trial must still be what its outcome says."""
    outcome = next(n for n, one in enumerate(said) if one.topic is OUTCOME)
    states = [n for n, one in enumerate(said[:outcome]) if one.topic is STATE]

    def lie(one: Said) -> Said:
        if one.topic is OUTCOME and one.message.placements:
            one.message.placements[0].column ^= 2
        return one

    told = [lie(Said(one.topic, copy.deepcopy(one.message))) for one in said]
    found = with_absence(tmp_path / 'bag', told, states[-2] + 1, outcome, 0)
    first = next(iter(trials_of(found)))
    assert any('placements' in sentence for sentence in first.contradictions())
