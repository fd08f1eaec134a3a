"""The size of a task: numbers of reachable states and of sequences of placements.

The paper speaks of "roughly 35^15" states, the number of sequences of 15 placements with 35 choices
each. Here both are counted exactly: states are different sets of filled cells, sequences are
different orders of legal placements, from the empty board.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blocks_planning.board import rules
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
from blocks_planning.search.state_counts import count_states

MAX_OUTLINES = 10_000_000
"""Largest number of stored outlines, about 50 bytes each (0.5 GB)."""
_AT_FIRST = 1 << 22
_WORDS_AT_FIRST = 2  # enough for every tower of the paper
_GROWTH = 4


@dataclass(frozen=True)
class TaskSize:
    """Numbers of states and sequences of a silhouette.

    Attributes:
        states: different sets of filled cells that legal placements reach, the empty one included.
        complete_sequences: sequences of legal placements that end with the silhouette rebuilt.
        sequences: sequences of legal placements that end when no legal placement is left, including
            those that rebuild the silhouette.
    """

    states: int
    complete_sequences: int
    sequences: int


def count_task(
    task: Task, limit: int = MAX_OUTLINES, cancel: CancelToken | None = None
) -> TaskSize | None:
    """Count states and sequences of a task from the empty board; None if cancelled.

    Raises:
        LimitExceeded: if there are more than ``limit`` outlines, or the states have too many
            profiles (see :func:`.state_counts.count_states`).
    """
    cancel = cancel or CancelToken()
    states = count_states(task, cancel=cancel)
    walks = _walk(task, limit, cancel)
    if states is None or walks is None:
        return None
    complete = _find(walks, task, rules.shadow(task.board, task.silhouette))
    return TaskSize(
        states,
        0 if complete is None else _number(walks.whole[complete]),
        _number(walks.ended[0]),
    )


def _walk(task: Task, limit: int, cancel: CancelToken) -> Walks | None:
    """The outlines of a task with the number of sequences to each; None if cancelled."""
    tables = tables_of(task, task.silhouette)
    region = pack([task.silhouette, 0], task.board.size)
    # No more outlines than sets of cells. A walk that outgrows its memory begins again.
    size = min(_AT_FIRST, limit, 1 << tables.target)
    words = _WORDS_AT_FIRST
    while True:
        walks = make_walks(size, tables.legal.shape[1:], words, task.board.size, len(task.library))
        found = walk(walks, tables, region, cancel.flag)
        if found == CANCELLED:
            return None
        if found == OVERFLOW:
            words *= 2
        elif found != FULL:
            return walks
        elif size == limit:
            raise LimitExceeded(
                f'more than the limit of {limit} outlines can be reached on this silhouette of '
                f'{task.board.width} x {task.board.height} cells'
            )
        else:
            size = min(limit, size * _GROWTH)


def _find(walks: Walks, task: Task, shadow: int) -> int | None:
    """The number of an outline; None if it is not reachable."""
    number = int(walks.first[shadow.bit_count()])
    wanted = pack([shadow], task.board.size)[0]
    while number >= 0 and not np.array_equal(walks.shadow[number], wanted):
        number = int(walks.following[number])
    return None if number < 0 else number


def _number(words: np.ndarray) -> int:
    return sum(int(word) << WORD_BITS * index for index, word in enumerate(words))
