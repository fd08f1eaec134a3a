"""Visual scoping: look at a part of the silhouette, build it, look again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

from blocks_planning.settings import member, setting
from blocks_planning.subgoals.aiming import aim_setting
from blocks_planning.subgoals.choosing import AGGREGATES, CHOICES, best, drawn, probabilities
from blocks_planning.subgoals.decision import Candidate, Chain, Situation
from blocks_planning.subgoals.lookahead import (
    MAX_HORIZON,
    MAX_SEQUENCES,
    Considered,
    Lookahead,
    considered,
)
from blocks_planning.subgoals.planner import Planner, value_of
from blocks_planning.subgoals.regions import REGIONS, RegionFamily

COMMITS = ('subgoal', 'action')


@dataclass(frozen=True)
class Scoping(Planner):
    """One subgoal at a time, the one of highest value (paper, section "Visual scoping").

    It executes the whole plan of a 'subgoal' (the paper's text and numbers), or only its first
    'action'. With a horizon above 1 it weighs sequences of subgoals, and executes the first
    subgoal of the one that it chooses.
    """

    name: ClassVar[str] = 'scoping'
    lam: float = setting(
        0.002, 'Cost per evaluated state, in cells.', name='lambda', least=0, unit='cells / state'
    )
    commit: str = setting(
        'subgoal', 'Part of a plan that is executed before the next decision.', choices=COMMITS
    )
    aim: str = aim_setting()
    regions: RegionFamily = member('rows', REGIONS, 'Family of regions that can be subgoals.')

    horizon: int = setting(
        1, 'Number of subgoals to look ahead.', least=1, most=MAX_HORIZON, unit='subgoals'
    )
    max_sequences: int = setting(
        MAX_SEQUENCES,
        'Largest number of subgoal sequences to weigh; if there are more, a sample is drawn.',
        least=1,
        most=MAX_SEQUENCES,
        unit='sequences',
    )
    choice: str = setting('best', 'How a candidate is chosen from the values.', choices=CHOICES)
    temperature: float = setting(
        1.0,
        'For softmax: a candidate of value V has weight exp(V / temperature).',
        above=0,
        unit='cells',
    )
    aggregate: str = setting(
        'best',
        'For softmax: how sequences that begin with the same subgoal are combined.',
        choices=AGGREGATES,
    )

    @cached_property
    def view(self) -> Scoping:
        """See :class:`Planner`. The chains do not depend on how they are valued and chosen."""
        return replace(
            self, lam=0.0, commit='subgoal', choice='best', temperature=1.0, aggregate='best'
        )

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """Each region alone, or the sequences of :mod:`.lookahead`."""
        return self._considered(situation).chains

    def sequences(self, situation: Situation) -> int:
        """See :class:`Strategy`."""
        return self._considered(situation).existing

    def _considered(self, situation: Situation) -> Considered:
        how = Lookahead(self.regions, self.aim, self.horizon, self.max_sequences)
        return considered(how, situation.task, situation.built, situation.seed)

    def rated(
        self, candidates: Sequence[Candidate], situation: Situation
    ) -> tuple[Candidate, ...]:
        """See :class:`Strategy`. With probabilities if the choice is by softmax."""
        if self.choice == 'best':
            return tuple(candidates)
        chances = probabilities(candidates, self.temperature, self.aggregate)
        return tuple(
            candidate._replace(probability=chance)
            for candidate, chance in zip(candidates, chances, strict=True)
        )

    def choose(self, candidates: Sequence[Candidate], situation: Situation) -> int | None:
        """See :class:`Strategy`."""
        choose = best if self.choice == 'best' else drawn
        return choose(candidates, situation.seed, situation.built)

    def value(self, cells: int, planning_cost: int) -> float | None:
        """V = r - lambda * c [cells]."""
        return value_of(cells, planning_cost, self.lam)

    def subgoals_of(self, chain: Chain) -> Chain:
        """The first region; scoping decides again after it."""
        return chain[:1]

    def execute(self, plan: int) -> int:
        """The whole plan, or its first action."""
        return min(1, plan) if self.commit == 'action' else plan
