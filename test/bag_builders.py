"""Bags of trials, made without a graph, and bags read by what others wrote."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)

import yaml
from builders import CHAIR, NEVER_SOLVED, ODD, SQUARE, spec
from mcap.exceptions import EndOfFile
from mcap.reader import make_reader
from mcap.records import Message as McapMessage
from mcap.stream_reader import StreamReader
from rclpy.serialization import deserialize_message, serialize_message
from rosbags.highlevel import AnyReader

from blocks_planning.ros.bagging.bags import RecordedTrial, trials_of
from blocks_planning.ros.bagging.writer import BagWriter
from blocks_planning.ros.nodes.bag_recorder import recorded_topic
from blocks_planning.ros.wire.topics import TOPICS, Topic
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

SPECS = [
    spec(SQUARE, stimulus='square', search='bfs', depth=1),
    spec(CHAIR, stimulus='chair'),
    spec(CHAIR, stimulus='chair', strategy='full', lam=0.5, search='random'),
    spec(ODD, stimulus='odd', strategy='none', search='exact'),
    spec(NEVER_SOLVED, stimulus='never'),
]
START_NS = 1_700_000_000_000_000_000
_TOPIC_OF = {topic.kind: topic for topic in TOPICS}
_BY_NAME = {topic.name: topic for topic in TOPICS}


@dataclass(frozen=True)
class Said:
    """A message of a graph."""

    topic: Topic
    message: Any

    @cached_property
    def data(self) -> bytes:
        """As it travels; the bytes between fields are not the same every time."""
        return bytes(serialize_message(self.message))


def trial_said(spec: TrialSpec) -> tuple[TrialRecord, list[Said]]:
    """The record of a trial, and all that is said on a graph while it runs."""
    heard: list[Message] = []
    record = run_trial(spec, CancelToken(), heard.append)
    return record, said_of(spec, heard)


def said_of(spec: TrialSpec, heard: Iterable[Message]) -> list[Said]:
    """What is said on a graph, for messages of a trial."""
    found = ((_TOPIC_OF.get(type(message)), message) for message in heard)
    return [
        Said(topic, topic.to_ros(spec.task.board, message)) for topic, message in found if topic
    ]


def open_bag(path: Path, **options: Any) -> BagWriter:
    """A bag for every topic, in the namespace of nobody."""
    topics = [recorded_topic(topic, f'/{topic.name}') for topic in TOPICS]
    return BagWriter(path, topics, **options)


def add_all(writer: BagWriter, said: Iterable[Said], *, flush_after: int = 10**9) -> None:
    """Write messages, one a millisecond, with a flush after every so many."""
    begin = writer.counts.total()
    for number, one in enumerate(said, start=begin):
        time_ns = START_NS + number * 1_000_000
        writer.add(f'/{one.topic.name}', one.data, time_ns, time_ns - 1000)
        if (number + 1) % flush_after == 0:
            writer.flush()


def write_bag(path: Path, said: Iterable[Said], **options: Any) -> Path:
    """A finished bag."""
    writer = open_bag(path)
    add_all(writer, said, **options)
    writer.close()
    return path


def changed_bag(bag: Path, path: Path, change: Callable[[Said], Said | None]) -> Path:
    """A copy of a bag with some messages changed, or left out."""
    with AnyReader([bag]) as reader:
        said = [
            Said(topic, deserialize_message(data, topic.ros_type))
            for connection, _, data in reader.messages()
            for topic in [_BY_NAME[connection.topic.removeprefix('/')]]
        ]
    changed = (change(one) for one in said)
    return write_bag(path, [one for one in changed if one is not None])


def contents(bag: Path) -> list[tuple[str, int, bytes]]:
    """Topic, time and bytes of every message of a finished bag, in order."""
    metadata = yaml.safe_load((bag / 'metadata.yaml').read_text(encoding='utf-8'))
    found = []
    for name in metadata['rosbag2_bagfile_information']['relative_file_paths']:
        with (bag / name).open('rb') as file:
            for _, channel, message in make_reader(file, validate_crcs=True).iter_messages():
                found.append((channel.topic, message.log_time, message.data))
    return found


def flushed(bag: Path) -> int:
    """Number of messages that are on disk, finished or not."""
    return sum(1 for path in sorted(bag.glob('*.mcap')) for _ in _messages_on_disk(path))


def _messages_on_disk(path: Path) -> Iterator[McapMessage]:
    with path.open('rb') as file:
        try:
            for record in StreamReader(file).records:
                if isinstance(record, McapMessage):
                    yield record
        except (EndOfFile, Exception):  # noqa: BLE001  a file that is being written
            return


def held_complaints(bag: Path) -> list[str]:
    refused: list[str] = []
    found = [
        sentence for one in trials_of(bag, refused.append) for sentence in one.contradictions()
    ]
    return refused + found


def only_trial(bag: Path) -> RecordedTrial:
    [trial] = trials_of(bag)
    return trial
