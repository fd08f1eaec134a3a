"""The tables of a sweep.

``trials``        a row per trial: planner, world, seed, status, costs [states] and measures
``decisions``     a row per decision: the candidates and the choice
``placements``    a row per block that stands at the end [cells]
``observations``  a row per observation after the first: the order, and the blocks that landed
                  or are gone; only for worlds that may deviate from orders, because in others
                  each observation equals its order

``trial_id`` joins them. A trial that could not be run has status ``failed`` and the reason in
``error``; its numbers are empty, and it has no rows in the other tables.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.board.geometry import Board
from blocks_planning.extras import extra
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Decision
from blocks_planning.trials.flat import FlatSetting, flat_settings, flat_values
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import FAMILIES, TrialSpec

with extra('experiments'):
    import pyarrow as pa

FAILED = 'failed'

_WORD = pa.dictionary(pa.int32(), pa.string())

_TYPES = {bool: pa.bool_(), int: pa.int64(), float: pa.float64(), str: _WORD}
_MEASURES = ('recall', 'precision', 'f1', 'iou')
_COSTS = ('action_planning_cost', 'subgoal_planning_cost', 'solution_cost')


def trials_schema() -> pa.Schema:
    """The columns of the table of trials: one for each setting of each family."""
    return pa.schema(
        [
            ('trial_id', pa.string()),
            ('experiment', _WORD),
            ('stimulus', _WORD),
            *((family, _WORD) for family in FAMILIES),
            *((flat.name, _TYPES[flat.kind]) for flat in flat_settings()),
            ('seed', pa.uint64()),
            ('budget', pa.int64()),
            ('status', _WORD),
            ('error', pa.string()),
            *((name, pa.int32()) for name in ('blocks', 'orders', 'surprises', 'subgoals')),
            *((name, pa.int64()) for name in _COSTS),
            *((name, pa.float64()) for name in _MEASURES),
        ]
    )


DECISIONS = pa.schema(
    [
        ('trial_id', _WORD),
        ('decision', pa.int32()),
        ('sequence', pa.int32()),  # of the observation in whose state it was made
        ('built', pa.string()),  # the state, as a hexadecimal mask
        ('candidates', pa.int32()),
        ('sequences', pa.int64()),  # chains that exist; more than the candidates if sampled
        ('solved', pa.int32()),  # number of solved candidates
        ('regions', pa.list_(pa.string())),  # labels of the chosen regions; empty if it gave up
        ('tops', pa.list_(pa.int32())),  # number of rows up to the top of each chosen region
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


OBSERVATIONS = pa.schema(
    [
        ('trial_id', _WORD),
        ('sequence', pa.int32()),
        ('ordered', pa.list_(pa.int8())),  # width, height, column; null if nothing was ordered
        ('landed', pa.list_(pa.list_(pa.int8()))),  # width, height, column, row of each block
        ('gone', pa.list_(pa.list_(pa.int8()))),  # the same of blocks that stood before
        ('as_ordered', pa.bool_()),
    ]
)


class Tables(NamedTuple):
    """The tables of a sweep, or of a part of it."""

    trials: pa.Table
    decisions: pa.Table
    placements: pa.Table
    observations: pa.Table


def schemas() -> Tables:
    """The schema of each table."""
    return Tables(trials_schema(), DECISIONS, PLACEMENTS, OBSERVATIONS)


class Failure(NamedTuple):
    """A trial that could not be run, and the reason."""

    spec: TrialSpec
    error: str


def make_tables(experiment: str, outcomes: Sequence[TrialRecord | Failure]) -> Tables:
    """The tables of some trials, in their order."""
    records = [outcome for outcome in outcomes if isinstance(outcome, TrialRecord)]
    settings = flat_settings()
    trials = [_trial_row(experiment, outcome, settings) for outcome in outcomes]
    decisions = [
        {'trial_id': record.spec.trial_id, 'decision': index, **_decision_row(record, entry)}
        for record in records
        for index, entry in enumerate(record.decisions)
    ]
    return Tables(
        pa.Table.from_pylist(trials, trials_schema()),
        pa.Table.from_pylist(decisions, DECISIONS),
        _placement_table(records),
        pa.Table.from_pylist(list(_observation_rows(records)), OBSERVATIONS),
    )


def _trial_row(
    experiment: str, outcome: TrialRecord | Failure, settings: list[FlatSetting]
) -> dict[str, Any]:
    spec = outcome.spec
    row = {
        'trial_id': spec.trial_id,
        'experiment': experiment,
        'stimulus': spec.stimulus,
        **{family: getattr(spec, family).name for family in FAMILIES},
        **flat_values(spec, settings),
        'seed': spec.seed,
        'budget': spec.budget,
    }
    if isinstance(outcome, Failure):
        return {**row, 'status': FAILED, 'error': outcome.error}
    return {**row, 'status': outcome.status.value, **outcome.summary()}


def _decision_row(record: TrialRecord, entry: DecisionRecord) -> dict[str, Any]:
    decision, candidates = entry.decision, entry.decision.candidates
    row = {
        'sequence': entry.sequence,
        'built': hex(decision.built),
        'candidates': len(candidates),
        'sequences': decision.sequences,
        'solved': [candidate.status for candidate in candidates].count(SolveStatus.SOLVED),
        'executed': entry.executed,
        'considered': sum([candidate.planning_cost for candidate in candidates]),
        'subgoal_planning_cost': decision.subgoal_planning_cost,
    }
    return {**row, **_chosen(decision, record.spec.task.board)}


def _chosen(decision: Decision, board: Board) -> dict[str, Any]:
    if decision.chosen is None:
        return {'regions': [], 'tops': []}
    candidate = decision.candidates[decision.chosen]
    return {
        'regions': [str(region.label) for region in candidate.regions],
        'tops': [board.rows_up_to(region.cells) for region in candidate.regions],
        'cells': candidate.cells,
        'planning_cost': candidate.planning_cost,
        'value': candidate.value,
    }


def _observation_rows(records: Sequence[TrialRecord]) -> Iterator[dict[str, Any]]:
    """A row per observation after the first, of trials whose world may deviate from orders."""
    for record in records:
        if record.spec.world.obeys:
            continue
        for sequence, seen in enumerate(record.observations[1:], start=1):
            yield {
                'trial_id': record.spec.trial_id,
                'sequence': sequence,
                'ordered': seen.ordered and [*seen.ordered.block, seen.ordered.column],
                'landed': [list(placed) for placed in seen.landed],
                'gone': [list(placed) for placed in seen.gone],
                'as_ordered': seen.is_as_ordered,
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
    """Tables concatenated; the result does not depend on how the rows were divided."""
    return Tables(
        *(
            pa.concat_tables(tables).unify_dictionaries().combine_chunks()
            if tables
            else schema.empty_table()
            for tables, schema in zip(
                list(zip(*parts, strict=True)) or [(), (), (), ()], schemas(), strict=True
            )
        )
    )
