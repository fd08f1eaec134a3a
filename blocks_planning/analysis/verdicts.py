"""Comparison of our numbers with the paper's: two verdicts for each.

Both intervals are of the same kind: 1000 iterations, each drawing one run per silhouette.

*effect* (differences and correlations only): ``same`` if ours has the sign of the paper's, and both
or neither are significant, that is if both or neither interval excludes 0; else ``differs``. An
effect that is significant here but not in the paper differs. A level has no such verdict.

*size*: ``overlap`` if the intervals share a value; else ``differs``, with the ratio of ours to the
paper's. A number that the paper gives without an interval counts as an interval of no width.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from blocks_planning.analysis.paper import Interval, Reported

SAME = 'same'
OVERLAP = 'overlap'
DIFFERS = 'differs'


@dataclass(frozen=True)
class Verdict:
    """The two verdicts.

    Attributes:
        effect: SAME or DIFFERS; None for a level.
        size: OVERLAP or DIFFERS.
        ratio: ours divided by the paper's where the sizes differ; None if there is none.
    """

    effect: str | None
    size: str
    ratio: float | None

    @property
    def agrees(self) -> bool:
        """Whether nothing differs."""
        return DIFFERS not in (self.effect, self.size)

    def to_json(self) -> dict[str, Any]:
        """For ``results.json``."""
        return {'effect': self.effect, 'size': self.size, 'ratio': self.ratio}


def judge(is_effect: bool, paper: Reported, ours: Mapping[str, Any]) -> Verdict:
    """Compare ours, ``{"mean": ..., "ci": [low, high], ...}``, with a number of the paper.

    If ours is undefined (mean None), both verdicts are that it differs.
    """
    if ours['mean'] is None:
        return Verdict(DIFFERS if is_effect else None, DIFFERS, None)
    mean, bounds = ours['mean'], (ours['ci'][0], ours['ci'][1])
    value = _value(paper)
    effect = None
    if is_effect:
        same_sign = _sign(mean) == _sign(value)
        told = leaves_out_0(bounds) == leaves_out_0(paper.bounds)
        effect = SAME if same_sign and told else DIFFERS
    low, high = paper.bounds
    if bounds[0] <= high and low <= bounds[1]:
        return Verdict(effect, OVERLAP, None)
    return Verdict(effect, DIFFERS, mean / value if value else None)


def leaves_out_0(bounds: Interval) -> bool:
    """Whether an interval, including its ends, excludes 0: whether an effect is significant."""
    return bounds[0] > 0 or bounds[1] < 0


def _value(paper: Reported) -> float:
    """The number, or the middle of the interval where only that is given."""
    return sum(paper.bounds) / 2 if paper.value is None else paper.value


def _sign(number: float) -> int:
    return (number > 0) - (number < 0)
