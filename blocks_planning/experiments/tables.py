"""The three tables of a sweep: one row per trial, per decision, per placement.

``trials``      who built what from which seed, how it ended, and what it cost [states]
``decisions``   each time a planner chose: what it considered, and what it went for
``placements``  each block that was placed, where it came to rest [cells]

``trial_id`` joins them. A trial that could not be run has status ``failed`` and says why in
``error``; its numbers are empty, and it has no rows in the other tables.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.extras import extra
from blocks_planning.subgoals.decision import Decision
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec

with extra('experiments'):
    import pyarrow as pa

FAILED = 'failed'

_WORD = pa.dictionary(pa.int32(), pa.string())

TRIALS = pa.schema(
    [
        ('trial_id', pa.string()),
        ('experiment', _WORD),
        ('stimulus', _WORD),
        ('strategy', _WORD),
        ('lambda', pa.float64()),
        ('commit', _WORD),
        ('search', _WORD),
        ('depth', pa.int32()),
        ('iterations', pa.int32()),
        ('divisor', _WORD),
        ('execute', _WORD),
        ('seed', pa.uint64()),
        ('budget', pa.int64()),
        ('status', _WORD),
        ('error', pa.string()),
        ('blocks', pa.int32()),
        ('subgoals', pa.int32()),
        ('action_planning_cost', pa.int64()),
        ('subgoal_planning_cost', pa.int64()),
        ('solution_cost', pa.int64()),
    ]
)
DECISIONS = pa.schema(
    [
        ('trial_id', _WORD),
        ('decision', pa.int32()),
        ('placed', pa.int32()),  # blocks before it
        ('built', pa.string()),  # the state, as a hexadecimal mask
        ('candidates', pa.int32()),
        ('solved', pa.int32()),  # candidates that are
        ('rows', pa.list_(pa.int32())),  # heights of the chosen regions; none if it gave up
        ('cells', pa.int32()),  # that the chosen candidate adds
        ('planning_cost', pa.int64()),  # of the chosen candidate
        ('value', pa.float64()),  # of the chosen candidate, if anything was weighed
        ('executed', pa.int32()),  # subgoals begun
        ('considered', pa.int64()),  # planning cost of all candidates
        ('subgoal_planning_cost', pa.int64()),
    ]
)
PLACEMENTS = pa.schema(
    [
        ('trial_id', _WORD),
        ('placement', pa.int32()),
        ('width', pa.int8()),
        ('height', pa.int8()),
        ('column', pa.int8()),
        ('row', pa.int8()),
    ]
)


class Tables(NamedTuple):
    """The tables of a sweep, or of a part of it."""

    trials: pa.Table
    decisions: pa.Table
    placements: pa.Table


SCHEMAS = Tables(TRIALS, DECISIONS, PLACEMENTS)


class Failure(NamedTuple):
    """A trial that could not be run, and why."""

    spec: TrialSpec
    error: str


def make_tables(experiment: str, outcomes: Sequence[TrialRecord | Failure]) -> Tables:
    """The tables of some trials, in their order."""
    records = [outcome for outcome in outcomes if isinstance(outcome, TrialRecord)]
    trials = [_trial_row(experiment, outcome) for outcome in outcomes]
    decisions = [
        {'trial_id': record.spec.trial_id, 'decision': index, **_decision_row(entry)}
        for record in records
        for index, entry in enumerate(record.decisions)
    ]
    return Tables(
        pa.Table.from_pylist(trials, TRIALS),
        pa.Table.from_pylist(decisions, DECISIONS),
        _placement_table(records),
    )


def _trial_row(experiment: str, outcome: TrialRecord | Failure) -> dict[str, Any]:
    known = outcome.spec.to_json()
    row = {'trial_id': outcome.spec.trial_id, 'experiment': experiment}
    row |= {key: known[key] for key in ('stimulus', 'strategy', 'lambda', 'commit', 'search')}
    row |= known['search_settings']
    row |= {'seed': known['seed'], 'budget': known['budget']}
    if isinstance(outcome, Failure):
        return {**row, 'status': FAILED, 'error': outcome.error}
    return {
        **row,
        'status': outcome.status.value,
        'blocks': outcome.blocks,
        'subgoals': outcome.subgoals,
        'action_planning_cost': outcome.action_planning_cost,
        'subgoal_planning_cost': outcome.subgoal_planning_cost,
        'solution_cost': outcome.solution_cost,
    }


def _decision_row(entry: DecisionRecord) -> dict[str, Any]:
    decision = entry.decision
    row = {
        'placed': entry.placed,
        'built': hex(decision.built),
        'candidates': len(decision.candidates),
        'solved': sum(candidate.status == 'solved' for candidate in decision.candidates),
        'executed': entry.executed,
        'considered': sum(candidate.planning_cost for candidate in decision.candidates),
        'subgoal_planning_cost': decision.subgoal_planning_cost,
    }
    return {**row, **_chosen(decision)}


def _chosen(decision: Decision) -> dict[str, Any]:
    if decision.chosen is None:
        return {'rows': []}
    candidate = decision.candidates[decision.chosen]
    return {
        'rows': list(candidate.heights),
        'cells': candidate.cells,
        'planning_cost': candidate.planning_cost,
        'value': candidate.value,
    }


def _placement_table(records: Sequence[TrialRecord]) -> pa.Table:
    """One row per placement; there are many, so they are handled as arrays."""
    blocks = [record.blocks for record in records]
    names = pa.array([record.spec.trial_id for record in records], pa.string())
    codes = np.repeat(np.arange(len(records), dtype=np.int32), blocks)
    numbers = [np.arange(count, dtype=np.int32) for count in blocks]
    placed = [placed for record in records for placed in record.placements]
    columns = np.array(placed, np.int8).reshape(-1, 4).T
    return pa.Table.from_arrays(
        [
            pa.DictionaryArray.from_arrays(codes, names),
            np.concatenate([np.empty(0, np.int32), *numbers]),
            *map(np.ascontiguousarray, columns),
        ],
        schema=PLACEMENTS,
    )


def join(parts: Sequence[Tables]) -> Tables:
    """Tables one below the other; equal rows give equal tables, however they were cut."""
    return Tables(
        *(
            pa.concat_tables(tables).unify_dictionaries().combine_chunks()
            if tables
            else schema.empty_table()
            for tables, schema in zip(
                list(zip(*parts, strict=True)) or [(), (), ()], SCHEMAS, strict=True
            )
        )
    )
