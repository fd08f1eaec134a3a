"""Hypothesis strategies for boards, libraries and states."""

from __future__ import annotations

from typing import NamedTuple

from hypothesis import strategies as st

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block, Library, Placed
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task


class Position(NamedTuple):
    """A task, and what is built of it: by possible placements, legal or not."""

    task: Task
    built: Mask
    placements: tuple[Placed, ...]


def boards(most: int = 16) -> st.SearchStrategy[Board]:
    """Boards with sides up to ``most``."""
    return st.builds(Board, st.integers(1, most), st.integers(1, most))


def libraries(most_side: int = 5, most_blocks: int = 6) -> st.SearchStrategy[Library]:
    """The paper's library, or any other."""
    side = st.integers(1, most_side)
    other = st.lists(
        st.builds(Block, side, side), min_size=1, max_size=most_blocks, unique=True
    ).map(tuple)
    return st.one_of(st.just(PAPER_LIBRARY), other)


@st.composite
def tasks(draw: st.DrawFn, most: int = 16, most_side: int = 5) -> Task:
    """A board, any silhouette and a library."""
    board = draw(boards(most))
    return Task(board, draw(st.integers(0, board.full)), draw(libraries(most_side)))


@st.composite
def solvable_tasks(
    draw: st.DrawFn, most: int = 4, most_blocks: int = 6, most_side: int = 3
) -> Task:
    """A task whose silhouette was made by dropping blocks, so that it can be rebuilt."""
    board, library = draw(boards(most)), draw(libraries(most_side, 4))
    built, _ = _drop_some(draw, Task(board, board.full, library), most_blocks)
    return Task(board, built, library)


@st.composite
def positions(draw: st.DrawFn, most: int = 16, most_blocks: int = 12) -> Position:
    """A task, and a state that some blocks were dropped into."""
    task = draw(tasks(most))
    return Position(task, *_drop_some(draw, task, most_blocks))


def _drop_some(draw: st.DrawFn, task: Task, most_blocks: int) -> tuple[Mask, tuple[Placed, ...]]:
    built, placements = 0, []
    for choice in draw(st.lists(st.integers(0, 10**6), max_size=most_blocks)):
        possible = list(rules.possible_placements(task.board, built, task.library))
        if not possible:
            break
        placements.append(possible[choice % len(possible)])
        built |= rules.cells_of(task.board, placements[-1])
    return built, tuple(placements)
