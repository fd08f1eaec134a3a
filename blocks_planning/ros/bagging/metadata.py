"""``metadata.yaml`` of a bag: version 9, as rosbag2 of ROS 2 Jazzy writes it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import yaml

from blocks_planning import __version__

METADATA = 'metadata.yaml'
VERSION = 9
STORAGE = 'mcap'
LIBRARY = f'blocks_planning {__version__}'
"""Name of the writer of a file; also in its header."""
NEVER_NS = 2**63 - 1
"""The starting time of a file without messages."""


class RecordedTopic(NamedTuple):
    """A topic of a bag.

    Attributes:
        name: with its namespace, such as ``/trial``.
        ros_type: such as ``blocks_planning_msgs/msg/TrialSpec``.
        definition: text of the message and of all messages in it.
        type_hash: of the definition, ``RIHS01_...``.
        offered_qos: the profiles of its publishers, a list in YAML.
    """

    name: str
    ros_type: str
    definition: str
    type_hash: str
    offered_qos: str


class FileSummary(NamedTuple):
    """The content of one file of a bag; times are those of receipt, in nanoseconds since 1970."""

    name: str
    topics: Sequence[RecordedTopic]
    counts: Mapping[str, int]
    start_ns: int = NEVER_NS
    end_ns: int = NEVER_NS

    @property
    def messages(self) -> int:
        """Number of messages."""
        return sum(self.counts.values())


def information(files: Sequence[FileSummary]) -> dict[str, Any]:
    """The metadata of a bag, from its files."""
    topics = {topic.name: topic for file in files for topic in file.topics}
    filled = [file for file in files if file.messages]
    return {
        'version': VERSION,
        'storage_identifier': STORAGE,
        **_times(filled),
        'message_count': sum(file.messages for file in files),
        'topics_with_message_count': [
            {
                'topic_metadata': {
                    'name': topic.name,
                    'type': topic.ros_type,
                    'serialization_format': 'cdr',
                    'offered_qos_profiles': from_yaml(topic.offered_qos) or [],
                    'type_description_hash': topic.type_hash,
                },
                'message_count': sum(file.counts.get(topic.name, 0) for file in files),
            }
            for topic in topics.values()
        ],
        'compression_format': '',
        'compression_mode': '',
        'relative_file_paths': [file.name for file in files],
        'files': [
            {
                'path': file.name,
                **_times([file] if file.messages else []),
                'message_count': file.messages,
            }
            for file in files
        ],
        'custom_data': {'recorder': LIBRARY},
        'ros_distro': os.environ.get('ROS_DISTRO', 'jazzy'),
    }


def _times(files: Sequence[FileSummary]) -> dict[str, dict[str, int]]:
    start_ns = min((file.start_ns for file in files), default=NEVER_NS)
    end_ns = max((file.end_ns for file in files), default=NEVER_NS)
    return {
        'duration': {'nanoseconds': end_ns - start_ns},
        'starting_time': {'nanoseconds_since_epoch': start_ns},
    }


def from_yaml(text: str) -> Any:
    """The content of a YAML text; None if it cannot be read."""
    try:
        return yaml.safe_load(text)
    except Exception:  # noqa: BLE001  PyYAML raises many kinds of exceptions for bad values
        return None


def to_yaml(content: object) -> str:
    """YAML in block style, in the given order."""
    text: str = yaml.safe_dump(content, sort_keys=False, allow_unicode=True)
    return text


def write_metadata(directory: Path, files: Sequence[FileSummary]) -> None:
    """Write ``metadata.yaml`` atomically.

    Raises:
        OSError: if it cannot be written.
    """
    temporary = directory / f'{METADATA}.new'
    with temporary.open('w', encoding='utf-8') as file:
        file.write(to_yaml({'rosbag2_bagfile_information': information(files)}))
        file.flush()
        os.fsync(file.fileno())
    temporary.replace(directory / METADATA)
    sync_directory(directory)


def listed_files(directory: Path) -> Iterable[str] | None:
    """The files that ``metadata.yaml`` lists; None if the file is missing or invalid."""
    try:
        content = from_yaml((directory / METADATA).read_text(encoding='utf-8'))
        names = content['rosbag2_bagfile_information']['relative_file_paths']
        return [Path(str(name)).name for name in names or ()]
    except (OSError, ValueError, KeyError, TypeError):
        return None


def sync_directory(directory: Path) -> None:
    """Flush the names of a directory to disk."""
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
