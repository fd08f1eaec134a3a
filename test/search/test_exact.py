"""The exact search against brute force over every order of dropping blocks."""

from __future__ import annotations

import random

import pytest
from oracles.exact import arrangements_by_dropping
from problems import random_problem

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search import exact
from blocks_planning.search.exact import ExactAnswer, analyse
from blocks_planning.search.result import CancelToken, Problem, SolveStatus
from blocks_planning.search.searches import Exact
from blocks_planning.search.solve import solve


def analysed(task: Task) -> ExactAnswer:
    answer = analyse(task)
    assert answer is not None
    return answer


def brute_force(problem: Problem) -> tuple[int | None, int, int]:
    """Fewest blocks, arrangements, and those of them that have the fewest blocks."""
    board = problem.task.board
    found = arrangements_by_dropping(
        board.width,
        board.height,
        [(block.width, block.height) for block in problem.task.library],
        frozenset(board.cells(problem.region)),
        frozenset(board.cells(problem.built)),
    )
    sizes = sorted(map(len, found))
    return (sizes[0], len(sizes), sizes.count(sizes[0])) if sizes else (None, 0, 0)


@pytest.mark.parametrize('batch', range(4))
def test_silhouettes_against_brute_force(batch: int) -> None:
    source = random.Random(batch)
    for _ in range(40):
        task = random_problem(source, widest=4, highest=4, most_cells=9).task
        answer = analysed(task)
        assert (
            answer.fewest_blocks,
            answer.arrangements,
            answer.optimal_arrangements,
        ) == brute_force(Problem(task, 0, task.silhouette))
        regions = [task.rows(height) for height in range(1, task.board.height + 1)]
        by_rows = [brute_force(Problem(task, 0, region))[0] for region in regions]
        assert list(answer.by_rows) == by_rows


@pytest.mark.parametrize('batch', range(4))
def test_regions_from_built_states_against_brute_force(batch: int) -> None:
    source = random.Random(100 + batch)
    for _ in range(60):
        problem = random_problem(source, widest=4, highest=4, most_cells=9)
        result = solve(problem, Exact(), 0)
        fewest, *_ = brute_force(problem)
        assert result.solved == (fewest is not None)
        if fewest is None:
            assert result.status is SolveStatus.UNSOLVABLE_PROVEN
        else:
            assert len(result.placements) == fewest


def test_an_optimum_can_be_built_in_its_order() -> None:
    source = random.Random(7)
    for _ in range(50):
        task = random_problem(source, most_cells=40).task
        built = 0
        for placed in analysed(task).placements or ():
            assert rules.drop(task.board, built, placed.placement) == placed
            built |= rules.cells_of(task.board, placed)
        assert built in (0, task.silhouette)


def test_by_hand() -> None:
    """A full 3 x 2 board and dominoes lying or standing: three arrangements of three dominoes."""
    board = Board(3, 2)
    answer = analysed(Task(board, board.full, (Block(1, 2), Block(2, 1))))
    assert (answer.fewest_blocks, answer.arrangements, answer.by_rows) == (3, 3, (None, 3))


def test_fewest_blocks_and_arrangements_are_counted_apart() -> None:
    """Of five ways to lay a row of four ones and twos, one has two blocks."""
    board = Board(4, 1)
    answer = analysed(Task(board, board.full, (Block(1, 1), Block(2, 1))))
    assert (answer.fewest_blocks, answer.arrangements, answer.optimal_arrangements) == (2, 5, 1)


def test_what_hangs_in_the_air_cannot_be_built() -> None:
    board = Board(3, 2)
    answer = analysed(Task(board, board.parse(['###', '.#.']), (Block(1, 1),)))
    assert (answer.fewest_blocks, answer.arrangements) == (None, 0)
    bridge = analysed(Task(board, board.parse(['###', '.#.']), (Block(1, 1), Block(3, 1))))
    assert (bridge.fewest_blocks, bridge.arrangements) == (2, 1)


def test_nothing_to_build_takes_no_block() -> None:
    board = Board(3, 2)
    answer = analysed(Task(board, 0))
    assert (answer.fewest_blocks, answer.arrangements, answer.placements) == (0, 1, ())


def test_arrangements_are_exact_beyond_64_bits() -> None:
    """Each of 16 rows is a sum of sixteen by ones and twos: the 17th Fibonacci number of ways."""
    board = Board(16, 16)
    answer = analysed(Task(board, board.full, (Block(1, 1), Block(2, 1))))
    assert answer.arrangements == 1597**16
    assert answer.fewest_blocks == 8 * 16
    assert answer.optimal_arrangements == 1
    odd = analysed(Task(Board(15, 16), Board(15, 16).full, (Block(1, 1), Block(2, 1))))
    assert odd.optimal_arrangements == 8**16  # one single in each row, at one of eight places
    assert odd.arrangements == 987**16
    thrice = analysed(Task(board, board.full, (Block(1, 1), Block(2, 1), Block(3, 1))))
    assert thrice.optimal_arrangements == 21**16  # five threes and a one, or four and two twos


def test_too_large_a_board_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(exact, 'MAX_STATES', 10_000)
    board = Board(16, 16)
    with pytest.raises(LimitExceeded, match=r'16 x 16 cells .* limit of 10000 states'):
        analyse(Task(board, board.full))


def test_a_cancelled_analysis_gives_nothing() -> None:
    token = CancelToken()
    token.cancel()
    board = Board(4, 4)
    assert analyse(Task(board, board.full), token) is None
