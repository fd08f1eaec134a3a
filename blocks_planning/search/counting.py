"""How large a task is: the states that can be reached, and the sequences of placements.

The paper speaks of "roughly 35^15" states, the number of sequences of 15 placements with 35 choices
each. Here both are counted exactly: states are different sets of filled cells, sequences are
different orders of legal placements, from the empty board.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.kernels.masks import WORD_BITS, pack
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.compiled import tables_of
from blocks_planning.search.kernels.walking import (
    CANCELLED,
    FULL,
    OVERFLOW,
    Walks,
    make_walks,
    walk,
)
from blocks_planning.search.result import CancelToken

MAX_STATES = 40_000_000
"""Most states that are kept, about 50 bytes each (2 GB)."""
_AT_FIRST = 1 << 20
_GROWTH = 4


@dataclass(frozen=True)
class TaskSize:
    """How much can happen on a silhouette.

    Attributes:
        states: different sets of filled cells that legal placements reach, the empty one included.
        complete_sequences: sequences of legal placements that end with the silhouette rebuilt.
        sequences: sequences of legal placements that end where nothing legal is left, those that
            rebuild the silhouette included.
    """

    states: int
    complete_sequences: int
    sequences: int


def count_task(
    task: Task, limit: int = MAX_STATES, cancel: CancelToken | None = None
) -> TaskSize | None:
    """Count states and sequences of a task from the empty board; None if cancelled.

    Raises:
        LimitExceeded: if there are more than ``limit`` states.
    """
    cancel = cancel or CancelToken()
    size, words = min(_AT_FIRST, limit), 1
    while True:
        walks, found = _walk(task, size, words, cancel)
        if found == CANCELLED:
            return None
        if found == OVERFLOW:
            words *= 2
        elif found == FULL and size < limit:
            size = min(limit, size * _GROWTH)
        elif found == FULL:
            raise LimitExceeded(
                f'more than the limit of {limit} states can be reached on this silhouette of '
                f'{task.board.width} x {task.board.height} cells'
            )
        else:
            return TaskSize(found, _ways_to(task.silhouette, task, walks), _number(walks.ended[0]))


def _walk(task: Task, size: int, words: int, cancel: CancelToken) -> tuple[Walks, int]:
    tables = tables_of(task, task.silhouette)
    board = task.board
    walks = make_walks(size, tables.legal.shape[1:], words, board.size, len(task.library))
    cells = [
        _cells_at(task, block, bit) for block in range(len(task.library)) for bit in range(board.size)
    ]
    found = walk(
        walks, tables, pack(cells, board.size), pack([0, 0], board.size), cancel.flag
    )
    return walks, int(found)


def _cells_at(task: Task, block: int, bit: int) -> Mask:
    """The cells of a block with its lower left cell at a bit; none if it leaves the board."""
    width, height = task.library[block]
    column, row = task.board.cell(bit)
    if column + width > task.board.width or row + height > task.board.height:
        return 0
    return rules.cells_of(task.board, Placed(width, height, column, row))


def _ways_to(state: Mask, task: Task, walks: Walks) -> int:
    """The number of ways to a state; 0 if none leads there."""
    number = int(walks.first[state.bit_count()])
    wanted = pack([state], task.board.size)[0]
    while number >= 0 and not np.array_equal(walks.filled[number], wanted):
        number = int(walks.following[number])
    return 0 if number < 0 else _number(walks.ways[number])


def _number(words: np.ndarray) -> int:
    return sum(int(word) << WORD_BITS * index for index, word in enumerate(words))
