"""Have the kernels ready before the first trial."""

from __future__ import annotations

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_states
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import SEARCHES, Compiled
from blocks_planning.search.solve import solve


def warm_up() -> None:
    """Have every kernel for boards of up to 64 cells compiled, or loaded from the cache."""
    board = Board(2, 2)
    problem = Problem(Task(board, board.full), 0, board.full)
    for search in SEARCHES.values():
        if issubclass(search, Compiled):
            solve(problem, search(), 0, 0)
    count_states(problem.task, 2, CancelToken())
