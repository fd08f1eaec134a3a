"""A small sweep for tests."""

from __future__ import annotations

from pathlib import Path

import pyarrow as pa

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.experiments.spec import Experiment, SweepSpec
from blocks_planning.experiments.store import read_table
from blocks_planning.experiments.tables import Tables
from blocks_planning.search.searches import AStar, BreadthFirst, Search
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.script import Tower

STRATEGIES = (NoSubgoals(), Scoping(0.0), Scoping(0.004), Scoping(0.004, 'action'), FullSubgoals())
SEARCHES: tuple[Search, ...] = (BreadthFirst(2), AStar(32))


def sweep(seeds: int = 18, searches: tuple[Search, ...] = SEARCHES) -> SweepSpec:
    """Two towers of the paper with all strategies, one of which commits to actions."""
    towers = [
        Tower(s.name, Task(s.board, s.silhouette))
        for name in ('13', '7')
        for s in find_stimuli(f'cogsci2021/{name}')
    ]
    experiments = (Experiment('small', searches, STRATEGIES, 5_000),)
    return SweepSpec('test', tuple(towers), tuple(range(seeds)), experiments)


def tables_in(folder: Path) -> dict[str, pa.Table]:
    """The tables of a finished sweep."""
    return {name: read_table(folder, name) for name in Tables._fields}
