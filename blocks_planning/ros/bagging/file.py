"""One file of a bag: messages in MCAP, written so that a crash loses only unflushed messages."""

from __future__ import annotations

import os
from collections import Counter
from pathlib import Path
from typing import IO, Any, cast

from mcap.reader import SeekingReader
from mcap.records import Channel, Schema
from mcap.writer import CompressionType, Writer

from blocks_planning.ros.bagging.metadata import (
    LIBRARY,
    FileSummary,
    RecordedTopic,
    information,
    sync_directory,
    to_yaml,
)

PROFILE = 'ros2'
CHUNK_BYTES = 2**20
_MESSAGE_OVERHEAD = 31  # [bytes]


class _Outbox:
    """The part of a file that is not on disk yet; it stays in memory while the disk is full."""

    def __init__(self, path: Path) -> None:
        self._disk = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o644)
        self._written = 0
        self._waiting = bytearray()

    def __len__(self) -> int:
        return len(self._waiting)

    def write(self, data: bytes) -> int:
        self._waiting += data
        return len(data)

    def tell(self) -> int:
        return self._written + len(self._waiting)

    def flush(self) -> None:
        """Required by the writer; does nothing."""

    def send(self) -> None:
        """Write everything to disk, or leave the file unchanged."""
        sent = 0
        try:
            with memoryview(self._waiting) as waiting:
                while sent < len(waiting):
                    sent += os.write(self._disk, waiting[sent:])
            os.fsync(self._disk)
        except OSError:
            os.ftruncate(self._disk, self._written)
            os.lseek(self._disk, self._written, os.SEEK_SET)
            raise
        self._written += sent
        self._waiting.clear()

    def close(self) -> None:
        os.close(self._disk)


class BagFile:
    """A file that is being written.

    Attributes:
        counts: number of messages by topic.
    """

    def __init__(self, path: Path, name: str | None = None) -> None:
        """Create the file, which must not exist.

        Args:
            path: where to write it.
            name: its final name, if that differs from ``path``.

        Raises:
            OSError: if it cannot be written.
        """
        self.name = name or path.name
        self.counts: Counter[str] = Counter()
        self._start_ns, self._end_ns = 2**63 - 1, 0
        self._topics: dict[str, tuple[int, RecordedTopic]] = {}
        self._schemas: dict[str, int] = {}
        self._in_chunk = 0
        self._outbox = _Outbox(path)
        self._writer = Writer(
            cast(IO[Any], self._outbox), compression=CompressionType.ZSTD, chunk_size=CHUNK_BYTES
        )
        self._writer.start(PROFILE, LIBRARY)
        self._outbox.send()
        sync_directory(path.parent)

    def add_topic(self, topic: RecordedTopic) -> None:
        """Register a topic, once, before its first message."""
        schema = self._schemas.get(topic.ros_type)
        if schema is None:
            schema = self._writer.register_schema(
                topic.ros_type, 'ros2msg', topic.definition.encode()
            )
            self._schemas[topic.ros_type] = schema
        metadata = {'offered_qos_profiles': topic.offered_qos, 'topic_type_hash': topic.type_hash}
        channel = self._writer.register_channel(topic.name, 'cdr', schema, metadata)
        self._topics[topic.name] = (channel, topic)

    def write(self, topic: str, data: bytes, received_ns: int, sent_ns: int, number: int) -> None:
        """Add a message; it is on disk after the next :meth:`flush`."""
        channel, _ = self._topics[topic]
        waiting = len(self._outbox)
        self._in_chunk += _MESSAGE_OVERHEAD + len(data)
        self._writer.add_message(channel, received_ns, data, sent_ns, number)
        if len(self._outbox) > waiting:
            self._in_chunk = 0
        self.counts[topic] += 1
        self._start_ns = min(self._start_ns, received_ns)
        self._end_ns = max(self._end_ns, received_ns)

    @property
    def waiting(self) -> int:
        """Size of the part that is not on disk yet [bytes]."""
        return len(self._outbox) + self._in_chunk

    @property
    def size(self) -> int:
        """Size of the file including the part that is not on disk yet [bytes]."""
        return self._outbox.tell() + self._in_chunk

    def flush(self) -> None:
        """Write all messages to disk.

        Raises:
            OSError: if they cannot be written; they wait for the next flush.
        """
        self._writer.flush()
        self._in_chunk = 0
        if self._outbox:
            self._outbox.send()

    def summary(self) -> FileSummary:
        """The content of the file, including waiting messages."""
        topics = [topic for _, topic in self._topics.values()]
        if not self.counts:
            return FileSummary(self.name, topics, {})
        return FileSummary(self.name, topics, dict(self.counts), self._start_ns, self._end_ns)

    def close(self) -> None:
        """Add the index. If that fails, the file stays as it was after the last flush.

        Raises:
            OSError: if it cannot be written.
        """
        try:
            self.flush()
            text = to_yaml(information([self.summary()]))
            self._writer.add_metadata('rosbag2', {'serialized_metadata': text})
            self._writer.finish()
            self._outbox.send()
        finally:
            self._outbox.close()


def read_summary(path: Path) -> FileSummary | None:
    """The content of a file; None if it does not end with its index.

    Raises:
        OSError: if it can't be opened.
    """
    with path.open('rb') as file:
        try:
            size = path.stat().st_size
            summary = SeekingReader(file, record_size_limit=size).get_summary()
            if summary is None or summary.statistics is None:
                return None
            topics = {
                number: topic_of(channel, summary.schemas[channel.schema_id])
                for number, channel in summary.channels.items()
            }
            statistics = summary.statistics
            counts: Counter[str] = Counter()
            for number, count in statistics.channel_message_counts.items():
                counts[topics[number].name] += count
        except Exception:  # noqa: BLE001  damaged bytes can lead to any exception
            return None
    if not counts.total():
        return FileSummary(path.name, list(topics.values()), {})
    return FileSummary(
        path.name,
        list(topics.values()),
        counts,
        statistics.message_start_time,
        statistics.message_end_time,
    )


def topic_of(channel: Channel, schema: Schema) -> RecordedTopic:
    """The topic of a channel."""
    return RecordedTopic(
        name=channel.topic,
        ros_type=schema.name,
        definition=schema.data.decode(),
        type_hash=channel.metadata.get('topic_type_hash', ''),
        offered_qos=channel.metadata.get('offered_qos_profiles', ''),
    )
