"""The searches by name, and an attempt to fill a region with one of them, word by word.

The cost of a search is its number of states evaluated: every child state generated, counted as
often as it is generated.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from oracles.beam import beam_choice
from oracles.best_first import astar_choice, best_first_choice
from oracles.board import Block, Cells, Placement, place
from oracles.breadth_first import bfs_choice
from oracles.monte_carlo import mcts_choice
from oracles.randomness import Generator, attempt_generator
from oracles.tree import Choice, Path, Task


@dataclass(frozen=True)
class Attempt:
    """One attempt to fill a region: whether it did, all its placements, its cost [states]."""

    success: bool
    placements: Path
    cost: int


def random_choice(task: Task, state: Cells, generator: Generator) -> Choice:
    """One legal placement, uniformly; nothing is evaluated."""
    placements = task.legal(state)
    return Choice((placements[generator.below(len(placements))],), 0)


SEARCHES: dict[str, Callable[..., Choice]] = {
    'random': random_choice,
    'bfs': bfs_choice,
    'astar': astar_choice,
    'best_first': best_first_choice,
    'beam': beam_choice,
    'mcts': mcts_choice,
}


def run_attempt(
    task: Task, state: Cells, generator: Generator, search: str, **settings: Any
) -> Attempt:
    """Search and execute until the region is filled or nothing legal is left."""
    choose = SEARCHES[search]
    placements: list[Placement] = []
    cost = 0
    while state != task.region and task.legal(state):
        choice = choose(task, state, generator, **settings)
        state = place(state, choice.placements)
        placements.extend(choice.placements)
        cost += choice.cost
    return Attempt(state == task.region, tuple(placements), cost)


def attempt(
    width: int,
    height: int,
    library: Sequence[Block],
    region: Cells,
    built: Cells,
    seed: int,
    number: int,
    /,
    *,
    search: str,
    **settings: Any,
) -> Attempt:
    """Attempt `number` to fill `region` from `built`, with the generator that belongs to it."""
    task = Task(width, height, tuple(library), region)
    generator = attempt_generator(seed, built, region, height, number)
    return run_attempt(task, built, generator, search, **settings)
