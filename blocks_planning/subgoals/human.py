"""A person scopes: the paradigm that the paper announces in its discussion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.task import Task
from blocks_planning.settings import Configured, setting
from blocks_planning.subgoals.decision import Candidate, Decision, Known, Query, subgoal_of
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, decisive, target_of
from blocks_planning.subgoals.regions import height_of

COSTS = ('shown', 'hidden')


@dataclass(frozen=True)
class Human(Configured):
    """Regions of any shape, proposed by a person one after the other until one can be built."""

    name: ClassVar[str] = 'human'
    asks_person: ClassVar[bool] = True
    participant: str = setting(
        '',
        'Code of the person; no personal data.',
        pattern=r'[A-Za-z0-9_-]{0,32}',
        expected='a code of up to 32 letters, digits, _ and -',
    )
    costs: str = setting('shown', 'Whether the person sees the planning costs.', choices=COSTS)

    def decide(
        self,
        task: Task,
        built: Mask,
        seed: int,
        known: Known,
        proposals: tuple[Proposal, ...] = (),
    ) -> list[Query] | Decision:
        """See :class:`Strategy`. No query and no decision: it is the person's turn."""
        candidates: list[Candidate] = []
        for proposal in decisive(task, built, proposals):
            considered = sum(candidate.planning_cost for candidate in candidates)
            if proposal.kind is ProposalKind.GIVE_UP:
                return Decision(built, tuple(candidates), None, (), considered)
            query = Query(built, target_of(task, built, proposal.region))
            if query not in known:
                return [query]
            result = known[query]
            height = height_of(task, query.region)
            cost = result.planning_cost
            candidates.append(
                Candidate(
                    heights=() if height is None else (height,),
                    cells=area(query.region) - area(built),
                    planning_cost=cost,
                    value=None,
                    status=result.status,
                )
            )
            if result.solved:
                subgoal = subgoal_of(height, query, result)
                chosen = len(candidates) - 1
                return Decision(built, tuple(candidates), chosen, (subgoal,), considered + cost)
        return []


def used(task: Task, decision: Decision, proposals: tuple[Proposal, ...]) -> tuple[Proposal, ...]:
    """The proposals of a state that led to a decision: up to the one that decided."""
    asking = list(decisive(task, decision.built, proposals))
    last = asking[len(decision.candidates) - (decision.chosen is not None)]
    return proposals[: last.number + 1]
