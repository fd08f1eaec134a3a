"""Visual scoping: look at a part of the silhouette, build it, look again."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.task import Task
from blocks_planning.settings import Configured, setting
from blocks_planning.subgoals.choosing import best, value_of
from blocks_planning.subgoals.decision import Candidate, Decision, Known, Query, subgoal_of
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.subgoals.regions import regions_above

COMMITS = ('subgoal', 'action')


@dataclass(frozen=True)
class Scoping(Configured):
    """One subgoal at a time, the one of highest value (paper, section "Visual scoping").

    It executes the whole plan of a 'subgoal' (the paper's text and numbers), or only its first
    'action'.
    """

    name: ClassVar[str] = 'scoping'
    asks_person: ClassVar[bool] = False
    lam: float = setting(
        0.002, 'Cost per evaluated state, in cells.', name='lambda', least=0, unit='cells / state'
    )
    commit: str = setting(
        'subgoal', 'Part of the plan executed before the next decision.', choices=COMMITS
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
        queries = [Query(built, region.cells) for region in regions]
        missing = [query for query in queries if query not in known]
        if missing:
            return missing
        results = [known[query] for query in queries]
        candidates = tuple(
            Candidate(
                heights=(region.height,),
                cells=(cells := area(region.cells) - area(built)),
                planning_cost=result.planning_cost,
                value=value_of(cells, result.planning_cost, self.lam) if result.solved else None,
                status=result.status,
            )
            for region, result in zip(regions, results, strict=True)
        )
        considered = sum(result.planning_cost for result in results)
        chosen = best(candidates, seed, built)
        if chosen is None:
            return Decision(built, candidates, None, (), considered)
        subgoal = subgoal_of(
            regions[chosen].height,
            queries[chosen],
            results[chosen],
            execute=1 if self.commit == 'action' else None,
        )
        return Decision(built, candidates, chosen, (subgoal,), considered)
