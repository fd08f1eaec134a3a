"""The exact search: fewest blocks, number of arrangements, or proof that there are none.

The order of placing need not be searched. A set of placed rectangles can be built in some order if
and only if it tiles the region and every rectangle rests on the ground or on at least one filled
cell: placed by rising bottom row, each comes to rest in its place. So the problem is a minimum
exact cover, and a dynamic program that always fills the first empty cell, row by row from the left,
solves it. At the end of row k, the state in which exactly rows(k) is filled gives the answer for
the region rows(k).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board, Mask, area
from blocks_planning.board.kernels.masks import WORD_BITS, pack
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.compiled import placements_of
from blocks_planning.search.gauge import Gauge
from blocks_planning.search.kernels.tiling import (
    CANCELLED,
    NO_MOVE,
    OVERFLOW,
    TOO_MANY,
    Layer,
    fill_cell,
    make_layer,
)
from blocks_planning.search.result import CancelToken, Problem, SolveResult, SolveStatus

MAX_STATES = 20_000_000
"""Largest number of states that the dynamic program stores, over all cells (about 1 GB)."""


@dataclass(frozen=True)
class ExactAnswer:
    """Exact properties of a silhouette and a library.

    Attributes:
        fewest_blocks: that rebuild the silhouette; None if it cannot be rebuilt.
        arrangements: number of different sets of placed blocks that rebuild it.
        optimal_arrangements: number of those that have ``fewest_blocks`` blocks.
        by_rows: fewest blocks for the regions rows(1) to rows(height).
        placements: a plan with the fewest blocks, in an order in which it can be built.
    """

    fewest_blocks: int | None
    arrangements: int
    optimal_arrangements: int
    by_rows: tuple[int | None, ...]
    placements: tuple[Placed, ...] | None


class _Cancelled(Exception):
    """The token was cancelled."""


class _CountOverflow(Exception):
    """The number of arrangements needs more words."""


def analyse(
    task: Task, cancel: CancelToken | None = None, gauge: Gauge | None = None
) -> ExactAnswer | None:
    """Fewest blocks and number of arrangements of a silhouette; None if cancelled.

    Args:
        task: silhouette and blocks.
        cancel: ends it from another thread.
        gauge: shows the progress; a step is a cell.

    Raises:
        LimitExceeded: if more than ``MAX_STATES`` states would be stored.
    """
    problem = Problem(task, 0, task.silhouette)
    words = 1
    while True:
        program = _Program(problem, words, cancel or CancelToken(), gauge or Gauge())
        try:
            program.run()
        except _CountOverflow:
            words *= 2
            continue
        except _Cancelled:
            return None
        fewest, arrangements, optimal = program.answer_at(task.board.height)
        return ExactAnswer(
            fewest_blocks=fewest,
            arrangements=arrangements,
            optimal_arrangements=optimal,
            by_rows=tuple(program.answer_at(k)[0] for k in range(1, task.board.height + 1)),
            placements=None if fewest is None else program.placements(),
        )


def solve_exactly(problem: Problem, cancel: CancelToken) -> SolveResult:
    """Fill the region with the fewest blocks, or prove that it cannot be filled.

    Raises:
        LimitExceeded: see :func:`analyse`.
    """
    program = _Program(problem, 0, cancel, Gauge())
    try:
        program.run()
    except _Cancelled:
        return SolveResult(SolveStatus.CANCELLED, planning_cost=program.generated)
    cost = program.generated
    if program.answer_at(problem.task.board.height)[0] is None:
        return SolveResult(SolveStatus.UNSOLVABLE_PROVEN, planning_cost=cost, attempts=1)
    return SolveResult(SolveStatus.SOLVED, program.placements(), cost, cost, attempts=1)


class _Program:
    """The dynamic program of one problem; ``words`` 64-bit words count arrangements."""

    def __init__(self, problem: Problem, words: int, cancel: CancelToken, gauge: Gauge) -> None:
        self._problem = problem
        self._gauge = gauge
        self._board = problem.task.board
        self._words = words
        self._cancel = cancel
        self._mask_shape = pack([0], self._board.size).shape[1:]
        self._ways: list[tuple[np.ndarray, np.ndarray]] = []
        self._answers: dict[int, tuple[int | None, int, int]] = {}
        self.generated = 0

    def run(self) -> None:
        """Fill cell after cell."""
        problem, board = self._problem, self._board
        if rules.is_dead(board, problem.built, problem.region):
            return
        layer = make_layer(1, self._mask_shape, self._words)
        layer.filled[:] = pack([problem.built], board.size)
        layer.fewest[:] = 0
        for counts in (layer.arrangements, layer.optimal):
            counts[:] = 0
            counts[:, :1] = 1
        gauge = self._gauge
        gauge.done, gauge.total, gauge.states = 0, area(problem.region & ~problem.built), 0
        for row in range(board.height):
            for column in range(board.width):
                cell = board.mask([(column, row)])
                if cell & problem.region & ~problem.built:
                    layer = self._fill(layer, cell)
                    self._ways.append((layer.parent, layer.move))
                    gauge.done += 1
                    gauge.states += len(layer.move)
                    if gauge.states > MAX_STATES:
                        raise self._too_large()
            self._keep_answer(row + 1, layer)

    def _fill(self, layer: Layer, cell: Mask) -> Layer:
        """The layer after a cell."""
        board = self._board
        choices = list(self._choices(board.cell(cell.bit_length() - 1)))
        size = len(layer.fewest)
        most = min(size * max(1, len(choices)), MAX_STATES)
        following = make_layer(most, self._mask_shape, self._words)
        reached, generated = fill_cell(
            layer,
            size,
            pack([cell], board.size),
            pack([cells for cells, _ in choices], board.size),
            np.array([move for _, move in choices], np.int16),
            following,
            np.full(1 << (2 * most).bit_length(), -1, np.int32),
            self._cancel.flag,
        )
        self.generated += generated
        if reached == CANCELLED:
            raise _Cancelled
        if reached == OVERFLOW:
            raise _CountOverflow
        if reached == TOO_MANY:
            raise self._too_large()
        return Layer(*(array[:reached].copy() for array in following))

    def _choices(self, cell: tuple[int, int]) -> Iterator[tuple[Mask, int]]:
        """The blocks that may have their lower left cell here: their cells and their moves."""
        board, region = self._board, self._problem.region
        for index, block in enumerate(self._problem.task.library):
            placed = Placed(*block, *cell)
            if _fits(board, placed):
                cells = rules.cells_of(board, placed)
                inside = not cells & (~region | self._problem.built)
                if inside and _is_supported(board, placed, region):
                    yield cells, index * board.size + board.bit(*cell)

    def _keep_answer(self, height: int, layer: Layer) -> None:
        """Store the answer for the rows below a height."""
        region = self._problem.region & self._board.rows_below(height) | self._problem.built
        same = layer.filled == pack([region], self._board.size)[0]
        for state in np.flatnonzero(same if same.ndim == 1 else same.all(axis=1)):
            self._answers[height] = (
                int(layer.fewest[state]),
                _count_of(layer.arrangements[state]),
                _count_of(layer.optimal[state]),
            )

    def answer_at(self, height: int) -> tuple[int | None, int, int]:
        """Fewest blocks, arrangements, and those with the fewest, of the rows below a height."""
        return self._answers.get(height, (None, 0, 0))

    def placements(self) -> tuple[Placed, ...]:
        """A plan with the fewest blocks, by rising bottom row."""
        moves = []
        state = 0  # the last layer has one state: the region
        for parent, move in reversed(self._ways):
            if move[state] != NO_MOVE:
                moves.append(int(move[state]))
            state = int(parent[state])
        return placements_of(self._problem, moves[::-1])

    def _too_large(self) -> LimitExceeded:
        board = self._board
        return LimitExceeded(
            f'exact: a region of this shape on {board.width} x {board.height} cells needs more '
            f'than the limit of {MAX_STATES} states'
        )


def _count_of(words: np.ndarray) -> int:
    """The number that some words represent, the lowest first."""
    return sum(word << WORD_BITS * index for index, word in enumerate(words.tolist()))


def _fits(board: Board, placed: Placed) -> bool:
    return (
        placed.column + placed.width <= board.width and placed.row + placed.height <= board.height
    )


def _is_supported(board: Board, placed: Placed, region: Mask) -> bool:
    """Whether a placed block rests on the ground or, in the complete region, on a filled cell."""
    if placed.row == 0:
        return True
    return bool(board.rectangle(placed.column, placed.row - 1, placed.width, 1) & region)
