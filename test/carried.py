"""Messages of real trials, as the graph carries them, and values to try in their fields."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache
from typing import Any

from builders import CHAIR, spec
from persons import human_spec, rows_of
from rclpy.serialization import deserialize_message, serialize_message

from blocks_planning.ros.wire.topics import TOPICS, Topic
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Held, Message, ProposalMade
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

TOPIC_OF = {topic.kind: topic for topic in TOPICS}
BY_NAME = {topic.name: topic for topic in TOPICS}
SPEC = spec(CHAIR, lam=0.2, depth=2)
HUMAN = human_spec(CHAIR, depth=2)
SAID_BY_PERSON = rows_of(HUMAN, 2, 4, 6)
BOARD = SPEC.task.board


def sent(message: Any) -> Any:
    """What arrives when a message is sent."""
    return deserialize_message(serialize_message(message), type(message))


def said_in(trial: TrialSpec) -> tuple[list[Message], TrialRecord]:
    """Everything that is said in a trial, and its record."""
    messages: list[Message] = []
    proposals = SAID_BY_PERSON if trial == HUMAN else ()
    record = run_trial(trial, observe=messages.append, proposals=proposals)
    return messages, record


@cache
def said_in_example() -> tuple[list[Message], TrialRecord]:
    """The trial that the examples are of."""
    return said_in(SPEC)


@cache
def examples() -> dict[str, Any]:
    """The longest message of each topic that is said in a trial, by the name of the topic."""
    messages = [*said_in_example()[0], Held(SPEC.trial_id, 3)]
    messages += [message for message in said_in(HUMAN)[0] if isinstance(message, ProposalMade)]
    longest: dict[str, Any] = {}
    for message in messages:
        topic = TOPIC_OF.get(type(message))
        if topic is not None:
            carried = topic.to_ros(BOARD, message)
            before = longest.get(topic.name)
            if before is None or len(serialize_message(before)) < len(serialize_message(carried)):
                longest[topic.name] = carried
    return longest


def example(topic: Topic) -> Any:
    """A copy of a real message, no two parts of which are one."""
    return sent(examples()[topic.name])


_WHOLE = {'uint8': 8, 'uint32': 32, 'uint64': 64}
_SIGNED = {'int32': 32, 'int64': 64}
_WORDS = ['', 'nonsense', 'BFS', 'bfs ', 'success', 'cancelled', 'ü' * 200]
_FLOATS = [float('nan'), float('inf'), float('-inf'), -1.0, 0.0, 1e308, 5e-324]


def values_of(kind: str) -> list[Any]:
    """Values to try in a field, all of which a message can carry."""
    if kind in _WHOLE:
        bits = _WHOLE[kind]
        return [0, 1, 2, 5, 16, 17, 127, 2 ** (bits - 1), 2**bits - 1]
    if kind in _SIGNED:
        most = 2 ** (_SIGNED[kind] - 1) - 1
        return [-most - 1, -2, -1, 0, 1, most]
    others: dict[str, list[Any]] = {
        'boolean': [False, True],
        'string': _WORDS,
        'double': _FLOATS,
        'float': [float('nan'), float('inf'), -1.0, 0.0, 0.5, 2.0],
        'sequence<uint8>': [b'', b'\0', b'\2', b'\1' * 3, b'\1' * 300, bytes(range(256))],
        'sequence<uint32>': [[], [0], [1, 0], [99], [2**32 - 1], [0] * 5000],
        'sequence<int32>': [[], [0], [-1], [2**31 - 1], [1] * 17],
    }
    return others[kind]


def fields(message: Any, path: str = '') -> Iterator[tuple[Any, str, str, str]]:
    """Every plain field at any depth: its owner, its name, its type, its path."""
    for name, kind in message.get_fields_and_field_types().items():
        here = f'{path}{name}'
        value = getattr(message, name)
        if name in ('header', 'reason', 'stimulus', 'trial_id'):
            continue  # anything goes, or PartNode looks at it
        if kind.startswith('sequence<') and '/' in kind:
            for index, item in enumerate(value):
                yield from fields(item, f'{here}[{index}].')
            yield message, name, kind, here
        elif '/' in kind:
            yield from fields(value, f'{here}.')
        else:
            yield message, name, kind, here


def changed_lists(value: list[Any]) -> list[list[Any]]:
    """Lists that lack something, have too much, or are in another order."""
    return [[], value[:-1], value[1:], value[::-1], value * 2, value * 40]


def set_field(path: str, value: Any) -> Callable[[Any], None]:
    """A change of one field, such as ``decisions[0].chosen``."""

    def change(message: Any) -> None:
        *owners, name = path.replace('[', '.').replace(']', '').split('.')
        for owner in owners:
            message = message[int(owner)] if owner.isdecimal() else getattr(message, owner)
        setattr(message, name, value)

    return change
