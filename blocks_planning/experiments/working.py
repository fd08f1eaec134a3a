"""Runs a chunk of a sweep and returns its tables; in any process on any machine."""

from __future__ import annotations

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
    for group in chunk.groups():
        answers: dict[Query, SolveResult] = {}
        outcomes += [_run(spec, answers) for spec in group]
    return make_tables(chunk.experiment.name, outcomes)


def _run(spec: TrialSpec, answers: dict[Query, SolveResult]) -> TrialRecord | Failure:
    try:
        record = follow(spec, answers)
    except Exception as error:  # noqa: BLE001  it is stored and shown, and the sweep fails
        return Failure(spec, f'{type(error).__name__}: {error}')
    if ended_at_a_limit(record):
        return Failure(spec, f'{spec.search.name}: the search would have exceeded its memory')
    return record
