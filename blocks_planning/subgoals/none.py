"""Planning without subgoals: the one subgoal is the whole silhouette."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.task import Task
from blocks_planning.settings import Configured
from blocks_planning.subgoals.decision import Candidate, Decision, Known, Query, subgoal_of
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.subgoals.regions import regions_above


@dataclass(frozen=True)
class NoSubgoals(Configured):
    """Action-level search for the whole tower (paper, "no subgoal planning")."""

    name: ClassVar[str] = 'none'
    asks_person: ClassVar[bool] = False

    def decide(
        self,
        task: Task,
        built: Mask,
        seed: int,
        known: Known,
        proposals: tuple[Proposal, ...] = (),
    ) -> list[Query] | Decision:
        """See :class:`Strategy`. Nothing is weighed, and considering costs nothing."""
        regions = regions_above(task, built)[-1:]
        if not regions:
            return Decision(built, (), None, (), 0)
        height, whole = regions[0]
        query = Query(built, whole)
        if query not in known:
            return [query]
        result = known[query]
        candidate = Candidate(
            (height,), area(whole) - area(built), result.planning_cost, None, result.status
        )
        if not result.solved:
            return Decision(built, (candidate,), None, (), 0)
        return Decision(built, (candidate,), 0, (subgoal_of(height, query, result),), 0)
