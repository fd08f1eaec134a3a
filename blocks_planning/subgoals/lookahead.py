"""Looking ahead: the sequences of subgoals that a planner weighs.

Each subgoal of a sequence is a region of the state in which the one before it ends. A sequence has
``horizon`` subgoals, or fewer if it is complete. The sequences of a state are in lexicographic
order. Whether a subgoal can be filled is not considered here.

There can be millions of sequences. They are counted without listing them: the number of
continuations is counted once for each state and number of subgoals left. So a sequence can be found
by its number, and a sample is drawn by drawing numbers.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable
from functools import lru_cache
from itertools import accumulate
from typing import NamedTuple

from blocks_planning.board.geometry import MAX_SIDE, Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import LimitExceeded
from blocks_planning.search.randomness import Generator, mask_words
from blocks_planning.subgoals.aiming import regions_to_aim_at
from blocks_planning.subgoals.decision import Chain
from blocks_planning.subgoals.regions import Region, RegionFamily

MAX_HORIZON = MAX_SIDE
"""Largest horizon: no silhouette has more rows."""
MAX_SEQUENCES = 100_000
"""Largest number of sequences of a decision."""
MOST_STATES = 1 << 18
"""Largest number of states whose continuations are counted in one decision."""
MOST_EXISTING = 1 << 48
"""Largest number of sequences that may exist."""


class Lookahead(NamedTuple):
    """How far a planner looks ahead.

    Attributes:
        family: family of the regions.
        aim: see :mod:`.aiming`.
        horizon: largest number of subgoals of a sequence.
        max_sequences: largest number of considered sequences.
    """

    family: RegionFamily
    aim: str
    horizon: int
    max_sequences: int


class Considered(NamedTuple):
    """The considered sequences, in order, and the number that exist."""

    chains: tuple[Chain, ...]
    existing: int


@lru_cache(maxsize=4)
def considered(how: Lookahead, task: Task, built: Mask, seed: int) -> Considered:
    """The sequences of a state: all of them, or a sample without replacement.

    Every set of ``max_sequences`` sequences is equally likely. The draw depends on the seed, the
    state and the horizon.

    Raises:
        LimitExceeded: if there are too many sequences to count.
    """
    if how.horizon == 1:
        alone = _alone(how, task, built)
        if len(alone) <= how.max_sequences:
            return Considered(alone, len(alone))
    tree = _Tree(how, task)
    existing = tree.count(built, how.horizon)
    if existing > MOST_EXISTING:
        raise _too_far(how)
    numbers: Iterable[int] = range(existing)
    if existing > how.max_sequences:
        generator = Generator([seed, *mask_words(built), how.horizon])
        numbers = sorted(_drawn(generator, existing, how.max_sequences))
    return Considered(tuple(tree.chain(built, number) for number in numbers), existing)


@lru_cache(maxsize=256)
def _alone(how: Lookahead, task: Task, built: Mask) -> tuple[Chain, ...]:
    """Each region of a state alone; trials with other settings come through the same states."""
    return tuple((region,) for region in regions_to_aim_at(how.family, task, built, how.aim))


def _drawn(generator: Generator, existing: int, wanted: int) -> set[int]:
    """Different numbers below ``existing`` (Floyd's algorithm; Bentley and Floyd, 1987)."""
    drawn: set[int] = set()
    for last in range(existing - wanted, existing):
        number = generator.below(last + 1)
        drawn.add(last if number in drawn else number)
    return drawn


def _too_far(how: Lookahead) -> LimitExceeded:
    return LimitExceeded(
        f'horizon {how.horizon} with regions {how.family.name} gives too many sequences to '
        f'count (over {MOST_STATES} states or {MOST_EXISTING} sequences); lower the horizon'
    )


class _Branches(NamedTuple):
    """The regions of a state, and the cumulative number of sequences that begin with them."""

    regions: list[Region]
    totals: list[int]


class _Tree:
    """The sequences of subgoals of a task."""

    def __init__(self, how: Lookahead, task: Task) -> None:
        self._how, self._task = how, task
        self._branches: dict[tuple[Mask, int], _Branches] = {}
        self._ends: dict[Mask, int] = {}
        self._latest: tuple[Mask, list[Region]] = (-1, [])

    def count(self, built: Mask, left: int) -> int:
        """Number of sequences with which up to ``left`` subgoals can follow on a state."""
        if left > 1:
            totals = self._branches_of(built, left).totals
            return totals[-1] if totals else 0
        if built not in self._ends:
            self._check_size()
            self._ends[built] = len(self._regions(built))
        return self._ends[built]

    def chain(self, built: Mask, number: int) -> Chain:
        """The sequence of a number; fast for successive numbers."""
        chain: list[Region] = []
        for left in range(self._how.horizon, 0, -1):
            if chain and self._is_complete(built):
                break
            region, number = self._branch(built, left, number)
            chain.append(region)
            built = region.target(built)
        return tuple(chain)

    def _branch(self, built: Mask, left: int, number: int) -> tuple[Region, int]:
        """The next region of a sequence, and its number among those that continue so."""
        if left == 1:
            return self._regions(built)[number], 0
        regions, totals = self._branches_of(built, left)
        index = bisect_right(totals, number)
        return regions[index], number - (totals[index - 1] if index else 0)

    def _branches_of(self, built: Mask, left: int) -> _Branches:
        found = self._branches.get((built, left))
        if found is None:
            self._check_size()
            regions = self._regions(built)
            numbers = [self._count_after(region.target(built), left - 1) for region in regions]
            found = _Branches(regions, list(accumulate(numbers)))
            self._branches[built, left] = found
        return found

    def _count_after(self, target: Mask, left: int) -> int:
        return 1 if self._is_complete(target) else self.count(target, left)

    def _is_complete(self, target: Mask) -> bool:
        """Whether a sequence may end in a state before the horizon is reached."""
        if not self._task.silhouette & ~target:
            return True
        return self._how.aim == 'most' and not self._regions(target)

    def _regions(self, built: Mask) -> list[Region]:
        if self._latest[0] != built:
            found = regions_to_aim_at(self._how.family, self._task, built, self._how.aim)
            self._latest = built, found
        return self._latest[1]

    def _check_size(self) -> None:
        if len(self._ends) + len(self._branches) >= MOST_STATES:
            raise _too_far(self._how)
