"""Random problems for the searches."""

from __future__ import annotations

import random

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block
from blocks_planning.board.geometry import Board, area
from blocks_planning.board.task import Task
from blocks_planning.search.result import Problem


def random_problem(
    source: random.Random, widest: int = 5, highest: int = 5, most_cells: int = 1000
) -> Problem:
    """A region and a state inside it; half of the boards have more than 64 cells.

    Blocks are dropped until the region has ``most_cells`` cells, or by chance before.
    """
    if source.random() < 0.5:
        board = Board(source.randint(1, widest), source.randint(1, highest))
    else:
        board = Board(source.randint(5, 9), source.randint(14, 16))
    sides = [1, 1, 2, 2, 3, 4]
    blocks = {Block(source.choice(sides), source.choice(sides)) for _ in range(4)}
    library = source.choice([PAPER_LIBRARY, tuple(sorted(blocks))])
    states = [0]
    for _ in range(source.randint(1, 7)):
        possible = list(rules.possible_placements(board, states[-1], library))
        possible = [p for p in possible if area(states[-1]) + p.width * p.height <= most_cells]
        if possible:
            states.append(states[-1] | rules.cells_of(board, source.choice(possible)))
    region = states[-1]
    if source.random() < 0.3:  # not always solvable
        region |= 1 << source.randrange(board.size)
    return Problem(
        Task(board, region, library), source.choice(states[: len(states) // 2 + 1]), region
    )
