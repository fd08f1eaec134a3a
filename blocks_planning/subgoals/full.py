"""Full-subgoal planning: all sequences of subgoals are weighed before the first block is placed.

A solved subgoal fills exactly its region, so the state in which the next one begins is that
region, whatever came before. The 2**(m-1) sequences of m regions therefore ask no more than
m (m + 1) / 2 different queries; each is counted in every sequence that asks it.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.task import Task
from blocks_planning.search.result import SolveStatus
from blocks_planning.settings import Configured, setting
from blocks_planning.subgoals.choosing import best, value_of
from blocks_planning.subgoals.decision import (
    Candidate,
    Decision,
    Known,
    Query,
    Subgoal,
    subgoal_of,
)
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.subgoals.regions import Region, regions_above


@dataclass(frozen=True)
class FullSubgoals(Configured):
    """The sequence of subgoals of highest value (paper, section "Full-subgoal planning").

    All complete sequences add the same cells, so any lambda above 0 prefers the cheapest.
    """

    name: ClassVar[str] = 'full'
    asks_person: ClassVar[bool] = False
    lam: float = setting(
        1.0, 'Cost per evaluated state, in cells.', name='lambda', above=0, unit='cells / state'
    )

    def decide(
        self,
        task: Task,
        built: Mask,
        seed: int,
        known: Known,
        proposals: tuple[Proposal, ...] = (),
    ) -> list[Query] | Decision:
        """See :class:`Strategy`."""
        regions = regions_above(task, built)
        missing = _unanswered(regions, built, known)
        if missing:
            return missing
        sequences = list(rising_sequences(regions))
        candidates = tuple(self._weigh(sequence, built, known) for sequence in sequences)
        considered = sum(candidate.planning_cost for candidate in candidates)
        chosen = best(candidates, seed, built)
        subgoals = () if chosen is None else tuple(_subgoals(sequences[chosen], built, known))
        return Decision(built, candidates, chosen, subgoals, considered)

    def _weigh(self, sequence: tuple[Region, ...], built: Mask, known: Known) -> Candidate:
        """A sequence with its cost up to its first unsolved subgoal."""
        cells = area(sequence[-1].cells) - area(built)
        cost = 0
        status = SolveStatus.SOLVED
        state = built
        for region in sequence:
            result = known[Query(state, region.cells)]
            cost += result.planning_cost
            status = result.status
            if not result.solved:
                break
            state = region.cells
        value = value_of(cells, cost, self.lam) if status is SolveStatus.SOLVED else None
        return Candidate(tuple(region.height for region in sequence), cells, cost, value, status)


def rising_sequences(regions: list[Region]) -> Iterator[tuple[Region, ...]]:
    """Every rising sequence of regions that ends in the last, in lexicographic order."""
    for index, region in enumerate(regions):
        rest = regions[index + 1 :]
        if not rest:
            yield (region,)
        for tail in rising_sequences(rest):
            yield (region, *tail)


def _unanswered(regions: list[Region], built: Mask, known: Known) -> list[Query]:
    """The queries from every state that solved subgoals are known to lead to."""
    missing = []
    reached = {built}
    for index, start in enumerate([built, *(region.cells for region in regions)]):
        if start not in reached:
            continue
        for region in regions[index:]:
            query = Query(start, region.cells)
            if query not in known:
                missing.append(query)
            elif known[query].solved:
                reached.add(region.cells)
    return missing


def _subgoals(sequence: tuple[Region, ...], built: Mask, known: Known) -> Iterator[Subgoal]:
    state = built
    for region in sequence:
        query = Query(state, region.cells)
        yield subgoal_of(region.height, query, known[query])
        state = region.cells
