"""Messages that nobody who keeps to the rules would send, from a seeded generator."""

from __future__ import annotations

import random
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from typing import Any, NamedTuple

from rclpy.serialization import serialize_message

from blocks_planning.errors import InvalidInput
from blocks_planning.ros.runtime.guarded import read_message
from blocks_planning.ros.wire.topics import (
    ACTION,
    HOLD,
    OUTCOME,
    PROPOSAL,
    SEARCH_RESULT,
    STATE,
    SUBGOAL,
    TOPICS,
    TRIAL,
    Topic,
)
from blocks_planning.trials.consistency import Consistency
from blocks_planning.trials.spec import TrialSpec

KEPT = 300
LONGEST = 20_000
"""What is longer is no material: it would only grow [bytes]."""
_NUMBERS = (0, 1, 2, 7, 15, 16, 17, 100, 255, 256, 2**16, 2**31 - 1, 2**32 - 1, 2**63, 2**64 - 1)
_FLOATS = (float('nan'), float('inf'), -float('inf'), -1.0, -0.0, 1e308, 5e-324)
_WORDS = (
    '',
    'building',
    'success',
    'solved',
    'bfs',
    'none',
    'full',
    '\x00',
    '\n\x1b[31m',
    'é' * 99,
)
_BOMBS = (b'\xff\xff\xff\x7f', b'\xff\xff\xff\xff', b'\x00\x00\x00\x80', b'\x00\x00\x10\x00')
_UNSAYABLE = (AttributeError, OverflowError, SystemError)
"""What rclpy raises for a number that C has no room for, depending on where it stumbles next."""


class Captured(NamedTuple):
    """A message that was heard."""

    topic: Topic
    data: bytes


class Hostile:
    """Makes messages, out of nothing and out of what it has heard of real trials."""

    def __init__(self, seed: int) -> None:
        self.chance = random.Random(seed)
        self._heard: dict[Topic, deque[bytes]] = {topic: deque(maxlen=KEPT) for topic in TOPICS}
        self._specs: dict[str, TrialSpec] = {}
        self._sequences: dict[str, int] = {}
        self._makers: list[tuple[Callable[[Topic], bytes], int]] = [
            (self._heard_again, 2),
            (self._bytes_changed, 6),
            (self._fields_changed, 8),
            (self._made_up, 4),
            (lambda _: self.chance.randbytes(self.chance.randrange(1, 200)), 1),
        ]

    def hear(self, topic: Topic, data: bytes) -> None:
        """Take note of what is said; real or not, it is material."""
        with suppress(InvalidInput):
            message = read_message(topic.ros_type, data)
            if topic is TRIAL:
                self._specs.setdefault(message.trial_id, topic.from_ros(None, message).spec)
            if topic is STATE and message.trial_id in self._specs:
                topic.from_ros(self._specs[message.trial_id].task.board, message)
                known = self._sequences.get(message.trial_id, 0)
                self._sequences[message.trial_id] = max(known, message.sequence)
            if len(data) <= LONGEST:
                self._heard[topic].append(data)

    def message(self) -> Captured:
        """The next message; none that a part of the graph could have sent in its place."""
        makers, weights = zip(*self._makers, strict=True)
        while True:
            topic = self.chance.choice(TOPICS)
            data = b''
            with suppress(*_UNSAYABLE):
                data = self.chance.choices(makers, weights)[0](topic)
            if data and not self._has_authority(topic, data):
                return Captured(topic, data)

    def interruption(self) -> Captured | None:
        """A well-formed trial that is not the one that runs, or the end of one that runs."""
        trials = list(self._heard[TRIAL])
        if not trials:
            return None
        trial = read_message(TRIAL.ros_type, self.chance.choice(trials))
        if self.chance.random() < 0.5:
            end = OUTCOME.ros_type(
                trial_id=list(self._specs)[-1],
                status='cancelled',
                code=OUTCOME.ros_type.CODE_CANCELLED,
            )
            return Captured(OUTCOME, serialize_message(end))
        trial.trial_id = f'foreign/{self.chance.randrange(10**9)}'
        return Captured(TRIAL, serialize_message(trial))

    def goal(self) -> Any:
        """A trial that can't be run, as it is asked for."""
        while True:
            trial = self._changed(TRIAL.ros_type())
            with suppress(*_UNSAYABLE):
                serialize_message(trial)
                return trial

    def _has_authority(self, topic: Topic, data: bytes) -> bool:
        """Whether nodes have to believe it: a well-formed word that may be the next of its trial.

        ROS 2 does not say who sends, so that who says such a thing is a part of the graph.
        """
        try:
            message = read_message(topic.ros_type, data)
            if topic is TRIAL:
                topic.from_ros(None, message)
                return data not in list(self._heard[TRIAL])[-1:]
            if topic is OUTCOME:
                topic.from_ros(None, message)
                return message.trial_id in self._specs
            spec = self._specs.get(message.trial_id)
            if spec is None or topic not in (
                ACTION,
                HOLD,
                PROPOSAL,
                SEARCH_RESULT,
                STATE,
                SUBGOAL,
            ):
                return False
            Consistency(spec).check(topic.from_ros(spec.task.board, message))
        except InvalidInput:
            return False
        if topic is ACTION:
            known = self._sequences.get(message.trial_id, 0)
            return bool(known <= message.sequence <= spec.task.board.size)
        return topic is not PROPOSAL and data not in self._heard[topic]

    def _seed_of(self, topic: Topic) -> bytes:
        heard = self._heard[topic]
        return self.chance.choice(heard) if heard else serialize_message(topic.ros_type())

    def _heard_again(self, topic: Topic) -> bytes:
        return self._seed_of(topic)

    def _bytes_changed(self, topic: Topic) -> bytes:
        """Cut off, with some bytes changed, or with a length that is beyond all bounds."""
        data, chance = bytearray(self._seed_of(topic)), self.chance
        kind = chance.randrange(4)
        if kind == 0:
            return bytes(data[: chance.randrange(len(data))])
        if kind == 1:
            at = chance.randrange(0, max(1, len(data) - 4)) & ~3
            data[at : at + 4] = chance.choice(_BOMBS)
        else:
            for _ in range(chance.randint(1, 8)):
                data[chance.randrange(len(data))] = chance.randrange(256)
        return bytes(data) + (chance.randbytes(9) if kind == 3 else b'')

    def _fields_changed(self, topic: Topic) -> bytes:
        message = read_message(topic.ros_type, self._seed_of(topic))
        return serialize_message(self._changed(message))

    def _made_up(self, topic: Topic) -> bytes:
        message = topic.ros_type()
        if self._specs and self.chance.random() < 0.7:
            message.trial_id = self.chance.choice(list(self._specs)[-3:])
        return serialize_message(self._changed(message))

    def _changed(self, message: Any) -> Any:
        for _ in range(self.chance.randint(1, 4)):
            self._change(message)
        return message

    def _change(self, message: Any) -> None:
        """Change a field, anywhere in a message; what Python refuses to say stays."""
        name = self.chance.choice(list(message.get_fields_and_field_types()))
        value = getattr(message, name)
        with suppress(AssertionError, OverflowError, ValueError):
            if hasattr(value, 'get_fields_and_field_types'):
                self._change(value)
            elif isinstance(value, (str, bool, int, float)):
                setattr(message, name, self._other(value))
            else:
                setattr(message, name, self._other_list(message, name, list(value)))

    def _other(self, value: Any) -> Any:
        chance = self.chance
        if isinstance(value, str):
            if chance.random() < 0.01:
                return 'long' * (1 << 18)
            return chance.choice((*_WORDS, *self._specs, value[:-1], value + '.'))
        if isinstance(value, bool):
            return not value
        if isinstance(value, float):
            return chance.choice(_FLOATS)
        return chance.choice((*_NUMBERS, value + 1, max(0, value - 1)))

    def _other_list(self, message: Any, name: str, values: list[Any]) -> list[Any]:
        chance = self.chance
        if values and chance.random() < 0.5:
            at = chance.randrange(len(values))
            if hasattr(values[at], 'get_fields_and_field_types'):
                self._change(values[at])
            else:
                values[at] = self._other(values[at])
            return values
        kind = chance.randrange(5)
        if kind == 0 or not values:
            return []
        if kind == 1:
            return values[:-1]
        if kind == 2:
            return values[::-1]
        copies = 2 if chance.random() < 0.98 else max(1, 3000 // len(values))
        return [deepcopy(value) for value in values * copies]
