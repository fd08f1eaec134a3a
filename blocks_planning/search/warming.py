"""Compile the kernels of a search before it is needed."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from blocks_planning.board.geometry import Board
from blocks_planning.board.kernels.masks import WORD_BITS
from blocks_planning.board.task import Task
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import Compiled, Search
from blocks_planning.search.solve import solve

_SMALL, _LARGE = Board(2, 2), Board(16, 16)


def compile_for(search: Search, board: Board) -> None:
    """Compile a search for boards of this kind, or load it from the cache of an earlier process.

    Boards of up to 64 cells share kernels, and so do larger ones.
    """
    if isinstance(search, Compiled):
        alike = _LARGE if board.size > WORD_BITS else _SMALL
        square = alike.rectangle(0, 0, 2, 2)
        solve(Problem(Task(alike, square), 0, square), type(search)(), 0, 0)


class Kernels:
    """The searches that can be run at once in this process; used from several threads."""

    def __init__(self, report: Callable[[str], None]) -> None:
        """None yet; ``report`` is told when a search is compiled, and how long it took."""
        self._report = report
        self._ready: set[tuple[type[Search], bool]] = set()
        self._one_at_a_time = threading.Lock()
        self.compiling = False

    def prepare(self, search: Search, board: Board) -> None:
        """Return when a search can be run at once on boards of this kind."""
        key = type(search), board.size > WORD_BITS
        if key in self._ready:
            return
        with self._one_at_a_time:
            if key not in self._ready:
                self._compile(search, board)
                self._ready.add(key)

    def _compile(self, search: Search, board: Board) -> None:
        began_s = time.monotonic()
        self._report(f'compiling {search.name}; this takes a while after the first start')
        self.compiling = True
        try:
            compile_for(search, board)
        finally:
            self.compiling = False
        self._report(f'compiled {search.name} in {time.monotonic() - began_s:.1f} s')
