"""Runs a chunk of a sweep and returns its tables; in any process on any machine."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

from blocks_planning.experiments.spec import Chunk
from blocks_planning.experiments.tables import Failure, Tables, make_tables
from blocks_planning.trials.following import Shared, follow
from blocks_planning.trials.limits import ended_at_a_limit
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec


def run_chunk(chunk: Chunk) -> Tables:
    """Run the trials of a chunk, each solve once.

    A trial that can't be run becomes a row with the reason, so that one tower that exceeds a limit
    does not end a long sweep.
    """
    with _collector_paused():
        return _tables_of(chunk)


def _tables_of(chunk: Chunk) -> Tables:
    """The records end with this call, before the collector goes on: it would visit them all."""
    outcomes: list[TrialRecord | Failure] = []
    for group in chunk.groups():
        shared = Shared()
        outcomes += [_run(spec, shared) for spec in group]
    return make_tables(chunk.experiment.name, outcomes)


@contextmanager
def _collector_paused() -> Iterator[None]:
    """Without searches for cyclic garbage: records are many objects, and have no cycles."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def _run(spec: TrialSpec, shared: Shared) -> TrialRecord | Failure:
    try:
        record = follow(spec, shared)
    except Exception as error:  # noqa: BLE001  it is stored and shown, and the sweep fails
        return Failure(spec, f'{type(error).__name__}: {error}')
    if ended_at_a_limit(record):
        return Failure(spec, f'{spec.search.name}: the search would have exceeded its memory')
    return record
