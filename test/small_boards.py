"""Boards small enough to work out by hand, two towers, and boards drawn at random."""

from __future__ import annotations

import random

from oracles.board import EMPTY, Block, Cells, legal_placements, place
from oracles.tree import Task

PAPER_LIBRARY = ((1, 2), (2, 1), (2, 2), (2, 4), (4, 2))
LYING = ((2, 1),)
STANDING = ((1, 2),)
DOMINOES = ((1, 2), (2, 1))

TOWER_1 = """
##..####
##..####
##..#..#
##..#..#
##..#..#
##.##..#
##.#####
########
"""

TOWER_6 = """
####.##.
####.##.
####.##.
##.#####
##.#####
####..##
########
.##.####
"""

# Three cells: two on the ground and one on top of the left one.
STEP = """
#.
##
"""


def full_board(width: int, height: int) -> Cells:
    return frozenset((column, row) for column in range(width) for row in range(height))


def full_task(width: int, height: int, library: tuple[Block, ...]) -> Task:
    return Task(width, height, tuple(library), full_board(width, height))


def random_board(rng: random.Random) -> tuple[int, int, tuple[Block, ...], Cells, Cells]:
    """A small board, library, region, and a built state: cells, or blocks dropped on it."""
    width, height = rng.randint(1, 4), rng.randint(1, 4)
    sizes = [(1, 1), (1, 2), (2, 1), (2, 2), (1, 3), (3, 1), (3, 2)]
    library = tuple(rng.sample(sizes, rng.randint(1, 3)))
    density = rng.choice([0.5, 0.8, 1.0])
    cells = sorted(full_board(width, height))
    region = frozenset(rng.sample(cells, max(1, min(10, round(density * len(cells))))))
    built = EMPTY
    if rng.random() < 0.3:
        built = frozenset(rng.sample(sorted(region), rng.randint(0, len(region))))
    else:
        for _ in range(rng.randint(0, 2)):
            legal = legal_placements(width, height, library, region, built)
            built = place(built, rng.sample(legal, min(1, len(legal))))
    return width, height, library, region, built
