"""Choices of regions, extracted from trial records; only this module knows the form of records."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.search.searches import Search
from blocks_planning.settings import settings_of
from blocks_planning.subgoals.proposals import ProposalKind, proposed_at, target_of
from blocks_planning.trials.record import TrialRecord


class Asking(NamedTuple):
    """How the regions of a trial are solved; this determines the cost of a candidate."""

    search: Search
    seed: int
    budget: int


class ChoicePoint(NamedTuple):
    """A state, and the region that was chosen in it.

    Attributes:
        session: code of the participant, or 'seed N' for a planner.
        tower: name of the silhouette.
        task: the task.
        built: the state.
        cells: the cells that the chosen region adds.
        asking: how regions of the trial are solved.
    """

    session: str
    tower: str
    task: Task
    built: Mask
    cells: Mask
    asking: Asking


def points_of(records: Iterable[TrialRecord]) -> list[ChoicePoint]:
    """Every choice in some records, in order.

    A person's choices are all regions that were proposed to be built, including those that could
    not be built; withdrawn regions and giving up are not choices. A planner's choices are the first
    subgoals of its decisions.
    """
    return [point for record in records for point in _points(record)]


def _points(record: TrialRecord) -> Iterator[ChoicePoint]:
    spec = record.spec
    of_person = spec.strategy.asks_person
    session = str(settings_of(spec.strategy)['participant']) if of_person else f'seed {spec.seed}'
    asking = Asking(spec.search, spec.seed, spec.budget)
    for entry in record.decisions:
        built = entry.decision.built
        chosen = _drawn(record, entry.sequence, built) if of_person else _decided(entry.decision)
        for region in chosen:
            cells = region & spec.task.silhouette & ~built
            if cells:
                yield ChoicePoint(session, spec.stimulus, spec.task, built, cells, asking)


def _drawn(record: TrialRecord, placed: int, built: Mask) -> Iterator[Mask]:
    for proposal in proposed_at(record.proposals, placed):
        if proposal.kind is ProposalKind.BUILD:
            yield target_of(record.spec.task, built, proposal.region)


def _decided(decision: object) -> Iterator[Mask]:
    for subgoal in getattr(decision, 'subgoals', ())[:1]:
        yield subgoal.region.cells
