"""Growth of planning costs with the board: generated towers with every planner.

A tower is made by dropping random blocks until most of the board is filled, so it can be rebuilt.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Library
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.task import Task
from blocks_planning.experiments.spec import Experiment, SweepSpec
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.search.searches import BreadthFirst, Search
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.script import Tower

FULLNESS = 0.7
"""Least share of the board that a generated tower fills, as long as blocks fit."""
BASE_SIDE = 8
SIDES = (4, 6, 8, 10, 12, 14, 16)


def generate_tower(
    board: Board, rng: np.random.Generator, library: Library = PAPER_LIBRARY
) -> Mask:
    """A silhouette that can be rebuilt: random blocks dropped at random places.

    Args:
        board: its size.
        rng: generator of the choices; the same generator gives the same tower.
        library: the blocks.

    Returns:
        The filled cells; empty if no block of the library fits on the board.
    """
    built = 0
    while area(built) < FULLNESS * board.size:
        possible = list(rules.possible_placements(board, built, library))
        if not possible:
            break
        placed = possible[int(rng.integers(len(possible)))]
        built |= rules.cells_of(board, placed)
    return built


def growth_sweep(
    towers: int,
    seeds: int,
    sides: tuple[int, ...] = SIDES,
    search: Search | None = None,
    budget: int = DEFAULT_BUDGET,
    seed: int = 0,
) -> SweepSpec:
    """A sweep over boards of rising height at width 8, and of rising width at height 8.

    Args:
        towers: number of towers of each size.
        seeds: number of trials of each tower and planner.
        sides: the heights and the widths [cells].
        search: by default bfs of depth 2, the fastest search that looks ahead.
        budget: b of every solve [states].
        seed: of the generated towers.
    """
    strategies: tuple[Strategy, ...] = (NoSubgoals(), Scoping(), FullSubgoals())
    return SweepSpec(
        name='growth',
        towers=tuple(_towers(towers, sides, seed)),
        seeds=tuple(range(seeds)),
        experiments=(Experiment('growth', (search or BreadthFirst(2),), strategies, budget),),
    )


def _towers(count: int, sides: tuple[int, ...], seed: int) -> Iterator[Tower]:
    sizes = [(BASE_SIDE, side) for side in sides]
    sizes += [(side, BASE_SIDE) for side in sides if side != BASE_SIDE]
    sizes += [(side, side) for side in sides if side != BASE_SIDE]
    for width, height in sizes:
        board = Board(width, height)
        for number in range(count):
            rng = np.random.default_rng([seed, width, height, number])
            silhouette = generate_tower(board, rng)
            yield Tower(f'{width}x{height}/{number}', Task(board, silhouette))
