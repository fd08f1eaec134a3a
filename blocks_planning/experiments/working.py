"""Runs a chunk of a sweep and returns its tables; in any process on any machine."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

from blocks_planning.experiments.spec import Chunk
from blocks_planning.experiments.tables import Failure, Tables, make_tables
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.following import follow
from blocks_planning.trials.limits import ended_at_a_limit
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec


def run_chunk(chunk: Chunk) -> Tables:
    """Run the trials of a chunk, each solve once.

    A trial that can't be run becomes a row with the reason, so that one tower that exceeds a limit
    does not end a long sweep.
    """
    outcomes: list[TrialRecord | Failure] = []
    with _collector_paused():
        for group in chunk.groups():
            answers: dict[Query, SolveResult] = {}
            outcomes += [_run(spec, answers) for spec in group]
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


def _run(spec: TrialSpec, answers: dict[Query, SolveResult]) -> TrialRecord | Failure:
    try:
        record = follow(spec, answers)
    except Exception as error:  # noqa: BLE001  it is stored and shown, and the sweep fails
        return Failure(spec, f'{type(error).__name__}: {error}')
    if ended_at_a_limit(record):
        return Failure(spec, f'{spec.search.name}: the search would have exceeded its memory')
    return record
