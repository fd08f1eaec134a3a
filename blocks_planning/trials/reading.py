"""Reading records back, with an error for everything that is not as :mod:`.record` writes it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

from blocks_planning.board.blocks import Placed, parse_library
from blocks_planning.board.geometry import MAX_SIDE, Board, Mask
from blocks_planning.board.pictures import parse_silhouettes
from blocks_planning.board.task import Task
from blocks_planning.errors import InvalidInput, RecordError, shown
from blocks_planning.search.result import MAX_BUDGET, SolveStatus
from blocks_planning.search.searches import make_search
from blocks_planning.settings import setting_names
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.subgoals.registry import STRATEGIES, make_strategy
from blocks_planning.trials.record import FORMAT, VERSION, DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


def read_records(path: Path) -> list[TrialRecord]:
    """Read a file of records: one in a line, or a single one laid out over several.

    Raises:
        RecordError: if the file can't be read, is empty, or a record is not well formed; naming
            file, line and key.
    """
    try:
        text = path.read_text(encoding='utf-8')
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
        raise ValueError(f'key {shown(doubled)} stands twice')
    return found


class RecordTail:
    """Follows a file that records are appended to."""

    def __init__(self, path: Path) -> None:
        """Begin at the end that the file has now."""
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
    """The record that :meth:`TrialRecord.to_json` wrote as ``data``.

    Raises:
        RecordError: beginning with ``place``, if a key is missing, unknown or of the wrong type,
            a value is out of its range, or a sum is not the sum of its parts.
    """
    fields = _Fields(data, place)
    if fields.get('format', str) != FORMAT or fields.get('version', int) != VERSION:
        raise RecordError(f'{place}: expected format {FORMAT!r}, version {VERSION}')
    try:
        record = TrialRecord(
            spec=_spec(fields),
            status=fields.word('status', TrialStatus),
            placements=fields.placements(),
            decisions=tuple(_decision(entry) for entry in fields.parts('decisions')),
            proposals=tuple(_proposal(entry) for entry in fields.parts('proposals')),
        )
    except InvalidInput as error:
        if isinstance(error, RecordError):
            raise
        raise RecordError(f'{place}: {error}') from None
    fields.compare(record.to_json())
    return record


def _spec(fields: _Fields) -> TrialSpec:
    name = fields.get('strategy', str)
    own = setting_names(STRATEGIES[name]) if name in STRATEGIES else []
    given = [key for key in ('lambda', 'commit') if fields.get(key) is not None]
    strategy = {key: fields.get(key) for key in dict.fromkeys([*given, *own])}
    return TrialSpec(
        stimulus=fields.get('stimulus', str),
        task=_task(fields),
        strategy=make_strategy(name, strategy),
        search=make_search(fields.get('search', str), fields.get('search_settings', dict)),
        seed=fields.get('seed', int),
        budget=fields.get('budget', int),
    )


def _task(fields: _Fields) -> Task:
    board = Board(fields.get('width', int), fields.get('height', int))
    rows = fields.get('silhouette', list)
    if not all(isinstance(row, str) for row in rows):
        raise fields.error('silhouette', 'must be a list of rows')
    text = '\n'.join(rows)
    pictures = list(parse_silhouettes(text, 'silhouette').values())
    if len(pictures) != 1 or pictures[0][0] != board:
        raise RecordError(
            f'{fields.place}: silhouette must have {board.height} rows of {board.width} cells'
        )
    library = parse_library(fields.get('library', str), 'library')
    return Task(board, pictures[0][1], library)


def _decision(fields: _Fields) -> DecisionRecord:
    chosen = fields.get('chosen')
    decision = Decision(
        built=fields.mask('built'),
        candidates=tuple(_candidate(part) for part in fields.parts('candidates')),
        chosen=None if chosen is None else fields.count('chosen'),
        subgoals=tuple(_subgoal(part) for part in fields.parts('subgoals')),
        subgoal_planning_cost=fields.count('subgoal_planning_cost'),
    )
    return DecisionRecord(fields.count('placed'), decision, fields.count('executed'))


def _proposal(fields: _Fields) -> Proposal:
    return Proposal(
        sequence=fields.count('placed'),
        number=fields.count('number'),
        kind=fields.word('kind', ProposalKind),
        region=fields.mask('region'),
        thinking_s=fields.get('thinking_s', float),
    )


def _candidate(fields: _Fields) -> Candidate:
    value = fields.get('value')
    return Candidate(
        heights=fields.numbers('rows'),
        cells=fields.count('cells'),
        planning_cost=fields.count('planning_cost'),
        value=None if value is None else fields.get('value', float),
        status=fields.word('status', SolveStatus),
    )


def _subgoal(fields: _Fields) -> Subgoal:
    height = fields.get('rows')
    return Subgoal(
        height=None if height is None else fields.count('rows'),
        region=fields.mask('region'),
        execute=fields.count('execute'),
        placements=fields.placements(),
        planning_cost=fields.count('planning_cost'),
        solution_cost=fields.count('solution_cost'),
        attempts=fields.count('attempts'),
    )


class _Fields:
    """A JSON object, and where it stands."""

    def __init__(self, data: object, place: str) -> None:
        if not isinstance(data, dict):
            raise RecordError(f'{place}: expected an object, got {_short(data)}')
        self.data: dict[str, Any] = data
        self.place = place

    def get(self, key: str, kind: type | None = None) -> Any:
        """The value of a key, of a JSON type."""
        if key not in self.data:
            raise RecordError(f'{self.place}: has no key {key!r}')
        value = self.data[key]
        if kind is not None and type(value) is not kind:
            raise self.error(key, f'must be of type {kind.__name__}')
        return value

    def error(self, key: str, what: str) -> RecordError:
        """An error about the value of a key."""
        return RecordError(f'{self.place}: {key} {what}, got {_short(self.data[key])}')

    def count(self, key: str) -> int:
        """A whole number that is not negative."""
        value: int = self.get(key, int)
        if not 0 <= value <= MAX_BUDGET:
            raise self.error(key, f'must be from 0 to {MAX_BUDGET}')
        return value

    def numbers(self, key: str, length: int | None = None) -> tuple[int, ...]:
        """A list of small whole numbers."""
        values = self.get(key, list)
        small = all(type(value) is int and 0 <= value <= MAX_SIDE for value in values)
        if not small or length not in (None, len(values)):
            many = '' if length is None else f'{length} '
            raise self.error(key, f'must be a list of {many}whole numbers from 0 to {MAX_SIDE}')
        return tuple(values)

    def mask(self, key: str) -> Mask:
        """A hexadecimal mask."""
        value = self.get(key, str)
        try:
            mask = int(value, 16)
        except ValueError:
            mask = -1
        if not 0 <= mask < 1 << MAX_SIDE * MAX_SIDE or hex(mask) != value:
            raise self.error(key, 'must be a hexadecimal mask such as 0x1f')
        return mask

    def word(self, key: str, words: Any) -> Any:
        """A member of an enumeration, by its value."""
        value = self.get(key, str)
        if value not in [word.value for word in words]:
            raise self.error(key, f'must be one of {", ".join(word.value for word in words)}')
        return words(value)

    def parts(self, key: str) -> list[_Fields]:
        """A list of objects."""
        values = self.get(key, list)
        return [
            _Fields(value, f'{self.place}, {key}[{index}]') for index, value in enumerate(values)
        ]

    def placements(self) -> tuple[Placed, ...]:
        """The list of placed blocks, each [width, height, column, row]."""
        listed = dict(enumerate(self.get('placements', list)))
        places = _Fields(
            {f'placements[{index}]': item for index, item in listed.items()}, self.place
        )
        placements = [Placed(*places.numbers(key, 4)) for key in places.data]
        for key, placed in zip(places.data, placements, strict=True):
            if not (placed.width and placed.height):
                raise places.error(key, 'must be of a block with width and height')
        return tuple(placements)

    def compare(self, expected: dict[str, Any]) -> None:
        """Refuse keys that do not belong here, and sums that are not the sums of their parts."""
        for key in self.data:
            if key not in expected:
                raise RecordError(f'{self.place}: unknown key {shown(key)}')
        # The name follows from much of the rest: what else is wrong says more.
        for key in sorted(self.data, key=lambda key: key == 'trial_id'):
            if not _same(self.data[key], expected[key]):
                what = f'contradicts the rest of the record, which gives {_short(expected[key])}'
                raise self.error(key, what)
        for key in expected:
            self.get(key)


def _same(one: object, other: object) -> bool:
    """Whether two JSON values are equal and of equal types: 1, 1.0 and true are not."""
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(_same(one[key], other[key]) for key in one)
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    return type(one) is type(other) and one == other


def _short(value: object) -> str:
    try:
        text = json.dumps(value)
    except RecursionError:
        text = 'something nested too deeply'
    return text if len(text) <= 60 else f'{text[:57]}...'
