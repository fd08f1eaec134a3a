"""Have the kernels ready before the first trial."""

from __future__ import annotations

from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import count_states
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import SEARCHES, Compiled, Search
from blocks_planning.search.solve import solve

_BOARD = Board(2, 2)
_PROBLEM = Problem(Task(_BOARD, _BOARD.full), 0, _BOARD.full)


def warm_up() -> None:
    """Have every kernel for boards of up to 64 cells compiled, or loaded from the cache."""
    for search in SEARCHES.values():
        if issubclass(search, Compiled):
            warm_search(search())
    count_states(_PROBLEM.task, 2, CancelToken())


def warm_search(search: Search) -> None:
    """Have the kernels of one search ready."""
    solve(_PROBLEM, search, 0, 0)
