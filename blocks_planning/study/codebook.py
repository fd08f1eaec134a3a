"""The columns of the tables of a study: name, type, unit and meaning, described once."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import NamedTuple


class Column(NamedTuple):
    """A column; ``kind`` is ``str``, ``int``, ``float`` or ``bool``."""

    name: str
    kind: type
    unit: str
    meaning: str


_WHO = Column('participant', str, '', 'code of the participant')
_STEP = Column('step', int, '', 'step of the participant, from 0; names a trial of a participant')
_SEQUENCE = Column('sequence', int, '', 'number of blocks that were placed before, in this trial')
_AT = Column('at', str, 'UTC', 'when, on the clock of the wall')
_STEADY = Column('steady_s', float, 's', 'when, on a clock that never steps; see docs/study.md')
_RESULTS = (
    Column(
        'status', str, '', 'how it ended: success, stuck, gave_up, cancelled; empty: it did not'
    ),
    Column('reason', str, '', 'why it was cancelled'),
    Column('blocks', int, 'blocks', 'that stand at the end'),
    Column('recall', float, '0 to 1', 'share of the target cells that are filled'),
    Column('precision', float, '0 to 1', 'share of the filled cells that are target cells'),
    Column('f1', float, '0 to 1', 'harmonic mean of recall and precision'),
    Column('iou', float, '0 to 1', 'cells that are both, by cells that are either'),
)
TABLES: Mapping[str, tuple[Column, ...]] = MappingProxyType(
    {
        'participants': (
            _WHO,
            Column('number', int, '', 'of the participant, from 0; the orders follow from it'),
            Column('status', str, '', 'finished, stopped, declined, or running: none of these'),
            Column('began_at', str, 'UTC', 'first event'),
            Column('last_at', str, 'UTC', 'last event'),
            Column('visits', int, '', 'how often the page was connected'),
        ),
        'trials': (
            _WHO,
            _STEP,
            Column('phase', str, '', 'practice or trial'),
            Column('number', int, '', 'of the trial in its phase, from 1'),
            Column('condition', str, '', 'name of the condition'),
            Column('mode', str, '', 'what was done: scoping or building'),
            Column('tower', str, '', 'address of the silhouette'),
            Column('seed', int, '', 'of the trial'),
            Column('time_limit_s', int, 's', 'of the trial; 0: none'),
            Column('trial_id', str, '', 'names the record in records/CONDITION.jsonl'),
            Column('began_at', str, 'UTC', 'when the trial was first ready to be shown'),
            Column('ended_at', str, 'UTC', 'when it ended'),
            Column('proposals', int, '', 'regions or blocks that were proposed, or withdrawn'),
            Column(
                'refused', int, '', 'wishes that cannot be had, such as a block that sticks out'
            ),
            *_RESULTS,
        ),
        'proposals': (
            _WHO,
            _STEP,
            _SEQUENCE,
            Column('number', int, '', 'of the proposal in this state, from 0'),
            Column('kind', str, '', 'build, withdrawn or give_up'),
            Column('region', str, 'mask', 'cells, hexadecimal: bit column x height + row'),
            Column(
                'outcome', str, '', 'of kind build: built or failed; empty: the trial did not end'
            ),
            Column('thinking_s', float, 's', 'from seeing the state to proposing, on the page'),
            _AT,
            _STEADY,
        ),
        'placements': (
            _WHO,
            _STEP,
            Column('placement', int, '', 'number of the block in its trial, from 0'),
            Column('width', int, 'cells', 'of the block'),
            Column('height', int, 'cells', 'of the block'),
            Column('column', int, '', 'of its lower left cell, from 0 at the left'),
            Column('row', int, '', 'of its lower left cell, from 0 at the ground'),
        ),
        'pointer': (
            _WHO,
            _STEP,
            Column('page_s', float, 's', 'since the page was loaded'),
            Column('column', float, 'cells', 'from the left edge of the board'),
            Column('row', float, 'cells', 'from the ground upwards'),
        ),
        'events': (
            _WHO,
            _STEP,
            Column('event', int, '', 'number of the event, from 0'),
            Column('kind', str, '', 'what happened; docs/study.md lists the kinds'),
            _AT,
            _STEADY,
            Column('data', str, 'JSON', 'more of it, without records and pointer paths'),
        ),
    }
)
CODEBOOK = (
    Column('table', str, '', 'name of the table'),
    Column('column', str, '', 'name of the column'),
    Column('type', str, '', 'str, int, float or bool'),
    Column('unit', str, '', 'of the values; empty: none'),
    Column('meaning', str, '', 'of the values'),
)
"""The columns of the codebook itself."""


def codebook_rows() -> list[dict[str, object]]:
    """The codebook: a row for each column of each table."""
    return [
        {
            'table': table,
            'column': column.name,
            'type': column.kind.__name__,
            'unit': column.unit,
            'meaning': column.meaning,
        }
        for table, columns in TABLES.items()
        for column in columns
    ]
