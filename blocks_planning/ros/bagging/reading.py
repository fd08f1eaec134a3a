"""Reads the messages of a bag from which trials are rebuilt, without any middleware."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Container, Iterator
from pathlib import Path
from typing import Any, NamedTuple

from rosbags.highlevel import AnyReader

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.repair import file_begins, is_finished

_PACKAGE = 'blocks_planning_msgs/msg/'
MOST_LETTERS = 200
"""Of the message of a library about a damaged file."""


class BagMessage(NamedTuple):
    """A message of a bag.

    Attributes:
        kind: name of its type.
        message: decoded with its definition in the bag; None if its bytes are invalid.
        file: number of its file in the bag.
    """

    kind: str
    message: Any
    file: int


def messages_of(bag: Path, kinds: Container[str]) -> Iterator[BagMessage]:
    """The messages of some kinds, in the order of recording.

    Raises:
        BagError: if the bag can't be read, or is truncated and has to be repaired first.
    """
    if not bag.exists():
        raise BagError(f'{bag}: does not exist')
    try:
        finished = is_finished(bag)
        if not finished and bag.is_dir() and not any(bag.glob('*.mcap')):
            raise BagError(f'{bag}: is not a bag that can be read')
    except OSError as error:
        raise BagError(f'{bag}: cannot be read: {error.strerror}') from None
    if not finished:
        raise BagError(f'{bag}: is truncated; `blocks-planning verify {bag}` repairs it')
    source = _read(bag, kinds)
    while True:
        try:
            entry = next(source, None)
        except Exception as error:  # noqa: BLE001  a damaged file can lead to any
            reason = ' '.join(str(error).split()) or type(error).__name__
            raise BagError(f'{bag}: cannot be read: {reason[:MOST_LETTERS]}') from None
        if entry is None:
            return
        yield entry


def _read(bag: Path, kinds: Container[str]) -> Iterator[BagMessage]:
    begins = file_begins(bag)
    times_ns = [begin.time_ns for begin in begins]
    with AnyReader([bag]) as reader:
        names = {
            connection.msgtype: connection.msgtype.removeprefix(_PACKAGE)
            for connection in reader.connections
        }
        connections = [c for c in reader.connections if names[c.msgtype] in kinds]
        if not connections:
            return
        for connection, received_ns, data in reader.messages(connections):
            try:
                message = reader.deserialize(data, connection.msgtype)
            except Exception:  # noqa: BLE001  damaged bytes can lead to any
                message = None
            place = bisect_right(times_ns, received_ns) - 1
            file = begins[place].number if place >= 0 else 0
            yield BagMessage(names[connection.msgtype], message, file)
