"""Whatever a message says, it is refused or every part can live with it."""

from __future__ import annotations

import random
from collections.abc import Iterator
from copy import deepcopy
from typing import Any, NamedTuple

import pytest
from carried import (
    BOARD,
    TOPIC_OF,
    changed_lists,
    example,
    fields,
    said_in_example,
    sent,
    values_of,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from rclpy.serialization import serialize_message

from blocks_planning.ros.wire.conversions.fields import MessageError
from blocks_planning.ros.wire.topics import OUTCOME, SUBGOAL, TOPICS, Topic
from blocks_planning.trials import scribe, searcher, selector, world
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import CancelTrial, Message, TrialStarted

PARTS = (world, selector, searcher, scribe)


class Change(NamedTuple):
    """A value put in the place of another, somewhere in a message."""

    topic: Topic
    path: str
    value: Any
    message: Any
    field: str


def changes(topic: Topic) -> Iterator[Change]:
    """A real message with one field changed, for every field and many values."""
    for index in range(len(list(fields(example(topic))))):
        _, name, kind, _ = list(fields(example(topic)))[index]
        owner = list(fields(example(topic)))[index][0]
        tried = values_of(kind) if '/' not in kind else changed_lists(getattr(owner, name))
        for value in tried:
            message = example(topic)
            target, name, _, path = list(fields(message))[index]
            setattr(target, name, deepcopy(value))
            yield Change(topic, path, value, message, name)


def judge(change: Change) -> Any:
    """What a changed message says; None if it is refused, in which case it must be well said."""
    arrived = sent(change.message)
    try:
        return change.topic.from_ros(BOARD, arrived)
    except MessageError as error:
        text = str(error)
        assert '\n' not in text
        assert len(text) < 400
        return None


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
def test_whatever_a_message_says_nothing_breaks(topic: Topic) -> None:
    """It is refused, or every part can live with it and the graph can carry it again."""
    refused = 0
    for change in changes(topic):
        heard = judge(change)
        if heard is None:
            refused += 1
        else:
            take_everywhere(heard)
    assert refused > 0


@pytest.mark.parametrize('topic', TOPICS, ids=lambda topic: topic.name)
@settings(max_examples=40)
@given(data=st.data())
def test_whatever_several_fields_say_nothing_breaks(topic: Topic, data: st.DataObject) -> None:
    chance = random.Random(data.draw(st.integers(0, 2**32)))
    message = example(topic)
    for _ in range(chance.randint(1, 4)):
        target, name, kind, path = chance.choice(list(fields(message)))
        value = getattr(target, name)
        setattr(
            target,
            name,
            chance.choice(values_of(kind) if '/' not in kind else changed_lists(value)),
        )
        message = deepcopy(message)
    heard = judge(Change(topic, path, None, message, name))
    if heard is not None:
        take_everywhere(heard)


def take_everywhere(heard: Any) -> None:
    """Let every part of a trial hear a message, early and late in the trial."""
    messages, _ = said_in_example()
    for part in PARTS:
        for heard_before in (1, len(messages) // 2):
            memory = part.Memory()
            for message in messages[:heard_before]:
                memory, _ = part.step(memory, message)
            memory, said = part.step(memory, heard)
            for answer in said:
                if type(answer) in TOPIC_OF:
                    board = answer.spec.task.board if isinstance(answer, TrialStarted) else BOARD
                    serialize_message(TOPIC_OF[type(answer)].to_ros(board, answer))
            if part is scribe and memory.trial is not None:
                for end in ended(memory):
                    serialize_message(OUTCOME.to_ros(None, end))
                    end.record.to_line()


def ended(memory: scribe.Memory) -> tuple[Any, ...]:
    """What the scribe says when the trial is cancelled."""
    assert memory.trial is not None
    cancel: Message = CancelTrial(memory.trial.trial_id)
    return scribe.step(memory, cancel)[1]


def test_an_example_of_several_decisions() -> None:
    """What the fuzzing above changes has everything in it that can be changed."""
    heard = SUBGOAL.from_ros(BOARD, sent(example(SUBGOAL)))
    assert isinstance(heard, SubgoalChosen)
    assert len(heard.decisions) > 1
