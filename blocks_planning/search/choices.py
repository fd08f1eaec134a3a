"""The choices of bfs and random in any state of a region: the steps of an exact policy."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.board.kernels.masks import WORD_BITS, pack
from blocks_planning.board.task import Task
from blocks_planning.search.compiled import tables_of
from blocks_planning.search.kernels import breadth_first, lookahead, random_placement
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import BreadthFirst

CHUNK = 1 << 15
"""Largest number of states from which random placements are expanded at a time."""


class Way(NamedTuple):
    """A placement that a search can choose: the state it leads to, and its weight."""

    shadow: Mask
    filled: int
    weight: int


class Choices(NamedTuple):
    """The choices of bfs in a state.

    Attributes:
        evaluated: cost of looking ahead from it [states].
        complete: whether it finds a complete state and builds all of it.
        ways: otherwise the possible choices, with probabilities proportional to the weights; none
            if stuck.
    """

    evaluated: int
    complete: bool
    ways: list[Way]


class Chooser:
    """Computes the choices of bfs in any state of a region.

    A state is its shadow (see :mod:`.moves`) and its number of filled cells.
    """

    def __init__(
        self, task: Task, region: Mask, search: BreadthFirst, cancel: CancelToken
    ) -> None:
        """A search for a region; ``cancel`` makes it answer None."""
        tables = tables_of(task, region)
        self._tables, self._cancel = tables, cancel
        self._search = lookahead.make_search(tables, search.depth, search.dead_ends_last)
        words = tables.shadow.reshape(len(tables.shadow), -1).tolist()
        self._shadows = [
            sum(word << WORD_BITS * index for index, word in enumerate(row)) for row in words
        ]
        self._areas = tables.area.tolist()
        most = task.board.width * len(tables.area)
        self._moves, self._weights = np.zeros(most, np.int64), np.zeros(most, np.int64)

    def choices(self, shadow: Mask, filled: int) -> Choices | None:
        """The choices in a state that is not complete; None if cancelled."""
        cells = self._tables.cells
        evaluated, ending, count = breadth_first.choices_from(
            self._search,
            self._tables,
            pack([shadow], cells),
            filled,
            self._cancel.flag,
            self._moves,
            self._weights,
        )
        if ending < 0 or self._cancel.cancelled:
            return None
        moves, weights = self._moves[:count].tolist(), self._weights[:count].tolist()
        ways = [
            Way(shadow | self._shadows[move], filled + self._areas[move // cells], weight)
            for move, weight in zip(moves, weights, strict=True)
        ]
        return Choices(evaluated, ending > 0, ways)


class Layer(NamedTuple):
    """States with equally many filled cells, and the probability of passing through each."""

    states: np.ndarray  # shadows, mask (n,)
    chances: np.ndarray  # float64 (n,)


def spread_at_random(problem: Problem, filled: int, layer: Layer) -> dict[int, Layer]:
    """The layers that random placements reach from a layer, by number of filled cells [cells].

    States from which the region can't be filled any more are left out.
    """
    tables = tables_of(problem.task, problem.region)
    most = len(layer.chances) * problem.task.board.width * len(tables.area)
    after = np.empty((most, *layer.states.shape[1:]), np.uint64)
    areas, chances = np.empty(most, np.int64), np.empty(most)
    written = random_placement.spread(
        random_placement.make_search(tables),
        tables,
        pack([problem.region], tables.cells),
        layer.states,
        filled,
        layer.chances,
        after,
        areas,
        chances,
    )
    after, areas, chances = after[:written], areas[:written], chances[:written]
    return {
        filled + int(size): join_layers([Layer(after[areas == size], chances[areas == size])])
        for size in np.unique(areas)
    }


def chunks_of(layer: Layer) -> Iterator[Layer]:
    """A layer in parts of at most ``CHUNK`` states, to bound the memory of the next layers."""
    for first in range(0, len(layer.chances), CHUNK):
        part = slice(first, first + CHUNK)
        yield Layer(layer.states[part], layer.chances[part])


def join_layers(layers: list[Layer]) -> Layer:
    """Layers merged into one, with each state once."""
    states = np.concatenate([layer.states for layer in layers])
    chances = np.concatenate([layer.chances for layer in layers])
    axis = None if states.ndim == 1 else 0
    states, places = np.unique(states, axis=axis, return_inverse=True)
    return Layer(states, np.bincount(places.ravel(), chances, len(states)))


def layer_of(problem: Problem) -> Layer:
    """The layer of a problem's own state."""
    board = problem.task.board
    return Layer(pack([rules.shadow(board, problem.built)], board.size), np.ones(1))
