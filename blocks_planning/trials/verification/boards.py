"""Do the observations follow from the orders, and does the last one give the status?"""

from __future__ import annotations

from collections.abc import Iterator

from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of
from blocks_planning.worlds.observation import (
    Observation,
    blocks_after,
    history_of,
    impossible,
    mask_of,
    wrong_change,
)


def wrong_observations(record: TrialRecord) -> Iterator[str]:
    """The first observation that cannot have been made in the world of the trial."""
    spec = record.spec
    observations = record.observations
    if not observations:
        return
    if spec.world.simulates and observations[0] != Observation(landed=spec.built):
        yield 'observation 0 differs from the board at the start of the trial'
        return
    before = history_of(observations)
    for sequence, (seen, blocks) in enumerate(
        zip(observations[1:], before, strict=False), start=1
    ):
        built = mask_of(spec.task.board, blocks)
        reason = (
            wrong_change(blocks, seen)
            or spec.world.complaint(spec.task, blocks, built, seen, spec.seed, sequence)
            or impossible(spec.task.board, blocks_after(blocks, seen))
        )
        if reason:
            yield f'observation {sequence}: {reason}'
            return


def wrong_status(record: TrialRecord) -> Iterator[str]:
    """A status that contradicts the last observation and the last decision."""
    reached = status_of(record.spec, record.placements, record.built)
    over = reached is not TrialStatus.BUILDING
    gave_up = bool(record.decisions) and record.decisions[-1].decision.chosen is None
    # A trial may be cancelled before its end is observed, even if it was over at the start.
    may_be_cancelled = not gave_up and (not over or len(record.observations) <= 1)
    if record.status is TrialStatus.CANCELLED and may_be_cancelled:
        return
    if record.status is TrialStatus.COLLAPSED and not record.spec.world.simulates and not over:
        return  # in an observed world, only the observer can tell
    expected = reached if over else TrialStatus.GAVE_UP
    if record.status is not expected or (gave_up and over) or not (gave_up or over):
        yield (
            f'status {record.status.value!r}, but the placements give {reached.value!r} and '
            f'the planner {"gave up" if gave_up else "did not give up"}'
        )
    if record.reason and record.status is not TrialStatus.CANCELLED:
        yield f'a reason for cancelling is given, but the status is {record.status.value!r}'
