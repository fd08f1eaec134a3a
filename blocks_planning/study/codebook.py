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
_PHASE = Column('phase', str, '', 'practice or trial')
_CONDITION = Column('condition', str, '', 'name of the condition')
_TOWER = Column('tower', str, '', 'address of the silhouette')
_SEQUENCE = Column('sequence', int, '', 'number of blocks placed earlier in this trial')
_AT = Column('at', str, 'UTC', 'time of the event, on the wall clock')
_STEADY = Column(
    'steady_s', float, 's', 'time of the event, on a monotonic clock; see docs/study.md'
)
_RESULTS = (
    Column(
        'status',
        str,
        '',
        'end of the trial: success, stuck, gave_up or cancelled; empty: not ended',
    ),
    Column('reason', str, '', 'reason for the cancellation'),
    Column('blocks', int, 'blocks', 'number of blocks at the end'),
    Column('recall', float, '0 to 1', 'share of the target cells that are filled'),
    Column('precision', float, '0 to 1', 'share of the filled cells that are target cells'),
    Column('f1', float, '0 to 1', 'harmonic mean of recall and precision'),
    Column(
        'iou', float, '0 to 1', 'cells both filled and target, divided by cells filled or target'
    ),
)
TABLES: Mapping[str, tuple[Column, ...]] = MappingProxyType(
    {
        'participants': (
            _WHO,
            Column(
                'number', int, '', 'number of the participant, from 0; it determines the orders'
            ),
            Column('status', str, '', 'finished, stopped, declined or running'),
            Column('began_at', str, 'UTC', 'time of the first event'),
            Column('last_at', str, 'UTC', 'time of the last event'),
            Column('visits', int, '', 'number of connections of the page'),
        ),
        'trials': (
            _WHO,
            _STEP,
            _PHASE,
            Column('number', int, '', 'number of the trial in its phase, from 1'),
            _CONDITION,
            Column('mode', str, '', 'scoping or building'),
            _TOWER,
            Column('seed', int, '', 'seed of the trial'),
            Column('time_limit_s', int, 's', 'time limit of the trial; 0: none'),
            Column('trial_id', str, '', 'id of the record in records/CONDITION.jsonl'),
            Column('began_at', str, 'UTC', 'time at which the trial was first ready to be shown'),
            Column('ended_at', str, 'UTC', 'time of the end'),
            Column('proposals', int, '', 'number of proposed or withdrawn regions or blocks'),
            Column(
                'refused', int, '', 'number of refused requests, such as a block that sticks out'
            ),
            *_RESULTS,
        ),
        'proposals': (
            _WHO,
            _STEP,
            _SEQUENCE,
            Column('number', int, '', 'number of the proposal in this state, from 0'),
            Column('kind', str, '', 'build, withdrawn or give_up'),
            Column(
                'region', str, 'mask', 'cells as a hexadecimal number: bit column x height + row'
            ),
            Column(
                'outcome',
                str,
                '',
                'of a build proposal: built or failed; empty: the trial has not ended',
            ),
            Column(
                'thinking_s',
                float,
                's',
                'time from the display of the state to the proposal, on the page',
            ),
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
        'parts': (
            _WHO,
            Column('step', int, '', 'step of the participant, from 0; the trial is the next step'),
            _PHASE,
            _CONDITION,
            _TOWER,
            Column('part', int, '', 'number of the part in its silhouette, from 0'),
            Column('region', str, 'mask', 'cells that were drawn, as a hexadecimal number'),
            Column('cells', str, 'mask', 'cells of the part: those that belonged to no other yet'),
            Column('thinking_s', float, 's', 'time from the part before to this one, on the page'),
            _AT,
            _STEADY,
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
            Column('kind', str, '', 'kind of the event; see docs/study.md'),
            _AT,
            _STEADY,
            Column(
                'data', str, 'JSON', 'other data of the event, without records and pointer paths'
            ),
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
