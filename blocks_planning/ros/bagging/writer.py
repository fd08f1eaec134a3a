"""Writer of a bag that survives a kill."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterable
from itertools import count
from pathlib import Path

from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.file import BagFile
from blocks_planning.ros.bagging.metadata import RecordedTopic, write_metadata
from blocks_planning.ros.bagging.repair import claim, is_finished, repair_claimed

FLUSH_BYTES = 2**20
MOST_WAITING_BYTES = 2**24
"""Size of waiting messages above which further ones are dropped, while the disk is full [bytes]."""


class BagWriter:
    """A bag that is being recorded.

    Attributes:
        repairs: what was done to repair the truncated bag before continuing it.
        counts: number of messages taken, by topic.
        lost: number of messages that were dropped because too much was waiting.
    """

    def __init__(self, path: Path, topics: Iterable[RecordedTopic], split_bytes: int = 0) -> None:
        """Begin a bag, or continue a truncated one.

        Args:
            path: its directory: one that does not exist, is empty, or holds a truncated bag.
            topics: all that will be recorded.
            split_bytes: file size at which another file begins [bytes]; 0: never.

        Raises:
            BagError: if the path holds something else, such as a finished bag, or can't be
                written.
        """
        self._path = path
        self._topics = list(topics)
        self._split_bytes = split_bytes
        self.counts: Counter[str] = Counter()
        self._is_whole = True
        self.lost = 0
        try:
            path.mkdir(parents=True, exist_ok=True)
            self._lock = claim(path)
            try:
                self._refuse_other_content()
                self._closed, self.repairs = repair_claimed(path)
                self._file = self._next_file()
            except BaseException:
                os.close(self._lock)
                raise
        except OSError as error:
            raise BagError(f'{path}: cannot be written: {error.strerror}') from None

    def _refuse_other_content(self) -> None:
        if any(self._path.iterdir()) and not any(self._path.glob('*.mcap*')):
            raise BagError(
                f'{self._path}: contains something that is not a bag; choose a new folder'
            )
        if any(self._path.glob('*.mcap')) and is_finished(self._path):
            raise BagError(f'{self._path}: contains a finished bag; choose a new folder')

    def _next_file(self) -> BagFile:
        name = self._path.resolve().name
        number = next(n for n in count() if not any(self._path.glob(f'*_{n}.mcap*')))
        file = BagFile(self._path / f'{name}_{number}.mcap')
        for topic in self._topics:
            file.add_topic(topic)
        return file

    def add(self, topic: str, data: bytes, received_ns: int, sent_ns: int) -> bool:
        """Add a message, in memory; return whether it is time to :meth:`flush`."""
        if self._file.waiting > MOST_WAITING_BYTES:
            self.lost += 1
            return True
        self.counts[topic] += 1
        self._file.write(topic, data, received_ns, sent_ns, self.counts[topic])
        return self._file.waiting >= FLUSH_BYTES or self._is_full()

    def _is_full(self) -> bool:
        return 0 < self._split_bytes <= self._file.size

    def flush(self) -> None:
        """Write all messages to disk, and begin another file if this one is large enough.

        Raises:
            OSError: if they cannot be written. They wait for the next flush, and the file
                stays as it was.
        """
        self._file.flush()
        if self._is_full():
            full, self._file = self._file, self._next_file()
            self._close_file(full)

    def _close_file(self, file: BagFile) -> None:
        self._is_whole = False
        file.close()
        self._is_whole = True
        self._closed.append(file.summary())

    def close(self) -> None:
        """Finish the bag. If that fails, the bag counts as truncated, and can be repaired.

        Raises:
            OSError: if it cannot be written.
        """
        try:
            was_whole = self._is_whole
            self._close_file(self._file)
            if was_whole:
                write_metadata(self._path, self._closed)
        finally:
            os.close(self._lock)
