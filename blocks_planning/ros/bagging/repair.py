"""Repair of truncated bags."""

from __future__ import annotations

import fcntl
import os
import shutil
import struct
from collections.abc import Iterator
from io import BytesIO
from itertools import count
from pathlib import Path
from typing import BinaryIO, NamedTuple

from mcap.data_stream import ReadDataStream
from mcap.opcode import Opcode
from mcap.records import Channel, Chunk, Header, Message, Schema
from mcap.stream_reader import breakup_chunk
from mcap.writer import MCAP0_MAGIC

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.file import CHUNK_BYTES, PROFILE, BagFile, read_summary, topic_of
from blocks_planning.ros.bagging.metadata import (
    LIBRARY,
    FileSummary,
    listed_files,
    sync_directory,
    write_metadata,
)

_FRAME = struct.Struct('<BQ')  # opcode and length of a record
_DATA = (Opcode.HEADER, Opcode.CHUNK, Opcode.MESSAGE_INDEX, Opcode.METADATA)
"""The records of a file of this package before its index."""
_OURS = LIBRARY.split()[0]


class Repair(NamedTuple):
    """What was done to a file.

    Attributes:
        path: the file.
        messages: number of messages in it now.
        aside: file of the bytes that could not be read.
        aside_bytes: their number; if it is 0, ``aside`` does not exist.
    """

    path: Path
    messages: int
    aside: Path
    aside_bytes: int

    def __str__(self) -> str:
        said = f'{self.path}: was truncated; kept {self.messages} messages'
        if self.aside_bytes:
            said += f', moved the last {self.aside_bytes} bytes to {self.aside.name}'
        return said


def is_finished(bag: Path) -> bool:
    """Whether no repair is needed."""
    if not bag.is_dir():
        return bag.suffix != '.mcap' or read_summary(bag) is not None
    listed = listed_files(bag)
    files = _files_of(bag)
    if listed is None or not {file.name for file in files} <= set(listed):
        return False
    return all(read_summary(file) is not None for file in files)


class FileBegin(NamedTuple):
    """Time of the first message of a file [ns since 1970], and number of the file in its bag."""

    time_ns: int
    number: int


def file_begins(bag: Path) -> list[FileBegin]:
    """The beginnings of the MCAP files of a bag that have messages, in order.

    The numbers are those of the names, which include files without messages and moved ones. For a
    single file the list is empty.
    """
    found: list[FileBegin] = []
    for path in _files_of(bag) if bag.is_dir() else []:
        summary = read_summary(path)
        number = path.stem.rpartition('_')[2]
        if summary is not None and summary.messages:
            found.append(
                FileBegin(summary.start_ns, int(number) if number.isdecimal() else len(found))
            )
    return sorted(found)


def repair(bag: Path) -> list[Repair]:
    """Repair a bag, if it is truncated: a directory, or a single MCAP file.

    Raises:
        BagError: if it can't be repaired, or is being recorded; it is then unchanged.
    """
    try:
        if is_finished(bag):
            return []
        directory = bag if bag.is_dir() else bag.parent
        lock = claim(directory)
        try:
            if bag.is_dir():
                return repair_claimed(bag)[1]
            done = _repair_file(bag)
            return [] if done is None else [done]
        finally:
            os.close(lock)
    except OSError as error:
        raise BagError(f'{bag}: cannot be repaired: {error.strerror}') from None


def claim(directory: Path) -> int:
    """Lock a bag for writing, as long as the descriptor is open.

    Raises:
        BagError: if another process holds it.
    """
    descriptor = os.open(directory, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise BagError(f'{directory}: another process is recording it') from None
    return descriptor


def repair_claimed(directory: Path) -> tuple[list[FileSummary], list[Repair]]:
    """Repair a bag whose lock is held by the caller.

    Returns:
        (content of its files, repairs)

    Raises:
        BagError: if it can't be repaired.
        OSError: if it cannot be written.
    """
    repairs = [_repair_file(path) for path in _files_of(directory) if read_summary(path) is None]
    summaries = [read_summary(path) for path in _files_of(directory)]
    found = [summary for summary in summaries if summary is not None]
    if found:
        write_metadata(directory, found)
    return found, [done for done in repairs if done is not None]


def _files_of(directory: Path) -> list[Path]:
    """The MCAP files of a bag, in the order in which they were written."""
    return sorted(directory.glob('*.mcap'), key=lambda path: (len(path.name), path.name))


def _repair_file(path: Path) -> Repair | None:
    """Replace a file by a new one with all messages that can be read from it."""
    aside = _free_name(path)
    with path.open('rb') as file:
        size = os.fstat(file.fileno()).st_size
        if _is_torn_header(file.read(len(_header())), path):
            path.rename(aside)
            sync_directory(path.parent)
            return Repair(path, 0, aside, size)
        temporary = path.with_name(f'{path.name}.mending')
        temporary.unlink(missing_ok=True)
        try:
            whole = BagFile(temporary, path.name)
            end = _copy_messages(file, size, whole)
            whole.close()
            if end < size:
                file.seek(end)
                _copy_rest(file, aside)
        except OSError:
            temporary.unlink(missing_ok=True)
            raise
    temporary.replace(path)
    sync_directory(path.parent)
    return Repair(path, whole.counts.total(), aside, size - end)


def _copy_rest(file: BinaryIO, path: Path) -> None:
    with path.open('xb') as rest:
        shutil.copyfileobj(file, rest)
        rest.flush()
        os.fsync(rest.fileno())


def _free_name(path: Path) -> Path:
    names = (path.with_name(f'{path.name}.torn{number or ""}') for number in count())
    return next(name for name in names if not name.exists())


def _header() -> bytes:
    """The first bytes of a file of this package."""
    stream = BytesIO()
    library, profile = LIBRARY.encode(), PROFILE.encode()
    body = b''.join(struct.pack('<I', len(text)) + text for text in (profile, library))
    stream.write(MCAP0_MAGIC + _FRAME.pack(Opcode.HEADER, len(body)) + body)
    return stream.getvalue()


def _is_torn_header(begin: bytes, path: Path) -> bool:
    """Whether a file ends before its first message.

    Raises:
        BagError: if this package did not write the file: another process may be writing it.
    """
    if len(begin) < len(_header()) and _header().startswith(begin):
        return True
    if not begin.startswith(MCAP0_MAGIC):
        raise BagError(f'{path}: is not an MCAP file')
    try:
        header = Header.read(ReadDataStream(BytesIO(begin[len(MCAP0_MAGIC) + _FRAME.size :])))
        library = header.library
    except Exception:  # noqa: BLE001  as below
        library = ''
    if not library.startswith(_OURS):
        raise BagError(
            f'{path}: has no index: it is truncated, or is being written; '
            f'only files that {_OURS} wrote can be repaired'
        )
    return False


def _copy_messages(file: BinaryIO, size: int, whole: BagFile) -> int:
    """Copy all readable messages; return the end of the readable part."""
    schemas: dict[int, Schema] = {}
    channels: dict[int, str] = {}
    end = len(MCAP0_MAGIC)
    for opcode, body, after in _records(file, size):
        if opcode not in _DATA or (opcode == Opcode.MESSAGE_INDEX and not _is_index(body)):
            break
        try:
            records = []
            if opcode == Opcode.CHUNK:
                chunk = Chunk.read(ReadDataStream(BytesIO(body)))
                records = breakup_chunk(chunk, validate_crc=True)
            for record in records:
                if isinstance(record, Schema):
                    schemas[record.id] = record
                elif isinstance(record, Channel) and record.id not in channels:
                    whole.add_topic(topic_of(record, schemas[record.schema_id]))
                    channels[record.id] = record.topic
            messages = [record for record in records if isinstance(record, Message)]
            topics = [channels[message.channel_id] for message in messages]
        except Exception:  # noqa: BLE001  damaged bytes can lead to any exception
            break
        for topic, message in zip(topics, messages, strict=True):
            whole.write(
                topic, message.data, message.log_time, message.publish_time, message.sequence
            )
        if whole.waiting > CHUNK_BYTES:
            whole.flush()
        end = after
    return end


def _is_index(body: bytes) -> bool:
    """Whether a record has the length of an index, and is not a chunk with a damaged opcode."""
    _, length = struct.unpack_from('<HI', body.ljust(6))
    return bool(length == len(body) - 6)


def _records(file: BinaryIO, size: int) -> Iterator[tuple[int, bytes, int]]:
    """The records of a file, each with its opcode and its end, up to the first truncated one."""
    place = len(MCAP0_MAGIC)
    while place + _FRAME.size <= size:
        file.seek(place)
        opcode, length = _FRAME.unpack(file.read(_FRAME.size))
        place += _FRAME.size + length
        if place > size:
            return
        yield opcode, file.read(length), place
