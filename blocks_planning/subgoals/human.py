"""A person as the planner: the paradigm that the paper announces in its discussion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import setting
from blocks_planning.subgoals.choosing import first_solved
from blocks_planning.subgoals.decision import (
    Candidate,
    Chain,
    Decision,
    Query,
    Situation,
    Weighed,
)
from blocks_planning.subgoals.planner import Planner, queries_along
from blocks_planning.subgoals.proposals import Proposal, ProposalKind, decisive
from blocks_planning.subgoals.regions import drawn_region

COSTS = ('shown', 'hidden')


@dataclass(frozen=True)
class Human(Planner):
    """A person proposes regions of any shape, one after the other, until one can be built."""

    name: ClassVar[str] = 'human'
    asks_person: ClassVar[bool] = True
    participant: str = setting(
        '',
        'Code of the person; do not use personal data.',
        pattern=r'[A-Za-z0-9_-]{0,32}',
        expected='a code of up to 32 letters, digits, _ and -',
    )
    costs: str = setting('shown', 'Whether the person sees the planning costs.', choices=COSTS)

    @property
    def hides_costs(self) -> bool:
        """Whether the person must not see planning costs."""
        return self.costs == 'hidden'

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """The proposed regions, each alone."""
        task, built = situation.task, situation.built
        return [
            (drawn_region(task, built, proposal.region),)
            for proposal in decisive(task, built, situation.proposals)
            if proposal.kind is ProposalKind.BUILD
        ]

    def value(self, cells: int, planning_cost: int) -> float | None:
        """No value: the person weighs."""
        return None

    def choose(self, candidates: Sequence[Candidate], situation: Situation) -> int | None:
        """The first proposal that can be built."""
        return first_solved(candidates)

    def decide(self, situation: Situation) -> list[Query] | Decision:
        """See :class:`Strategy`. Proposals are solved one by one, up to the first that can be."""
        chains: list[Chain] = []
        for chain in self.chains(situation):
            (query,) = queries_along(chain, situation)
            if query not in situation.known:
                return [query]
            chains.append(chain)
            if situation.known[query].solved:
                return self._decided(chains, situation)
        gives_up = any(p.kind is ProposalKind.GIVE_UP for p in situation.proposals)
        return self._decided(chains, situation) if gives_up else []

    def _decided(self, chains: list[Chain], situation: Situation) -> Decision:
        weighed = self.weighed(chains, situation)
        candidates = tuple(one for one in weighed if isinstance(one, Candidate))
        return self.decision(Weighed(candidates, len(candidates)), situation)


def used(situation: Situation, decision: Decision) -> tuple[Proposal, ...]:
    """The proposals of a state that led to a decision, up to the decisive one."""
    asking = list(decisive(situation.task, decision.built, situation.proposals))
    last = asking[len(decision.candidates) - (decision.chosen is not None)]
    return situation.proposals[: last.number + 1]
