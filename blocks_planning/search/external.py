"""Another program as the action-level search."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.external import out_of_reach, program_setting
from blocks_planning.search.result import CancelToken, Problem, SolveResult
from blocks_planning.settings import Configured


@dataclass(frozen=True)
class ExternalSearch(Configured):
    """A program of your own that fills regions and orders placements, as a node of the graph.

    What it evaluates and which plans it finds are its own.
    """

    name: ClassVar[str] = 'external'
    is_external: ClassVar[bool] = True
    program: str = program_setting()

    def run(self, problem: Problem, seed: int, budget: int, cancel: CancelToken) -> SolveResult:
        """See :class:`.searches.Search`.

        Raises:
            ConfigurationError: always; only the program can search.
        """
        raise out_of_reach('search', self.program)
