"""Choices as flat arrays, for vectorised likelihoods."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from blocks_planning.board.geometry import Mask
from blocks_planning.fitting.options import Option, OptionMaker, drawable
from blocks_planning.fitting.points import ChoicePoint

Report = Callable[[int, int], None]
"""Called with the number of finished choices and the number of all choices."""
NONE = -1


@dataclass(frozen=True)
class ChoiceSet:
    """Choices with all their options, under one option maker.

    Options are ordered by choice, sequences by option. Options that cannot be built have no value
    and are omitted.

    Attributes:
        cells: r of each sequence [cells], float64 (sequences,).
        cost: c of each sequence [states], float64 (sequences,).
        option_starts: index of each option's first sequence, int64 (options,).
        choice_starts: index of each choice's first option, int64 (choices,).
        chosen: index of the chosen option among all, or ``NONE`` if the region was not a
            candidate or cannot be built; int64 (choices,).
        drawable: see :func:`.options.drawable`, float64 (choices,).
        tower: of each choice, str (choices,).
        session: of each choice, str (choices,).
        unbuildable: number of chosen regions that are candidates but cannot be built.
        foreign: number of chosen regions that are not candidates.
    """

    cells: np.ndarray
    cost: np.ndarray
    option_starts: np.ndarray
    choice_starts: np.ndarray
    chosen: np.ndarray
    drawable: np.ndarray
    tower: np.ndarray
    session: np.ndarray
    unbuildable: int = 0
    foreign: int = 0

    def __len__(self) -> int:
        return len(self.chosen)

    def option_ends(self) -> np.ndarray:
        """Index after the last option of each choice, int64 (choices,)."""
        return np.append(self.choice_starts[1:], len(self.option_starts))

    def has_options(self) -> np.ndarray:
        """Whether anything can be built in the state of each choice, bool (choices,)."""
        found: np.ndarray = self.cells[self.option_starts[self.choice_starts]] > 0
        return found

    def where(self, keep: np.ndarray) -> ChoiceSet:
        """Some of the choices, in the order given.

        Args:
            keep: bool (choices,), or indices, int64 (kept,).

        ``unbuildable`` and ``foreign`` are unknown for a subset and are 0.
        """
        wanted = np.arange(len(self))[keep]
        options, choice_starts = _slices(self.choice_starts, self.option_ends(), wanted)
        ends = np.append(self.option_starts[1:], len(self.cells))
        sequences, option_starts = _slices(self.option_starts, ends, options)
        shift = choice_starts - self.choice_starts[wanted]
        chosen = self.chosen[wanted]
        return ChoiceSet(
            cells=self.cells[sequences],
            cost=self.cost[sequences],
            option_starts=option_starts,
            choice_starts=choice_starts,
            chosen=np.where(chosen == NONE, NONE, chosen + shift),
            drawable=self.drawable[wanted],
            tower=self.tower[wanted],
            session=self.session[wanted],
        )

    def with_chosen(self, chosen: np.ndarray) -> ChoiceSet:
        """The same situations with other choices, int64 (choices,)."""
        return ChoiceSet(**{**vars(self), 'chosen': chosen, 'unbuildable': 0, 'foreign': 0})


def _slices(
    starts: np.ndarray, ends: np.ndarray, wanted: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """The indices within some groups, concatenated, and the new start of each group."""
    sizes = ends[wanted] - starts[wanted]
    begins = np.cumsum(sizes) - sizes
    indices = np.arange(sizes.sum()) + np.repeat(starts[wanted] - begins, sizes)
    return indices, begins


def choice_set(
    points: Sequence[ChoicePoint], maker: OptionMaker, report: Report | None = None
) -> ChoiceSet:
    """The choices of some points among the options of a maker.

    Args:
        points: states and chosen regions.
        maker: gives the options of each state.
        report: called after each choice, because solves can take long.
    """
    cells: list[int] = []
    cost: list[int] = []
    option_starts: list[int] = []
    choice_starts: list[int] = []
    chosen: list[int] = []
    unbuildable = foreign = 0
    for number, point in enumerate(points, start=1):
        options = maker.options(point.task, point.built, point.asking)
        found = _find(options, point.cells)
        foreign += found is None
        unbuildable += found is not None and not found.sequences
        choice_starts.append(len(option_starts))
        chosen.append(NONE)
        for option in _with_value(options):
            if option is found:
                chosen[-1] = len(option_starts)
            option_starts.append(len(cells))
            for sequence in option.sequences:
                cells.append(sequence.cells)
                cost.append(sequence.cost)
        if choice_starts[-1] == len(option_starts):  # arrays have no empty groups; see has_options
            option_starts.append(len(cells))
            cells.append(0)
            cost.append(0)
        if report:
            report(number, len(points))
    return ChoiceSet(
        cells=np.array(cells, float),
        cost=np.array(cost, float),
        option_starts=np.array(option_starts, np.int64),
        choice_starts=np.array(choice_starts, np.int64),
        chosen=np.array(chosen, np.int64),
        drawable=np.array([drawable(point.task, point.built) for point in points], float),
        tower=np.array([point.tower for point in points], dtype=object),
        session=np.array([point.session for point in points], dtype=object),
        unbuildable=unbuildable,
        foreign=foreign,
    )


def _find(options: Sequence[Option], cells: Mask) -> Option | None:
    return next((option for option in options if option.cells == cells), None)


def _with_value(options: Sequence[Option]) -> list[Option]:
    return [option for option in options if option.sequences]
