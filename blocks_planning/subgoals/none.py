"""Planning without subgoals: the only subgoal is the whole silhouette."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import setting
from blocks_planning.subgoals.aiming import aim_setting, regions_to_aim_at
from blocks_planning.subgoals.choosing import first_solved
from blocks_planning.subgoals.decision import Candidate, Chain, Situation
from blocks_planning.subgoals.planner import Planner, queries_along
from blocks_planning.subgoals.regions import Rows

FAILURES = ('execute', 'give_up')


@dataclass(frozen=True)
class NoSubgoals(Planner):
    """Action-level search for the whole tower (paper, "no subgoal planning")."""

    name: ClassVar[str] = 'none'
    aim: str = aim_setting()
    failure: str = setting(
        'execute',
        'What a failed solve leads to: its last attempt is executed, or the planner gives up.',
        choices=FAILURES,
    )

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """The whole silhouette."""
        regions = regions_to_aim_at(Rows(), situation.task, situation.built, self.aim)
        return [(region,) for region in regions[-1:]]

    def value(self, cells: int, planning_cost: int) -> float | None:
        """No value: there is only one candidate."""
        return None

    def choose(self, candidates: Sequence[Candidate], situation: Situation) -> int | None:
        """The only candidate; if it is not solved, its last attempt is executed.

        The paper ends a trial when no further block can be placed.
        """
        if self.failure == 'give_up':
            return first_solved(candidates)
        for chain in (candidate.regions for candidate in candidates):
            (query,) = queries_along(chain, situation)
            result = situation.known.get(query)
            if result is not None and result.plan:
                return 0
        return None

    def considered(self, candidates: Sequence[Candidate]) -> int:
        """0: the solve is action planning."""
        return 0
