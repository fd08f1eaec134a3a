"""Full-subgoal planning: all sequences of subgoals are weighed before the first block is placed.

The 2**(m-1) sequences of m regions need at most m (m + 1) / 2 different queries, because a
solved subgoal fills exactly its target. The cost of a query counts in every sequence that needs it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import setting
from blocks_planning.subgoals.aiming import aim_setting, regions_to_aim_at
from blocks_planning.subgoals.decision import Chain, Situation
from blocks_planning.subgoals.planner import Planner, value_of
from blocks_planning.subgoals.regions import Region, Rows

SURPRISES = ('replan', 'blind')


@dataclass(frozen=True)
class FullSubgoals(Planner):
    """The sequence of subgoals of highest value (paper, section "Full-subgoal planning").

    All complete sequences add the same cells, so any lambda above 0 prefers the cheapest.
    """

    name: ClassVar[str] = 'full'
    lam: float = setting(
        1.0, 'Cost per evaluated state, in cells.', name='lambda', above=0, unit='cells / state'
    )
    aim: str = aim_setting()
    surprise: str = setting('replan', 'Reaction to an unexpected observation.', choices=SURPRISES)

    @property
    def is_blind(self) -> bool:
        """Whether the plan is executed to its end, whatever is observed."""
        return self.surprise == 'blind'

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """Every rising sequence of regions that ends in the last; a blind planner plans once."""
        if self.is_blind and situation.decisions:
            return []
        return list(
            rising_sequences(regions_to_aim_at(Rows(), situation.task, situation.built, self.aim))
        )

    def value(self, cells: int, planning_cost: int) -> float | None:
        """V = r - lambda * c [cells]."""
        return value_of(cells, planning_cost, self.lam)


def rising_sequences(regions: list[Region]) -> Iterator[Chain]:
    """Every rising sequence of regions that ends in the last, in lexicographic order."""
    for index, region in enumerate(regions):
        rest = regions[index + 1 :]
        if not rest:
            yield (region,)
        for tail in rising_sequences(rest):
            yield (region, *tail)
