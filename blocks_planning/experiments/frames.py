"""Everything in some records, as pandas frames.

The frames ``trials``, ``decisions``, ``placements`` and ``observations`` have the columns of the
tables of a sweep (:mod:`.tables`). Sweeps do not keep the other two:

``candidates``  a row per candidate of every decision
``proposals``   a row per proposal of a person

``trial_id`` joins them; ``decision`` joins candidates to decisions.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from blocks_planning.experiments.tables import make_tables
from blocks_planning.extras import extra
from blocks_planning.trials.record import TrialRecord

with extra('experiments'):
    import pandas as pd

_CANDIDATE = {
    'trial_id': 'object',
    'decision': 'int64',
    'candidate': 'int64',
    'regions': 'object',  # labels of the chain, in order
    'cells': 'int64',  # r, that the chain adds
    'planning_cost': 'int64',  # c [states]
    'value': 'float64',  # V = r - lambda * c [cells]; nan if unsolved
    'probability': 'float64',  # of being chosen; nan if the choice is not random
    'status': 'object',
    'chosen': 'bool',
}
_PROPOSAL = {
    'trial_id': 'object',
    'sequence': 'int64',
    'number': 'int64',
    'kind': 'object',
    'region': 'object',  # the cells as they were drawn, as a hexadecimal mask
    'thinking_s': 'float64',
}


class Frames(NamedTuple):
    """The frames of some records."""

    trials: pd.DataFrame
    decisions: pd.DataFrame
    candidates: pd.DataFrame
    placements: pd.DataFrame
    observations: pd.DataFrame
    proposals: pd.DataFrame


def frames(records: Iterable[TrialRecord], name: str = '') -> Frames:
    """The frames of some records, in their order.

    Args:
        records: of trials.
        name: of the experiment, for the column ``experiment`` of trials.
    """
    records = list(records)
    tables = make_tables(name, records)
    return Frames(
        trials=tables.trials.to_pandas(),
        decisions=tables.decisions.to_pandas(),
        candidates=_frame(_candidates(records), _CANDIDATE),
        placements=tables.placements.to_pandas(),
        observations=tables.observations.to_pandas(),
        proposals=_frame(_proposals(records), _PROPOSAL),
    )


def _frame(rows: Iterator[dict[str, Any]], types: dict[str, str]) -> pd.DataFrame:
    return pd.DataFrame(list(rows), columns=list(types)).astype(types)


def _candidates(records: list[TrialRecord]) -> Iterator[dict[str, Any]]:
    for record in records:
        for decision, entry in enumerate(record.decisions):
            for number, candidate in enumerate(entry.decision.candidates):
                yield {
                    'trial_id': record.spec.trial_id,
                    'decision': decision,
                    'candidate': number,
                    'regions': [str(region.label) for region in candidate.regions],
                    'cells': candidate.cells,
                    'planning_cost': candidate.planning_cost,
                    'value': candidate.value,
                    'probability': candidate.probability,
                    'status': candidate.status.value,
                    'chosen': number == entry.decision.chosen,
                }


def _proposals(records: list[TrialRecord]) -> Iterator[dict[str, Any]]:
    for record in records:
        for proposal in record.proposals:
            yield {
                'trial_id': record.spec.trial_id,
                'sequence': proposal.sequence,
                'number': proposal.number,
                'kind': proposal.kind.value,
                'region': hex(proposal.region),
                'thinking_s': proposal.thinking_s,
            }
