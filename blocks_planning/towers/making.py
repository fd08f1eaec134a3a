"""Generates towers: makes candidates one after the other, and keeps those within wanted ranges.

Candidate number i depends only on the seed, i and the recipe, so the same call gives the same
towers on every machine.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from blocks_planning.board.blocks import PAPER_LIBRARY, Library
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.gauge import Gauge
from blocks_planning.search.result import CancelToken
from blocks_planning.towers.candidates import Candidate, drop_blocks, with_a_cell_changed
from blocks_planning.towers.measures import DIFFICULTY, LOOSE, NAMES, Instruments, measured
from blocks_planning.towers.ranges import Range

_MOST_CHANGES = 8
_DROPPED = Range(6, 10)


@dataclass(frozen=True)
class Recipe:
    """The wanted properties of towers.

    Attributes:
        board: their size.
        dropped: number of blocks that are dropped to make one.
        library: the blocks.
        solvable: whether the library can rebuild them; if not, cells of a tower are changed.
        wanted: ranges by the name of the measure (:mod:`.measures`).
        instruments: for measures that need a planner or statics.
        tries: largest number of candidates for each tower.

    Raises:
        ConfigurationError: for an unknown measure, or one that needs a missing instrument.
    """

    board: Board
    dropped: Range = _DROPPED
    library: Library = PAPER_LIBRARY
    solvable: bool = True
    wanted: Mapping[str, Range] = field(default_factory=dict)
    instruments: Instruments = field(default_factory=Instruments)
    tries: int = 2_000

    def __post_init__(self) -> None:
        for name in self.wanted:
            if name not in NAMES:
                raise ConfigurationError(
                    f'unknown measure {name!r}; expected one of {", ".join(NAMES)}'
                )
            if name in LOOSE and self.instruments.holds is None:
                raise ConfigurationError(f'measure {name!r} needs statics for loose blocks')
            if name in DIFFICULTY and self.instruments.planner is None:
                raise ConfigurationError(f'measure {name!r} needs a planner')
        if not 1 <= self.dropped.least <= self.dropped.most <= self.board.size:
            raise ConfigurationError(
                f'blocks to drop must be 1 to {self.board.size}, got {self.dropped}'
            )


@dataclass(frozen=True)
class Made:
    """A tower that was made: its silhouette and its measures by name."""

    board: Board
    silhouette: Mask
    measures: Mapping[str, float]


def make_towers(
    recipe: Recipe,
    count: int,
    seed: int,
    cancel: CancelToken | None = None,
    gauge: Gauge | None = None,
) -> list[Made]:
    """Different towers of a recipe, in the order of generation.

    Args:
        recipe: the wanted properties.
        count: number of towers.
        seed: of all choices, 0 or more.
        cancel: ends it from another thread; there are fewer towers then.
        gauge: shows the progress; a step is a tower, a state a candidate.

    Raises:
        ConfigurationError: if ``recipe.tries`` candidates for each tower do not give enough; the
            message counts the reasons.
    """
    cancel, gauge = cancel or CancelToken(), gauge or Gauge()
    gauge.total = count
    found: dict[Mask, Made] = {}
    missed: Counter[str] = Counter()
    for number in range(recipe.tries * count):
        if len(found) == count or cancel.cancelled:
            return list(found.values())
        gauge.states = number + 1
        candidate = _candidate(recipe, np.random.default_rng([seed, number]))
        if candidate is None or candidate.silhouette in found:
            missed['room on the board' if candidate is None else 'being different'] += 1
            continue
        made = _measure(recipe, candidate, cancel, missed)
        if made is not None:
            found[candidate.silhouette] = made
            gauge.done = len(found)
    if len(found) < count and not cancel.cancelled:
        reasons = ', '.join(f'{name} ({times} times)' for name, times in missed.most_common(4))
        raise ConfigurationError(
            f'found {len(found)} of {count} towers among {recipe.tries * count} candidates; the '
            f'others failed: {reasons}; widen these ranges, or try more candidates'
        )
    return list(found.values())


def _candidate(recipe: Recipe, rng: np.random.Generator) -> Candidate | None:
    low, high = int(recipe.dropped.least), int(recipe.dropped.most)
    candidate = drop_blocks(recipe.board, recipe.library, int(rng.integers(low, high + 1)), rng)
    if candidate is None or recipe.solvable:
        return candidate
    silhouette = candidate.silhouette
    for _ in range(int(rng.integers(1, _MOST_CHANGES + 1))):
        silhouette = with_a_cell_changed(recipe.board, silhouette, rng) or silhouette
    return Candidate(silhouette, ())


def _measure(
    recipe: Recipe, candidate: Candidate, cancel: CancelToken, missed: Counter[str]
) -> Made | None:
    """The tower with its measures; None, with the reason counted, if it is outside the ranges."""
    task = Task(recipe.board, candidate.silhouette, recipe.library)
    wanted = {'solvable': Range(int(recipe.solvable), int(recipe.solvable)), **recipe.wanted}
    measures: dict[str, float] = {}
    try:
        for group in measured(task, candidate, recipe.instruments, cancel):
            measures.update(group)
            for name in group.keys() & wanted.keys():
                if group[name] not in wanted[name]:
                    missed[f'{name} {wanted[name]}'] += 1
                    return None
    except LimitExceeded:
        missed['the limit of exact'] += 1
        return None
    return (
        None if wanted.keys() - measures.keys() else Made(recipe.board, task.silhouette, measures)
    )
