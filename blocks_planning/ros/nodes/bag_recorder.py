"""Node ``bag_recorder``: records all messages in a bag.

The bag is a rosbag2 directory of MCAP files, see :mod:`.bagging`. Killing the node, or a power
cut, loses at most the last ``flush_period_s``; after a restart it repairs the bag and continues.
When the disk is full it warns once, keeps the messages for a while, and tries again.

| | |
|---|---|
| subscribes | every topic |
| parameters | `bag_dir`: a folder that does not exist, or holds a truncated bag; `flush_period_s`: period of writing to disk; `split_bytes`: file size at which another file begins, 0: never |
"""

from __future__ import annotations

import time
from functools import partial
from pathlib import Path
from typing import Any

from rclpy.qos import QoSProfile

from blocks_planning.ros.bagging.definitions import definition_of, type_hash_of
from blocks_planning.ros.bagging.metadata import RecordedTopic, to_yaml
from blocks_planning.ros.bagging.writer import BagWriter
from blocks_planning.ros.runtime.diagnostics import Diagnostics, Health
from blocks_planning.ros.runtime.guarded import GuardedNode
from blocks_planning.ros.runtime.parameters import Parameter, declare
from blocks_planning.ros.runtime.peers import Peers
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.graph import BAG_RECORDER
from blocks_planning.ros.wire.topics import VIEW_TOPICS, Topic, ViewTopic

BAG_DIR = Parameter('bag_dir', 'bag', 'Folder of the bag: a new one, or of a truncated bag.')
FLUSH_PERIOD = Parameter(
    'flush_period_s', 1.0, 'Period of writing all messages to disk [s].', (0.05, 60.0)
)
SPLIT_BYTES = Parameter(
    'split_bytes', 0, 'File size at which another file begins [bytes]; 0: never.', (0, 2**40)
)
PARAMETERS = (BAG_DIR, FLUSH_PERIOD, SPLIT_BYTES)
_FOREVER = {'sec': 9223372036, 'nsec': 854775807}


class BagRecorder(GuardedNode):
    """Passes every message, unchanged, to a :class:`BagWriter`."""

    drain_s = 0.1
    """Time to receive the remaining messages before the end [s]."""

    def __init__(self, **options: Any) -> None:
        """Open the bag, then subscribe.

        Raises:
            BagError: if the bag can't be written.
            ConfigurationError: for a parameter that is unknown or out of its range.
        """
        super().__init__(BAG_RECORDER.name, **options)
        values = declare(self, PARAMETERS)
        self._path = Path(values['bag_dir'])
        recorded: list[Topic | ViewTopic] = [*BAG_RECORDER.listens, *VIEW_TOPICS]
        topics = {topic: self.resolve_topic_name(topic.name) for topic in recorded}
        self._writer = BagWriter(
            self._path,
            [recorded_topic(topic, name) for topic, name in topics.items()],
            values['split_bytes'],
        )
        self._failure = ''
        for repair in self._writer.repairs:
            self.get_logger().warning(str(repair))
        for topic, name in topics.items():
            self.take_bytes(topic, partial(self._record, name))
        self.create_timer(values['flush_period_s'], self._flush, clock=self.steady)
        self._peers = Peers(self)
        self._diagnostics = Diagnostics(self, self.health)

    @property
    def count(self) -> int:
        """Number of messages received."""
        return self._writer.counts.total()

    def health(self) -> Health:
        """The health of the recorder."""
        counts = {'messages_recorded': self.count, 'messages_lost': self._writer.lost}
        around = self._peers.around(BAG_RECORDER)
        return Health('recording', '', *around, failure=self._failure, values=counts)

    def _record(self, topic: str, data: bytes, info: dict[str, int]) -> None:
        received_ns = info['received_timestamp'] or time.time_ns()
        is_time = self._writer.add(topic, data, received_ns, info['source_timestamp'])
        if is_time and not self._failure:
            self._flush()

    def _flush(self) -> None:
        try:
            self._writer.flush()
        except OSError as error:
            if not self._failure:
                self._failure = f'{self._path}: cannot be written: {error.strerror}'
                self.get_logger().error(
                    f'{self._failure}; the written part is kept, and writing is tried again'
                )
            return
        if self._failure:
            lost = self._writer.lost
            self.get_logger().warning(
                f'{self._path}: writing works again; {lost} messages were lost'
            )
        self._failure = ''

    def finish(self) -> None:
        """Finish the bag; no message may be received after that."""
        try:
            self._writer.close()
        except OSError as error:
            self.get_logger().error(
                f'{self._path}: cannot be finished: {error.strerror}; the written part is kept; '
                '`blocks-planning verify` repairs it'
            )


def recorded_topic(topic: Topic | ViewTopic, name: str) -> RecordedTopic:
    """The metadata of a topic in a bag."""
    package, ros_type = topic.ros_type.__module__.split('.')[0], topic.ros_type.__name__
    full_type = f'{package}/msg/{ros_type}'
    return RecordedTopic(
        name=name,
        ros_type=full_type,
        definition=definition_of(full_type),
        type_hash=type_hash_of(full_type),
        offered_qos=to_yaml([offered_qos(topic.publisher_qos)]),
    )


def offered_qos(profile: QoSProfile) -> dict[str, Any]:
    """A profile as rosbag2 writes it; unlimited durations are written as infinite."""
    return {
        'history': profile.history.short_key,
        'depth': profile.depth,
        'reliability': profile.reliability.short_key,
        'durability': profile.durability.short_key,
        'deadline': dict(_FOREVER),
        'lifespan': dict(_FOREVER),
        'liveliness': 'automatic',
        'liveliness_lease_duration': dict(_FOREVER),
        'avoid_ros_namespace_conventions': profile.avoid_ros_namespace_conventions,
    }


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: BagRecorder())


if __name__ == '__main__':
    main()
