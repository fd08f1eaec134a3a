"""Reading records, with an error for everything that :mod:`.record` would not write."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from blocks_planning.errors import InvalidInput, RecordError, shown
from blocks_planning.trials import version1, version2
from blocks_planning.trials.fields import Fields
from blocks_planning.trials.record import FORMAT, VERSION, TrialRecord


def read_records(path: Path | str) -> list[TrialRecord]:
    """Read a file of records: one per line, or a single one over several lines.

    Raises:
        RecordError: if the file can't be read, is empty, or a record is not well formed; the
            message names file, line and key.
    """
    try:
        text = Path(path).read_text(encoding='utf-8')
    except UnicodeDecodeError as error:
        raise RecordError(f'{path}: is not a text file (byte {error.start})') from None
    except OSError as error:
        raise RecordError(f'{path}: cannot be read: {error.strerror}') from None
    except ValueError as error:  # a NUL in the path
        raise RecordError(f'{str(path)!r}: cannot be read: {error}') from None
    lines = [(n, line) for n, line in enumerate(text.split('\n'), start=1) if line.strip()]
    if not lines:
        raise RecordError(f'{path}: is empty, expected trial records')
    if lines[0][1].rstrip() == '{':
        return [record_from_json(_parse(text, str(path)), str(path))]
    places = [(f'{path}, line {number}', line) for number, line in lines]
    return [record_from_json(_parse(line, place), place) for place, line in places]


def _parse(text: str, place: str) -> object:
    try:
        return json.loads(
            text, parse_constant=_finite, parse_float=_finite, object_pairs_hook=_object
        )
    except (ValueError, RecursionError) as error:
        raise RecordError(f'{place}: is not JSON: {error}') from None


def _finite(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f'{text} is not a finite number')
    return number


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) < len(pairs):
        keys = [key for key, _ in pairs]
        doubled = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f'key {shown(doubled)} appears twice')
    return found


class RecordTail:
    """Follows a file that records are appended to."""

    def __init__(self, path: Path) -> None:
        """Begin at the current end of the file."""
        self._path = path
        self._offset = path.stat().st_size

    def read(self) -> list[TrialRecord]:
        """The records that were finished since the last call.

        Raises:
            RecordError: if one is not well formed.
        """
        with self._path.open('rb') as file:
            file.seek(self._offset)
            whole = file.read().rpartition(b'\n')[0]
        lines = whole.decode().split('\n') if whole else []
        self._offset += len(whole) + bool(whole)
        return [record_from_json(_parse(line, str(self._path)), str(self._path)) for line in lines]


def record_from_json(data: object, place: str) -> TrialRecord:
    """The record in ``data``, which :meth:`TrialRecord.to_json` wrote in any version of the format.

    Raises:
        RecordError: with a message that begins with ``place``, if a key is missing or unknown, or a
            value has the wrong type, is out of range, or contradicts the rest.
    """
    fields = Fields(data, place)
    version = fields.get('version', int) if fields.get('format', str) == FORMAT else None
    if version not in _VERSIONS:
        known = ' or '.join(map(str, _VERSIONS))
        raise RecordError(f'{place}: expected format {FORMAT!r}, version {known}')
    read, write = _VERSIONS[version]
    try:
        record = read(fields)
    except InvalidInput as error:
        if isinstance(error, RecordError):
            raise
        raise RecordError(f'{place}: {error}') from None
    fields.compare(write(record))
    return record


_VERSIONS: dict[int, tuple[Callable[[Fields], TrialRecord], Callable[[TrialRecord], Any]]] = {
    1: (version1.read, version1.write),
    VERSION: (version2.read, TrialRecord.to_json),
}
