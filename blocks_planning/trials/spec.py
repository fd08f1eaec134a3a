"""The specification of a trial: everything that determines its record."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

from blocks_planning import settings
from blocks_planning.board.blocks import format_library
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.families import Registry
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.result import DEFAULT_BUDGET, MAX_BUDGET
from blocks_planning.search.searches import SEARCHES, Search
from blocks_planning.subgoals.decision import Query, Strategy
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.worlds.observation import Blocks, impossible
from blocks_planning.worlds.world import WORLDS, Simulated, World

FAMILIES: dict[str, Registry] = {
    'strategy': STRATEGIES,
    'search': SEARCHES,
    'world': WORLDS,
}
"""The families of which a trial has one member each, by attribute of :class:`TrialSpec`."""

# Many trials share a tower.
_drawn = lru_cache(maxsize=1024)(Board.draw)


@dataclass(frozen=True)
class TrialSpec:
    """A tower to rebuild, the planner that does it, and the seed for tie-breaking.

    Attributes:
        stimulus: name of the silhouette; it has no effect on planning.
        task: board, silhouette and block library.
        strategy: the subgoal planner.
        search: the action-level search.
        seed: 0 to 2**64 - 1.
        budget: b of every solve [states].
        world: it determines the outcomes of orders.
        built: blocks that stand when the trial starts, supports before what rests on them.

    Raises:
        ConfigurationError: if the seed or the budget is out of its range, or the blocks of
            ``built`` cannot stand in their places.
    """

    stimulus: str
    task: Task
    strategy: Strategy
    search: Search
    seed: int = 0
    budget: int = DEFAULT_BUDGET
    world: World = Simulated()
    built: Blocks = ()

    def __post_init__(self) -> None:
        settings.check_whole('seed', self.seed, 0, MAX_SEED)
        settings.check_whole('budget', self.budget, 0, MAX_BUDGET)
        problem = impossible(self.task.board, self.built)
        if problem:
            raise ConfigurationError(f'built: {problem}')

    @property
    def plans_on_blocks(self) -> bool:
        """Whether the search must know the blocks that fill a state."""
        return self.search.plans_on_blocks

    def query(self, built: Mask, target: Mask, blocks: Blocks) -> Query:
        """A query from a state; its blocks are in it only if the search plans on them."""
        return Query(built, target, blocks if self.plans_on_blocks else ())

    @cached_property
    def trial_id(self) -> str:
        """An identifier derived from all attributes; the same on every machine and in every run."""
        text = json.dumps(self.to_json(), sort_keys=True)
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()

    def to_json(self) -> dict[str, Any]:
        """The specification as part of a record; see :mod:`.record`."""
        return {
            'stimulus': self.stimulus,
            'width': self.task.board.width,
            'height': self.task.board.height,
            'silhouette': _drawn(self.task.board, self.task.silhouette).split('\n'),
            'library': format_library(self.task.library),
            'built': [list(placed) for placed in self.built],
            **self.families_to_json(),
            'seed': self.seed,
            'budget': self.budget,
        }

    def families_to_json(self) -> dict[str, Any]:
        """The name and the settings of each family's member."""
        found: dict[str, Any] = {}
        for family in FAMILIES:
            chosen = getattr(self, family)
            found[family] = chosen.name
            found[f'{family}_settings'] = settings.settings_of(chosen)
        return found
