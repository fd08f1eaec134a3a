"""Another program as the subgoal planner."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.external import out_of_reach, program_setting
from blocks_planning.subgoals.decision import Chain, Situation
from blocks_planning.subgoals.planner import Planner


@dataclass(frozen=True)
class ExternalStrategy(Planner):
    """A program of your own that chooses the subgoals, as a node of the graph.

    The node gets the trial and its states, may ask the searcher, and publishes its decisions. What
    it considers, how it values that and what it chooses are its own.
    """

    name: ClassVar[str] = 'external'
    is_external: ClassVar[bool] = True
    program: str = program_setting()

    def chains(self, situation: Situation) -> Sequence[Chain]:
        """See :class:`Strategy`.

        Raises:
            ConfigurationError: always; only the program knows them.
        """
        raise out_of_reach('strategy', self.program)
