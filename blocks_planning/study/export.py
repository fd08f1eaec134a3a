"""Writing the tables of a study, their codebook, and the records of its trials."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import MissingExtra, extra
from blocks_planning.study.codebook import CODEBOOK, TABLES, Column, codebook_rows
from blocks_planning.study.events import Event, EventKind
from blocks_planning.study.folder import kept_participants, read_study_json
from blocks_planning.study.log import read_events
from blocks_planning.study.machine import Status
from blocks_planning.study.tables import Row, runs_of, tables_of

RECORDS, PRACTICE = 'records', 'practice'
"""Folders of records, with a file for each condition."""


class Exported(NamedTuple):
    """What was written: files by name, and the number of rows or records in each."""

    files: dict[str, int]
    has_parquet: bool


def export_study(folder: Path, out: Path) -> Exported:
    """Write the tables of all participants as CSV, and as Parquet if that is installed.

    Args:
        folder: of the study; its sessions may be open.
        out: folder of the tables; files of an earlier export are replaced.

    Raises:
        ConfigurationError: if there is no study, or the tables can't be written.
        RecordError: if the events of a participant can't be read.
    """
    read_study_json(folder)
    tables: dict[str, list[Row]] = {name: [] for name in TABLES}
    lines: dict[str, list[str]] = {}
    for kept in kept_participants(folder):
        events = read_events(kept.folder)
        found = tables_of(kept.participant.code, _status(events).value, events)
        for name, rows in found.items():
            tables[name] += rows
        for run in runs_of(events):
            if run.record is not None:
                place = PRACTICE if run.is_practice else RECORDS
                name = f'{place}/{run.began.data["condition"]}.jsonl'
                lines.setdefault(name, []).append(run.record.to_line())
    try:
        return _write(out, tables, lines)
    except OSError as error:
        raise ConfigurationError(f'--out {out}: {error.strerror}') from None


def _write(out: Path, tables: dict[str, list[Row]], lines: dict[str, list[str]]) -> Exported:
    out.mkdir(parents=True, exist_ok=True)
    described = {**TABLES, 'codebook': CODEBOOK}
    all_rows: dict[str, list[Row]] = {**tables, 'codebook': codebook_rows()}
    files = {}
    for name, rows in all_rows.items():
        _write_csv(out / f'{name}.csv', described[name], rows)
        files[f'{name}.csv'] = len(rows)
    for path in (path for place in (RECORDS, PRACTICE) for path in (out / place).glob('*.jsonl')):
        path.unlink()  # its participants may have been deleted since the last export
    for name, texts in sorted(lines.items()):
        (out / name).parent.mkdir(exist_ok=True)
        (out / name).write_text(''.join(f'{text}\n' for text in texts), encoding='utf-8')
        files[name] = len(texts)
    try:
        for name, rows in all_rows.items():
            write_parquet(out / f'{name}.parquet', described[name], rows)
    except MissingExtra:
        return Exported(files, False)
    return Exported(files, True)


def _write_csv(path: Path, columns: Sequence[Column], rows: Sequence[Row]) -> None:
    with path.open('w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, [one.name for one in columns], lineterminator='\n')
        writer.writeheader()
        writer.writerows(rows)


def write_parquet(path: Path, columns: Sequence[Column], rows: Sequence[Row]) -> None:
    """Write a table as Parquet; what is missing in a row is null.

    Raises:
        MissingExtra: if pyarrow is not installed.
    """
    with extra('experiments'):
        import pyarrow as pa
        import pyarrow.parquet as pq
    types: dict[type, Any] = {
        str: pa.string(),
        int: pa.int64(),
        float: pa.float64(),
        bool: pa.bool_(),
    }
    schema = pa.schema([(column.name, types[column.kind]) for column in columns])
    pq.write_table(pa.Table.from_pylist(list(rows), schema), path)


def _status(events: Sequence[Event]) -> Status:
    """How far a participant is; the events say it without the steps."""
    kinds = {event.kind for event in events}
    ends = {
        EventKind.DECLINED: Status.DECLINED,
        EventKind.STOPPED: Status.STOPPED,
        EventKind.FINISHED: Status.FINISHED,
    }
    return next((status for kind, status in ends.items() if kind in kinds), Status.RUNNING)
