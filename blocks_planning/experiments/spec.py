"""A sweep: its trials, and their division into chunks of work.

A chunk has some seeds of one stimulus with every planner of one experiment: the largest part
whose trials can share their solves. Its id is a digest of everything that determines its results.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from blocks_planning import __version__, settings
from blocks_planning.board.blocks import format_library
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.search.searches import Search
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.trials.script import Tower
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.world import Simulated, World

SEEDS_PER_CHUNK = 8


@dataclass(frozen=True)
class Experiment:
    """Every search with every strategy in every world.

    Attributes:
        name: in a column of the tables.
        searches: the action-level searches.
        strategies: the subgoal planners.
        budget: b of every solve [states]; 0 for a single attempt.
        worlds: the worlds.
        seeds: number of seeds, the first ones of the sweep; None for all.
    """

    name: str
    searches: tuple[Search, ...]
    strategies: tuple[Strategy, ...]
    budget: int = DEFAULT_BUDGET
    worlds: tuple[World, ...] = (Simulated(),)
    seeds: int | None = None


@dataclass(frozen=True)
class Chunk:
    """Some seeds of one tower in one experiment."""

    experiment: Experiment
    tower: Tower
    seeds: tuple[int, ...]

    def groups(self) -> Iterator[list[TrialSpec]]:
        """The trials, in lists of those that share their solves."""
        for search in self.experiment.searches:
            for seed in self.seeds:
                yield [
                    TrialSpec(
                        stimulus=self.tower.name,
                        task=self.tower.task,
                        strategy=strategy,
                        search=search,
                        seed=seed,
                        budget=self.experiment.budget,
                        world=world,
                    )
                    for world in self.experiment.worlds
                    for strategy in self.experiment.strategies
                ]

    @property
    def trials(self) -> int:
        """Number of trials."""
        experiment = self.experiment
        planners = len(experiment.searches) * len(experiment.strategies)
        return planners * len(experiment.worlds) * len(self.seeds)

    @cached_property
    def chunk_id(self) -> str:
        """Digest of everything that determines the results, 16 hexadecimal digits."""
        content = [
            __version__,
            experiment_to_json(self.experiment),
            _tower_to_json(self.tower),
            self.seeds,
        ]
        return _digest(content)


@dataclass(frozen=True)
class SweepSpec:
    """A whole sweep: every experiment with every tower and every seed."""

    name: str
    towers: tuple[Tower, ...]
    seeds: tuple[int, ...]
    experiments: tuple[Experiment, ...]

    def chunks(self) -> list[Chunk]:
        """All work, in the order of the rows in the tables."""
        return [
            Chunk(experiment, tower, seeds)
            for experiment in self.experiments
            for tower in self.towers
            for seeds in _batched(self.seeds[: experiment.seeds])
        ]

    @cached_property
    def sweep_id(self) -> str:
        """Digest of everything that determines the tables, 16 hexadecimal digits."""
        return _digest([chunk.chunk_id for chunk in self.chunks()])

    def to_json(self) -> dict[str, Any]:
        """The sweep for a manifest, with all settings written out."""
        return {
            'name': self.name,
            'seeds': list(self.seeds),
            'towers': [_tower_to_json(tower) for tower in self.towers],
            'experiments': [
                {**experiment_to_json(one), **({} if one.seeds is None else {'seeds': one.seeds})}
                for one in self.experiments
            ],
        }


def _batched(seeds: tuple[int, ...]) -> Iterator[tuple[int, ...]]:
    """The seeds of each chunk."""
    for start in range(0, len(seeds), SEEDS_PER_CHUNK):
        yield seeds[start : start + SEEDS_PER_CHUNK]


def experiment_to_json(experiment: Experiment) -> dict[str, Any]:
    """An experiment with every setting, without its number of seeds."""
    return {
        'name': experiment.name,
        'budget': experiment.budget,
        'searches': [_thing_to_json(search) for search in experiment.searches],
        'strategies': [_thing_to_json(strategy) for strategy in experiment.strategies],
        'worlds': [_thing_to_json(world) for world in experiment.worlds],
    }


def _thing_to_json(thing: Any) -> dict[str, Any]:
    return {'name': thing.name, **settings.settings_of(thing)}


def _tower_to_json(tower: Tower) -> dict[str, Any]:
    return {
        'name': tower.name,
        'silhouette': tower.task.board.draw(tower.task.silhouette).split('\n'),
        'library': format_library(tower.task.library),
    }


def _digest(content: Any) -> str:
    return hashlib.blake2b(json.dumps(content).encode(), digest_size=8).hexdigest()
