"""Visual scoping: look at a part of the silhouette, build it, look again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import member, setting
from blocks_planning.subgoals.aiming import aim_setting, regions_to_aim_at
from blocks_planning.subgoals.decision import Chain, Situation
from blocks_planning.subgoals.planner import Planner, value_of
from blocks_planning.subgoals.regions import REGIONS, RegionFamily

COMMITS = ('subgoal', 'action')


@dataclass(frozen=True)
class Scoping(Planner):
    """One subgoal at a time, the one of highest value (paper, section "Visual scoping").

    It executes the whole plan of a 'subgoal' (the paper's text and numbers), or only its first
    'action'.
    """

    name: ClassVar[str] = 'scoping'
    lam: float = setting(
        0.002, 'Cost per evaluated state, in cells.', name='lambda', least=0, unit='cells / state'
    )
    commit: str = setting(
        'subgoal', 'Part of the plan executed before the next decision.', choices=COMMITS
    )
    aim: str = aim_setting()
    regions: RegionFamily = member('rows', REGIONS, 'Regions that are considered as subgoals.')

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """Each region alone."""
        regions = regions_to_aim_at(self.regions, situation, self.aim)
        return [(region,) for region in regions]

    def value(self, cells: int, planning_cost: int) -> float | None:
        """V = r - lambda * c [cells]."""
        return value_of(cells, planning_cost, self.lam)

    def subgoals_of(self, chain: Chain) -> Chain:
        """The first region; after it, scoping looks again."""
        return chain[:1]

    def execute(self, plan: int) -> int:
        """The whole plan, or its first action."""
        return min(1, plan) if self.commit == 'action' else plan
