"""Comparison of the parts that people mark with the regions of a family."""

from __future__ import annotations

import random
from collections.abc import Iterator

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.people.families import Family


def neighbours(board: Board, mask: Mask) -> Mask:
    """The cells that share an edge with a cell of a mask, without the mask itself."""
    top, bottom = board.ground << (board.height - 1), board.ground
    around = (mask & ~top) << 1 | (mask & ~bottom) >> 1
    around |= mask << board.height | mask >> board.height
    return around & board.full & ~mask


def pieces(board: Board, mask: Mask) -> Iterator[Mask]:
    """The connected pieces of a mask; cells are connected by their edges."""
    while mask:
        piece, grown = 0, mask & -mask
        while grown != piece:
            piece = grown
            grown |= neighbours(board, piece) & mask
        yield piece
        mask &= ~piece


def is_region(task: Task, part: Mask, family: Family) -> bool:
    """Whether a region of the family adds exactly a part when all target cells below it are built.

    Below means the rows under the lowest row of the part.
    """
    lowest = min(row for _, row in task.board.cells(part))
    return part in family(task, task.rows(lowest))


def grown_part(task: Task, cells: int, source: random.Random) -> Mask:
    """A connected part of a silhouette, grown cell by cell from a random cell: the chance level.

    Args:
        task: the silhouette; each of its pieces must have ``cells`` cells at least once tried.
        cells: size of the part [cells], 1 or more.
        source: random generator.
    """
    while True:
        part = _one(task.board, task.silhouette, source)
        for _ in range(cells - 1):
            edge = neighbours(task.board, part) & task.silhouette
            if not edge:
                break
            part |= _one(task.board, edge, source)
        else:
            return part


def _one(board: Board, mask: Mask, source: random.Random) -> Mask:
    return board.mask([source.choice(list(board.cells(mask)))])
