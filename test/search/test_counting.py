"""How large a task is, against a twin that visits every state and every sequence."""

from __future__ import annotations

import random
from math import factorial

import pytest
from oracles.sizes import sizes
from problems import random_problem

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.counting import TaskSize, count_task
from blocks_planning.search.result import CancelToken
from blocks_planning.search.state_counts import count_states

DOMINOES = (Block(1, 2), Block(2, 1))


def slowly(task: Task) -> TaskSize:
    blocks = [(block.width, block.height) for block in task.library]
    board = task.board
    return TaskSize(
        *sizes(frozenset(board.cells(task.silhouette)), blocks, (board.width, board.height))
    )


def square(side: int) -> Task:
    board = Board(side, side)
    return Task(board, board.full, DOMINOES)


@pytest.mark.parametrize('batch', range(4))
def test_random_silhouettes(batch: int) -> None:
    source = random.Random(batch)
    for _ in range(25):
        task = random_problem(source, widest=4, highest=4, most_cells=9).task
        assert count_task(task) == slowly(task)


def test_two_dominoes_by_hand() -> None:
    """On 2 x 2 cells.

    States: nothing; the left or the right column; the lower row; everything. Sequences: left then
    right, right then left, or two lying ones.
    """
    assert count_task(square(2)) == TaskSize(states=5, complete_sequences=3, sequences=3)


def test_sequences_that_get_stuck_are_counted_apart() -> None:
    """A lying domino on a standing one beside a gap: the cells below it are lost."""
    task = Task(Board(2, 3), Board(2, 3).full, DOMINOES)
    found = count_task(task)
    assert found == slowly(task)
    assert found.sequences > found.complete_sequences


def test_empty_silhouette_has_the_empty_sequence() -> None:
    assert count_task(Task(Board(3, 3), 0, DOMINOES)) == TaskSize(1, 1, 1)


def test_silhouette_that_cannot_be_rebuilt() -> None:
    board = Board(3, 1)
    task = Task(board, board.full, (Block(2, 1),))
    assert count_task(task) == TaskSize(states=3, complete_sequences=0, sequences=2)


def test_numbers_beyond_a_word() -> None:
    """6 columns of 6 standing dominoes each: 36! / 6!**6 orders."""
    board = Board(6, 12)
    found = count_task(Task(board, board.full, (Block(1, 2),)))
    assert found is not None
    assert found.states == 7**6
    assert found.complete_sequences == found.sequences
    assert found.sequences == factorial(36) // factorial(6) ** 6 > 1 << 64


def test_limits_are_named() -> None:
    with pytest.raises(LimitExceeded, match='more than the limit of 5 outlines'):
        count_task(square(4), limit=5)
    with pytest.raises(LimitExceeded, match='more than the limit of 2 profiles'):
        count_states(square(4), limit=2)


def test_it_can_be_cancelled() -> None:
    cancel = CancelToken()
    cancel.cancel()
    assert count_task(square(4), cancel=cancel) is None
