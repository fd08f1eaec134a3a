"""Verification: replays a record through the rules, and recomputes its decisions."""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verification.boards import wrong_observations, wrong_status
from blocks_planning.trials.verification.decisions import wrong_decision
from blocks_planning.trials.verification.executions import wrong_execution
from blocks_planning.trials.verification.proposals import wrong_proposals


def contradictions(record: TrialRecord) -> Iterator[str]:
    """A sentence for everything in a record that contradicts the rest.

    No search is run; :func:`differs_from_rerun` runs the trial again.
    """
    wrong = list(wrong_observations(record))
    yield from wrong
    if wrong:
        return
    yield from wrong_status(record)
    for index in range(len(record.decisions)):
        for sentence in wrong_decision(record, index):
            yield f'decision {index}: {sentence}'
    yield from wrong_proposals(record)
    yield from wrong_execution(record)


def can_be_rerun(spec: TrialSpec) -> bool:
    """Whether a trial can be run again here: nothing was observed, no other program took part."""
    return spec.world.simulates and not (spec.strategy.is_external or spec.search.is_external)


def differs_from_rerun(record: TrialRecord) -> Iterator[str]:
    """The differences from a new run of the trial."""
    if record.status is TrialStatus.CANCELLED or not can_be_rerun(record.spec):
        return
    again = run_trial(record.spec, proposals=record.proposals).to_json()
    for key, value in record.to_json().items():
        if again[key] != value:
            yield f'a new run gives another value of {key}'
