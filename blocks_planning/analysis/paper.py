"""What Binder et al. (2021) report, number by number, as types; :mod:`.paper_file` reads them.

A number is printed in the paper (kind P) or appears only in its published analysis (kind A). A
claim is one quantity with a number of either kind or of both, and the place of ours in the results
of :func:`.results.summarise`. Costs are in states evaluated.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any

TWO_SIDED = 4
"""Factor from the paper's p (half of a one-sided p) to a two-sided p."""
SIGNIFICANT = 0.05

Interval = tuple[float, float]


class Kind(str, Enum):
    """The source of a number of the paper."""

    PRINTED = 'P'
    ANALYSIS = 'A'


@dataclass(frozen=True)
class Reported:
    """A number of the paper.

    Attributes:
        kind: its kind of source.
        source: the part of the paper, or the printed words.
        value: the number; None where only an interval is of this kind.
        interval: 95 % confidence interval; None if the source gives none.
        p: as the paper computes it; None if the source gives none.
        p_below: whether p is only known to be below that.
    """

    kind: Kind
    source: str
    value: float | None = None
    interval: Interval | None = None
    p: float | None = None
    p_below: bool = False

    @property
    def bounds(self) -> Interval:
        """The interval, or the value alone where there is none."""
        if self.interval is not None:
            return self.interval
        if self.value is None:
            raise ValueError(
                'a number without value and interval'
            )  # the reader of the file refuses this
        return (self.value, self.value)

    def to_json(self) -> dict[str, Any]:
        """For ``results.json``; None for what the source does not give."""
        return {
            'mean': self.value,
            'ci': None if self.interval is None else list(self.interval),
            'p': self.p,
            'p_below': self.p_below,
            'source': self.source,
        }


@dataclass(frozen=True)
class Claim:
    """A quantity that the paper reports.

    Attributes:
        id: short and stable.
        statement: description of the quantity.
        path: its place in the results: keys, and settings that select from a list.
        is_effect: whether it can be compared with 0 (a difference, a correlation).
        printed: the number of kind P.
        analysis: the number of kind A.
        contradiction: how the paper contradicts itself here; empty if it does not.
    """

    id: str
    statement: str
    path: tuple[object, ...]
    is_effect: bool
    printed: Reported | None
    analysis: Reported | None
    contradiction: str = ''

    @property
    def judged(self) -> Reported:
        """The number that ours is compared with: the printed one if there is one."""
        reported = self.printed or self.analysis
        if reported is None:
            raise ValueError(f'{self.id}: has no number')  # the reader of the file refuses this
        return reported


@dataclass(frozen=True)
class Paper:
    """All of ``paper.yaml``."""

    claims: tuple[Claim, ...]
    kinds: dict[str, str]
    design: dict[str, Any]
    remarks: dict[str, Reported]
    people: dict[str, float]
    presets: dict[str, str]
    switches: tuple[dict[str, str], ...]
    same: tuple[dict[str, str], ...]


MEASURES = {
    'success': 'success',
    'action_planning_cost': 'action planning cost',
    'subgoal_planning_cost': 'subgoal planning cost',
    'states_evaluated': 'states evaluated',
    'blocks': 'blocks used',
    'subgoals': 'number of subgoals',
}
SEARCHES = {'bfs': 'BFS', 'astar': 'A*', 'random': 'random placement'}
