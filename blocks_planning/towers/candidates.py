"""Towers built at random: connected, and with a known way to build them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Library, Placed
from blocks_planning.board.geometry import Board, Mask


class Candidate(NamedTuple):
    """A silhouette, and how it was built; no placements if it was changed afterwards."""

    silhouette: Mask
    placements: tuple[Placed, ...]


def drop_blocks(
    board: Board, library: Library, count: int, rng: np.random.Generator
) -> Candidate | None:
    """Drop random blocks, each of which touches the tower.

    Args:
        board: its size.
        library: the blocks.
        count: number of blocks to drop.
        rng: generator of the choices; the same generator gives the same tower.

    Returns:
        The tower; None if there was not enough room for all blocks.
    """
    built = 0
    placements: list[Placed] = []
    for _ in range(count):
        possible = [
            placed
            for placed in rules.possible_placements(board, built, library)
            if not built or _touches(board, built, placed)
        ]
        if not possible:
            return None
        placed = possible[int(rng.integers(len(possible)))]
        placements.append(placed)
        built |= rules.cells_of(board, placed)
    return Candidate(built, tuple(placements))


def with_a_cell_changed(board: Board, silhouette: Mask, rng: np.random.Generator) -> Mask:
    """A silhouette with one random cell filled or emptied that has a target cell beside it."""
    near = [bit for bit in range(board.size) if (_around(board, 1 << bit) | 1 << bit) & silhouette]
    return silhouette ^ 1 << near[int(rng.integers(len(near)))]


def _touches(board: Board, built: Mask, placed: Placed) -> bool:
    return bool(_around(board, rules.cells_of(board, placed)) & built)


def _around(board: Board, cells: Mask) -> Mask:
    """The cells that share an edge with some cells."""
    bottom, top = board.ground, board.ground << (board.height - 1)
    upright = (cells & ~top) << 1 | (cells & ~bottom) >> 1
    return (upright | cells << board.height | cells >> board.height) & board.full & ~cells
