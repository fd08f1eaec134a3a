"""The folder of a sweep: its manifest, its tables, and parts while it runs.

::

    DIR/manifest.json       the sweep, with versions and machine
    DIR/trials.parquet      see :mod:`.tables`; written at the end
    DIR/decisions.parquet
    DIR/placements.parquet
    DIR/parts/ID/           the tables of each chunk, until the end

A part is written under another name and then renamed, so an existing part is complete. The parts
on disk determine which chunks are missing. Their tables are Arrow files, which are written and read
several times as fast as Parquet; parts that an earlier version left in Parquet are read as well.
"""

from __future__ import annotations

import json
import shutil
from pathlib import Path
from typing import Any

from blocks_planning.errors import ConfigurationError
from blocks_planning.experiments.spec import Chunk, SweepSpec
from blocks_planning.experiments.tables import Tables, join
from blocks_planning.extras import extra

with extra('experiments'):
    import pyarrow as pa
    import pyarrow.parquet as pq

MANIFEST = 'manifest.json'


class Store:
    """The folder of one sweep.

    Raises:
        ConfigurationError: if the folder can't be created, or contains another sweep.
    """

    def __init__(self, folder: Path, sweep: SweepSpec) -> None:
        self.folder = folder
        self._sweep = sweep
        self._parts = folder / 'parts'
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise ConfigurationError(f'--out {folder}: {error.strerror}') from None
        there = self.manifest()
        if there and there.get('sweep_id') != sweep.sweep_id:
            raise ConfigurationError(
                f'--out {folder}: contains another sweep ({there.get("sweep_id")}, not '
                f'{sweep.sweep_id}); choose another folder'
            )

    def manifest(self) -> dict[str, Any]:
        """The content of the manifest; empty if there is none.

        Raises:
            ConfigurationError: if the file is not a manifest.
        """
        path = self.folder / MANIFEST
        if not path.exists():
            return {}
        try:
            found = json.loads(path.read_text(encoding='utf-8'))
        except (OSError, ValueError):
            found = None
        if not isinstance(found, dict):
            raise ConfigurationError(f'{path}: is not the manifest of a sweep')
        return found

    def write_manifest(self, manifest: dict[str, Any]) -> None:
        """Write the manifest atomically."""
        part = self.folder / f'{MANIFEST}.part'
        part.write_text(json.dumps(manifest, indent=2) + '\n', encoding='utf-8')
        part.replace(self.folder / MANIFEST)

    @property
    def is_complete(self) -> bool:
        """Whether the tables exist."""
        return all((self.folder / f'{name}.parquet').is_file() for name in Tables._fields)

    def missing(self) -> list[Chunk]:
        """The chunks that have not been run yet."""
        chunks = self._sweep.chunks()
        return [chunk for chunk in chunks if not self._part(chunk).is_dir()]

    def add(self, chunk: Chunk, tables: Tables) -> None:
        """Keep the tables of a chunk."""
        half = self._parts / f'{chunk.chunk_id}.half'
        shutil.rmtree(half, ignore_errors=True)
        half.mkdir(parents=True)
        for name, table in zip(Tables._fields, tables, strict=True):
            with pa.ipc.new_file(half / f'{name}.arrow', table.schema) as file:
                file.write_table(table)
        half.rename(self._part(chunk))

    def _part(self, chunk: Chunk) -> Path:
        return self._parts / chunk.chunk_id

    def _read(self, chunk: Chunk) -> Tables:
        return Tables(*(_read_part(self._part(chunk), name) for name in Tables._fields))

    def finish(self) -> None:
        """Write the tables from all parts, in the order of the sweep, and delete the parts."""
        half = self.folder / 'tables.half'
        shutil.rmtree(half, ignore_errors=True)
        half.mkdir()
        tables = join([self._read(chunk) for chunk in self._sweep.chunks()])
        for name, table in zip(Tables._fields, tables, strict=True):
            pq.write_table(table, half / f'{name}.parquet', compression='zstd')
        for name in reversed(Tables._fields):
            (half / f'{name}.parquet').replace(self.folder / f'{name}.parquet')
        half.rmdir()
        shutil.rmtree(self._parts)


def _read_part(part: Path, name: str) -> pa.Table:
    path = part / f'{name}.arrow'
    if not path.is_file():
        return read_table(part, name)
    return pa.ipc.open_file(pa.memory_map(str(path))).read_all()


def read_table(folder: Path, name: str, columns: list[str] | None = None) -> pa.Table:
    """One of the tables of a finished sweep, all columns or some.

    Raises:
        ConfigurationError: if the folder has none.
    """
    path = folder / f'{name}.parquet'
    if not path.is_file():
        raise ConfigurationError(f'{path}: does not exist; has the sweep been finished?')
    return pq.read_table(path, columns=columns)
