"""The compiled rules against the readable ones and against plain sets of cells."""

from __future__ import annotations

import random

import numpy as np
import pytest
from hypothesis import given
from oracles import board as oracle
from strategies import Position, positions

from blocks_planning.board import rules
from blocks_planning.board.blocks import PAPER_LIBRARY, Block, Placed
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.kernels.compiling import kernel
from blocks_planning.board.kernels.masks import (
    WIDE_WORDS,
    WORD_BITS,
    count,
    is_empty,
    load,
    lowest,
    pack,
    store,
    without_lowest,
    words_of,
)
from blocks_planning.board.kernels.moves import has_move, legal_moves, make_tables
from blocks_planning.board.task import Task


@kernel
def _legal_moves(tables, shadow, moves):
    return legal_moves(tables, load(shadow, 0), moves, 0)


@kernel
def _has_move(tables, shadow):
    return has_move(tables, load(shadow, 0))


@kernel
def _mask_operations(pair, shift, results, numbers):
    a, b = load(pair, 0), load(pair, 1)
    store(results, 0, a & b)
    store(results, 1, a | b)
    store(results, 2, ~a)
    store(results, 3, a << shift)
    store(results, 4, a >> shift)
    numbers[0] = count(a)
    numbers[1] = is_empty(a)
    if not is_empty(a):
        numbers[2] = lowest(a)
        store(results, 5, without_lowest(a))


def _unpack(table: np.ndarray) -> list[Mask]:
    rows = table.reshape(len(table), -1).tolist()
    return [sum(word << WORD_BITS * index for index, word in enumerate(row)) for row in rows]


def _moves_of(task: Task, built: Mask, region: Mask) -> tuple[list[Placed], int, bool]:
    """The kernel's moves as placements, in its order; its count; its answer whether any is left."""
    tables = make_tables(task, region)
    shadow = pack([rules.shadow(task.board, built)], task.board.size)
    moves = np.zeros_like(tables.legal)
    children = _legal_moves(tables, shadow, moves)
    placements = [
        Placed(*block, *cell)
        for block, places in zip(task.library, _unpack(moves), strict=True)
        for cell in task.board.cells(places)
    ]
    return placements, children, _has_move(tables, shadow)


def _check_position(position: Position) -> None:
    task, built = position.task, position.built
    expected = list(rules.legal_placements(task, built, task.silhouette))
    placements, children, any_left = _moves_of(task, built, task.silhouette)
    assert placements == expected
    assert children == len(expected)
    assert any_left == bool(expected)


@given(positions())
def test_moves_are_the_legal_placements_in_their_order(position: Position) -> None:
    _check_position(position)


def _random_position(source: random.Random) -> Position:
    board = Board(source.randint(1, 16), source.randint(1, 16))
    sides = range(1, source.choice([2, 4, 16]) + 1)
    library = {Block(source.choice(sides), source.choice(sides)) for _ in range(6)}
    silhouette = source.getrandbits(board.size) | source.getrandbits(board.size)
    task = Task(
        board,
        source.choice([silhouette, board.full]),
        source.choice([PAPER_LIBRARY, tuple(sorted(library)), tuple(library)]),
    )
    built = 0
    for _ in range(source.randint(0, 20)):
        possible = list(rules.possible_placements(board, built, task.library))
        if possible:
            built |= rules.cells_of(board, source.choice(possible))
    return Position(task, built, ())


@pytest.mark.parametrize('batch', range(10))
def test_moves_in_thousands_of_random_states(batch: int) -> None:
    source = random.Random(batch)
    for _ in range(300):
        _check_position(_random_position(source))


@pytest.mark.parametrize('batch', range(4))
def test_the_rules_themselves_against_sets_of_cells(batch: int) -> None:
    source = random.Random(1000 + batch)
    for _ in range(50):
        position = _random_position(source)
        task, board = position.task, position.task.board
        cells = frozenset(board.cells(position.built))
        region = frozenset(board.cells(task.silhouette))
        library = [(block.width, block.height) for block in task.library]
        legal = oracle.legal_placements(board.width, board.height, library, region, cells)
        assert [
            tuple(p) for p in rules.legal_placements(task, position.built, task.silhouette)
        ] == [tuple(p) for p in legal]
        assert rules.is_dead(board, position.built, task.silhouette) == oracle.is_dead(
            region, cells
        )


@pytest.mark.parametrize(('width', 'height'), [(8, 8), (16, 4), (4, 16), (1, 16), (16, 16)])
def test_the_highest_bit_of_a_word_is_a_cell_like_any_other(width: int, height: int) -> None:
    board = Board(width, height)
    task = Task(board, board.full, (Block(1, 1), Block(2, 1)))
    top_corner = board.rectangle(width - 1, 0, 1, height - 1)
    assert 1 << board.size - 1 == board.full & ~(board.full >> 1)
    placements, _, _ = _moves_of(task, top_corner, board.full)
    assert Placed(1, 1, width - 1, height - 1) in placements
    assert placements == list(rules.legal_placements(task, top_corner, board.full))


@pytest.mark.parametrize('cells', [64, 256], ids=['one word', 'four words'])
@pytest.mark.parametrize('shift', [1, 7, 16, 48, 63])
def test_mask_operations(cells: int, shift: int) -> None:
    source = random.Random(cells + shift)
    full = (1 << cells) - 1
    special = [0, 1, full, 1 << 63, (1 << 63) + 1, 1 << cells - 1]
    for a in special + [source.getrandbits(cells) & source.getrandbits(cells) for _ in range(200)]:
        b = source.getrandbits(cells)
        results = pack([0] * 6, cells)
        numbers = np.zeros(3, np.int64)
        _mask_operations(pack([a, b], cells), np.uint64(shift), results, numbers)
        expected = [a & b, a | b, ~a & full, a << shift & full, a >> shift, a & a - 1 if a else 0]
        assert _unpack(results) == expected
        assert numbers.tolist() == [
            a.bit_count(),
            not a,
            (a & -a).bit_length() - 1 if a else 0,
        ]


def test_words_are_little_endian() -> None:
    mask = 1 << 63 | 1 << 64 | 1 << 255
    assert words_of([mask]).tolist() == [[1 << 63, 1, 0, 1 << 63]]
    assert words_of([]).shape == (0, WIDE_WORDS)


def test_a_kernel_is_kept_apart_from_the_kernels_of_other_sources() -> None:
    assert 'kernels-' in legal_moves_cache_path()


def legal_moves_cache_path() -> str:
    return str(_legal_moves._cache._cache_path)
