"""Runs a sweep from its specification to its tables; continues an interrupted one."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from blocks_planning.experiments.manifest import provenance
from blocks_planning.experiments.running import run_here, run_on_dask
from blocks_planning.experiments.spec import SweepSpec
from blocks_planning.experiments.store import Store, read_table
from blocks_planning.experiments.tables import FAILED
from blocks_planning.extras import extra

with extra('experiments'):
    import pyarrow.compute as pc

Report = Callable[[int, int], None]
"""Called with the number of finished trials and the number of all trials."""


@dataclass(frozen=True)
class Summary:
    """How a sweep ended.

    Attributes:
        trials: number of trials.
        statuses: number of trials by status.
        failures: reasons of failed trials, with the number of trials for each.
    """

    trials: int
    statuses: dict[str, int]
    failures: dict[str, int]

    @property
    def failed(self) -> int:
        """Number of trials that could not be run."""
        return self.statuses.get(FAILED, 0)


def run_sweep(
    sweep: SweepSpec,
    folder: Path,
    workers: int = 1,
    dask: str | None = None,
    report: Report | None = None,
) -> Summary:
    """Run the missing chunks of a sweep, and write its tables.

    Args:
        sweep: what to run.
        folder: folder of the tables; see :mod:`.store`.
        workers: processes of this machine.
        dask: address of a Dask scheduler to use instead.
        report: called at the start and after each chunk.

    Raises:
        ConfigurationError: if the folder contains another sweep, or Dask can't be reached.
    """
    store = Store(folder, sweep)
    if not store.is_complete:
        manifest = {
            'format': 'blocks_planning/sweep',
            'version': 1,
            'sweep_id': sweep.sweep_id,
            'sweep': sweep.to_json(),
            'provenance': provenance(),
        }
        store.write_manifest(manifest)
        _run_missing(sweep, store, workers, dask, report)
        store.finish()
    return summarise(folder)


def _run_missing(
    sweep: SweepSpec, store: Store, workers: int, dask: str | None, report: Report | None
) -> None:
    missing = store.missing()
    total = sum(chunk.trials for chunk in sweep.chunks())
    done = total - sum(chunk.trials for chunk in missing)
    if report:
        report(done, total)
    with closing(run_on_dask(missing, dask) if dask else run_here(missing, workers)) as results:
        for chunk, tables in results:
            store.add(chunk, tables)
            done += chunk.trials
            if report:
                report(done, total)


def summarise(folder: Path) -> Summary:
    """How a finished sweep ended.

    Raises:
        ConfigurationError: if the folder has no finished sweep.
    """
    trials = read_table(folder, 'trials', ['status', 'error'])
    return Summary(
        trials.num_rows,
        _counts(trials['status']),
        _counts(trials['error'].drop_null()),
    )


def _counts(column: Any) -> dict[str, int]:
    return {item['values']: item['counts'] for item in pc.value_counts(column).to_pylist()}
