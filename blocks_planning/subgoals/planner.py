"""A planner is chains x weighing x choice.

* *Chains*: which sequences of regions are considered. No subgoals: the whole silhouette. Scoping:
  each region alone. Full: every rising sequence that ends in the whole silhouette.
* *Weighing*: V = r - lambda * c of a chain whose subgoals are all solved, where c counts up to the
  first unsolved subgoal (paper, section "Subgoal planning").
* *Choice*: the chain of highest value, ties broken uniformly.

:class:`Planner` holds what all of them share; a subclass says what is its own.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.board.geometry import Mask, area
from blocks_planning.search.randomness import Generator, mask_words
from blocks_planning.search.result import SolveStatus
from blocks_planning.settings import Configured
from blocks_planning.subgoals.decision import (
    Candidate,
    Chain,
    Decision,
    Query,
    Situation,
    Subgoal,
)


@dataclass(frozen=True)
class Planner(Configured):
    """A strategy that decides by itself: lists chains, weighs them and chooses one.

    A subclass defines :meth:`chains`, and what else it does differently.
    """

    asks_person: ClassVar[bool] = False

    @property
    def is_blind(self) -> bool:
        """See :class:`Strategy`."""
        return False

    @property
    def hides_costs(self) -> bool:
        """Whether planning costs must not be shown while a trial runs."""
        return False

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """See :class:`Strategy`."""
        raise NotImplementedError

    def value(self, cells: int, planning_cost: int) -> float | None:
        """See :class:`Strategy`."""
        raise NotImplementedError

    def sequences(self, situation: Situation) -> int:
        """See :class:`Strategy`. As many as there are chains."""
        return len(self.chains(situation))

    def rated(
        self, candidates: Sequence[Candidate], situation: Situation
    ) -> tuple[Candidate, ...]:
        """See :class:`Strategy`. Without probabilities."""
        return tuple(candidates)

    def choose(self, candidates: Sequence[Candidate], situation: Situation) -> int | None:
        """See :class:`Strategy`. The best candidate, uniformly among equals."""
        return best(candidates, situation.seed, situation.built)

    def subgoals_of(self, chain: Chain) -> Chain:
        """See :class:`Strategy`. The whole chain."""
        return chain

    def execute(self, plan: int) -> int:
        """See :class:`Strategy`. All of a plan."""
        return plan

    def considered(self, candidates: Sequence[Candidate]) -> int:
        """See :class:`Strategy`. What the solves of all candidates cost."""
        return sum(candidate.planning_cost for candidate in candidates)

    def decide(self, situation: Situation) -> list[Query] | Decision:
        """See :class:`Strategy`."""
        chains = self.chains(situation)
        missing: dict[Query, None] = {}
        candidates = []
        for chain in chains:
            weighed = self._weigh(chain, situation)
            if isinstance(weighed, Query):
                missing[weighed] = None
            else:
                candidates.append(weighed)
        if missing:
            return list(missing)
        return self.decision(self.rated(candidates, situation), situation)

    def decision(self, candidates: tuple[Candidate, ...], situation: Situation) -> Decision:
        """The decision between candidates whose queries are all answered."""
        chosen = self.choose(candidates, situation)
        chain = () if chosen is None else candidates[chosen].regions
        return Decision(
            built=situation.built,
            candidates=candidates,
            chosen=chosen,
            subgoals=tuple(self.plan(chain, situation)),
            subgoal_planning_cost=self.considered(candidates),
            sequences=self.sequences(situation),
        )

    def _weigh(self, chain: Chain, situation: Situation) -> Candidate | Query:
        """The candidate of a chain, or the first query on its way that is not answered."""
        cost, status = 0, SolveStatus.SOLVED
        for query in queries_along(chain, situation.built):
            result = situation.known.get(query)
            if result is None:
                return query
            cost += result.planning_cost
            status = result.status
            if not result.solved:
                break
        return self.candidate(chain, situation.built, cost, status)

    def candidate(self, chain: Chain, built: Mask, cost: int, status: SolveStatus) -> Candidate:
        """The candidate of a chain whose solves cost ``cost`` [states] and ended in ``status``."""
        cells = cells_added(chain, built)
        value = self.value(cells, cost) if status is SolveStatus.SOLVED else None
        return Candidate(chain, cells, cost, value, status)

    def plan(self, chain: Chain, situation: Situation) -> Iterator[Subgoal]:
        """The subgoals of a chosen chain, with the plans that fill them."""
        executed = self.subgoals_of(chain)
        for region, query in zip(executed, queries_along(executed, situation.built), strict=True):
            result = situation.known[query]
            yield Subgoal(
                region=region,
                target=query.target,
                execute=self.execute(len(result.plan)),
                placements=result.plan,
                planning_cost=result.planning_cost,
                solution_cost=result.solution_cost,
                attempts=result.attempts,
            )


def queries_along(chain: Chain, built: Mask) -> Iterator[Query]:
    """What has to be solved to execute a chain from a state.

    A solved subgoal fills exactly its target, so the next one begins there.
    """
    for region in chain:
        target = region.target(built)
        yield Query(built, target)
        built = target


def cells_added(chain: Chain, built: Mask) -> int:
    """r, the cells that a chain adds to a state."""
    target = built
    for region in chain:
        target = region.target(target)
    return area(target) - area(built)


def value_of(cells: int, planning_cost: int, lam: float) -> float:
    """V = r - lambda * c (paper, equation of the scoping planner) [cells]."""
    return max(cells - lam * planning_cost, -sys.float_info.max)  # a record has no infinity


def best(candidates: Sequence[Candidate], seed: int, built: Mask) -> int | None:
    """Index of a candidate of highest value, uniformly among equals; None if none has a value.

    The draw depends on nothing but the trial's seed and the state.
    """
    values = [candidate.value for candidate in candidates if candidate.value is not None]
    if not values:
        return None
    highest = max(values)
    ties = [index for index, candidate in enumerate(candidates) if candidate.value == highest]
    return ties[Generator([seed, *mask_words(built)]).below(len(ties))]


def first_solved(candidates: Sequence[Candidate]) -> int | None:
    """Index of the first candidate that is solved; None if there is none."""
    return next((i for i, candidate in enumerate(candidates) if candidate.is_solved), None)
