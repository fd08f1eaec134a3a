"""What a trial is: everything that its record follows from."""

from __future__ import annotations

import hashlib
import json
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

from blocks_planning import settings
from blocks_planning.board.blocks import format_library
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.result import DEFAULT_BUDGET, MAX_BUDGET
from blocks_planning.search.searches import Search
from blocks_planning.subgoals.decision import Strategy

# Many trials share a tower.
_drawn = lru_cache(maxsize=1024)(Board.draw)


@dataclass(frozen=True)
class TrialSpec:
    """A tower to rebuild, by whom, and the seed of every tie.

    Attributes:
        stimulus: name of the silhouette, for people; it changes nothing.
        task: board, silhouette and block library.
        strategy: the subgoal planner.
        search: the action-level search.
        seed: 0 to 2**64 - 1.
        budget: b of every solve [states].

    Raises:
        ConfigurationError: if the seed or the budget is out of its range.
    """

    stimulus: str
    task: Task
    strategy: Strategy
    search: Search
    seed: int = 0
    budget: int = DEFAULT_BUDGET

    def __post_init__(self) -> None:
        settings.check_whole('seed', self.seed, 0, MAX_SEED)
        settings.check_whole('budget', self.budget, 0, MAX_BUDGET)

    @cached_property
    def trial_id(self) -> str:
        """A name made of all of the above, the same wherever and whenever the trial is run."""
        text = json.dumps(self.to_json(), sort_keys=True)
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()

    def to_json(self) -> dict[str, Any]:
        """The part of a record that was known before the trial; see :mod:`.record`."""
        strategy = settings.settings_of(self.strategy)
        return {
            'stimulus': self.stimulus,
            'width': self.task.board.width,
            'height': self.task.board.height,
            'silhouette': _drawn(self.task.board, self.task.silhouette).split('\n'),
            'library': format_library(self.task.library),
            'strategy': self.strategy.name,
            'lambda': strategy.get('lambda'),
            'commit': strategy.get('commit'),
            **{key: strategy[key] for key in ('participant', 'costs') if key in strategy},
            'search': self.search.name,
            'search_settings': settings.settings_of(self.search),
            'seed': self.seed,
            'budget': self.budget,
        }
