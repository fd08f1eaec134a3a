"""Which kernels are compiled before a search is run."""

from __future__ import annotations

import pytest

from blocks_planning.board.geometry import Board
from blocks_planning.search import warming
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import AStar, BreadthFirst, Exact, Search


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Search, int]]:
    """The searches that are run to compile them, with the cells of their boards."""
    found: list[tuple[Search, int]] = []

    def solve(problem: Problem, search: Search, seed: int, budget: int) -> None:
        found.append((search, problem.task.board.size))

    monkeypatch.setattr(warming, 'solve', solve)
    return found


@pytest.mark.parametrize(('side', 'is_wide'), [(8, False), (9, True), (16, True)])
def test_boards_are_compiled_for_as_wide_as_they_are(
    solved: list[tuple[Search, int]], side: int, is_wide: bool
) -> None:
    warming.compile_for(BreadthFirst(7), Board(side, side))
    [(search, size)] = solved
    assert isinstance(search, BreadthFirst)
    assert (size > 64) == is_wide


def test_search_that_is_not_compiled_needs_nothing(solved: list[tuple[Search, int]]) -> None:
    warming.compile_for(Exact(), Board(8, 8))
    assert solved == []


def test_each_search_is_compiled_once_for_each_width(solved: list[tuple[Search, int]]) -> None:
    said: list[str] = []
    kernels = warming.Kernels(said.append)
    for _ in range(2):
        for search in (BreadthFirst(1), BreadthFirst(2), AStar(3)):
            for side in (4, 8, 16):
                kernels.prepare(search, Board(side, side))
    assert len(solved) == 4
    assert len(said) == 8
    assert not kernels.compiling
