"""A planner is chains x weighing x choice.

* *Chains*: the sequences of regions that are considered. Without subgoals: the whole silhouette.
  Scoping: each region alone, or sequences up to a horizon. Full: every rising sequence that ends in
  the whole silhouette.
* *Weighing*: V = r - lambda * c of a chain whose subgoals are all solved, where c counts up to the
  first unsolved subgoal (paper, section "Subgoal planning").
* *Choice*: the chain of highest value, ties broken uniformly, or a draw by probabilities.

:class:`Planner` contains the common part; subclasses define the differences.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask, area
from blocks_planning.search.result import SolveStatus
from blocks_planning.settings import Configured
from blocks_planning.subgoals.choosing import best
from blocks_planning.subgoals.decision import (
    Candidate,
    Chain,
    Decision,
    Query,
    Situation,
    Subgoal,
    Weighed,
)
from blocks_planning.subgoals.regions import Region


class _Step(NamedTuple):
    """The state of the weighing after some subgoals of a chain.

    Attributes:
        built: the cells that are filled if all these subgoals are reached.
        cost: of their solves, up to the first unsolved one [states].
        status: of the first unsolved one, or solved.
        missing: the first query that is not answered.
        blocks: of a query in that state.
    """

    built: Mask
    cost: int
    status: SolveStatus
    missing: Query | None
    blocks: tuple[Placed, ...]


def _step(before: _Step, region: Region, situation: Situation) -> _Step:
    """The step after one more subgoal."""
    target = region.target(before.built)
    if before.missing is not None or before.status is not SolveStatus.SOLVED:
        return _Step(target, *before[1:])
    query = Query(before.built, target, before.blocks)
    result = situation.known.get(query)
    if result is None:
        return before._replace(built=target, missing=query)
    cost, blocks = before.cost + result.planning_cost, situation.after(query, result)
    return _Step(target, cost, result.status, None, blocks)


def _shared(one: Chain, other: Chain) -> int:
    """Number of regions that two chains have in common at their beginning."""
    most, shared = min(len(one), len(other)), 0
    while shared < most and one[shared] == other[shared]:
        shared += 1
    return shared


@dataclass(frozen=True)
class Planner(Configured):
    """A strategy that lists chains, weighs them and chooses one.

    A subclass defines :meth:`chains`, and overrides other methods where it differs.
    """

    asks_person: ClassVar[bool] = False

    @property
    def is_blind(self) -> bool:
        """See :class:`Strategy`."""
        return False

    @property
    def view(self) -> Planner | None:
        """The planner with fixed values of all settings that have no effect on its chains.

        Planners with equal views list the same chains in a state, for one seed, so what these add
        and cost is used again. None if that can't be said. A subclass whose chains depend on more
        than the view of its base must override it.
        """
        return None

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
        """See :class:`Strategy`. The number of chains."""
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
        """See :class:`Strategy`. The cost of the solves of all candidates."""
        return sum(candidate.planning_cost for candidate in candidates)

    def decide(self, situation: Situation) -> list[Query] | Decision:
        """See :class:`Strategy`."""
        key = (self.view, situation.built, situation.start)
        weighed = situation.weighed.get(key)
        if weighed is None:
            found = list(self.weighed(self.chains(situation), situation))
            if missing := dict.fromkeys(one for one in found if isinstance(one, Query)):
                return list(missing)
            candidates = tuple(one for one in found if isinstance(one, Candidate))
            weighed = Weighed(candidates, self.sequences(situation))
            if self.view is not None:
                situation.weighed[key] = weighed
        return self.decision(weighed, situation)

    def decision(self, weighed: Weighed, situation: Situation) -> Decision:
        """The decision between candidates whose queries are all answered."""
        valued = [self._valued(candidate) for candidate in weighed.candidates]
        candidates = self.rated(valued, situation)
        chosen = self.choose(candidates, situation)
        chain = () if chosen is None else candidates[chosen].regions
        return Decision(
            built=situation.built,
            candidates=candidates,
            chosen=chosen,
            subgoals=tuple(self.plan(chain, situation)),
            subgoal_planning_cost=self.considered(candidates),
            sequences=weighed.sequences,
        )

    def _valued(self, candidate: Candidate) -> Candidate:
        """A candidate with its value, if all its subgoals are solved."""
        if candidate.status is not SolveStatus.SOLVED:
            return candidate
        regions, cells, cost, _, status, _ = candidate
        return Candidate(regions, cells, cost, self.value(cells, cost), status)

    def weighed(
        self, chains: Iterable[Chain], situation: Situation
    ) -> Iterator[Candidate | Query]:
        """The candidate of each chain, without a value, or its first query without an answer.

        The part that a chain has in common with the previous one is not computed again.
        """
        size = area(situation.built)
        before: Chain = ()
        steps = [_Step(situation.built, 0, SolveStatus.SOLVED, None, situation.start)]
        for chain in chains:
            shared = _shared(before, chain)
            del steps[shared + 1 :]
            for region in chain[shared:]:
                steps.append(_step(steps[-1], region, situation))
            before, last = chain, steps[-1]
            cells = area(last.built) - size
            yield last.missing or Candidate(chain, cells, last.cost, None, last.status)

    def plan(self, chain: Chain, situation: Situation) -> Iterator[Subgoal]:
        """The subgoals of a chosen chain, with the plans that fill them."""
        executed = self.subgoals_of(chain)
        for region, query in zip(executed, queries_along(executed, situation), strict=True):
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


def targets_along(chain: Chain, built: Mask) -> Iterator[Mask]:
    """The filled cells after each subgoal of a chain; the next one begins there."""
    for region in chain:
        built = region.target(built)
        yield built


def queries_along(chain: Chain, situation: Situation) -> Iterator[Query]:
    """The queries that must be solved to execute a chain.

    If the search plans on blocks, all but the last must be answered when the next is asked for.
    """
    built, blocks = situation.built, situation.start
    for number, target in enumerate(targets_along(chain, built), start=1):
        query = Query(built, target, blocks)
        yield query
        built = target
        if situation.plans_on_blocks and number < len(chain):
            blocks = situation.after(query, situation.known[query])


def cells_added(chain: Chain, built: Mask) -> int:
    """r, the cells that a chain adds to a state."""
    *_, last = built, *targets_along(chain, built)
    return area(last) - area(built)


def value_of(cells: int, planning_cost: int, lam: float) -> float:
    """V = r - lambda * c (paper, equation of the scoping planner) [cells]."""
    return max(cells - lam * planning_cost, -sys.float_info.max)  # records cannot contain infinity
