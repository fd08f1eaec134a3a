"""Agreement of a board with its silhouette."""

from __future__ import annotations

from typing import NamedTuple

from blocks_planning.board.geometry import Mask, area


class Measures(NamedTuple):
    """Agreement of filled and target cells, each from 0 to 1; 1 if there are neither.

    Attributes:
        recall: share of the target cells that are filled.
        precision: share of the filled cells that are target cells.
        f1: harmonic mean of both (the score of McCarthy, Kirsh and Fan, 2020).
        iou: cells that are both, divided by cells that are either.
    """

    recall: float
    precision: float
    f1: float
    iou: float

    @classmethod
    def of(cls, built: Mask, silhouette: Mask) -> Measures:
        """The measures of a board's filled cells."""
        both, filled, target = area(built & silhouette), area(built), area(silhouette)
        return cls(
            recall=_ratio(both, target),
            precision=_ratio(both, filled),
            f1=_ratio(2 * both, filled + target),
            iou=_ratio(both, area(built | silhouette)),
        )


def _ratio(part: int, whole: int) -> float:
    return part / whole if whole else 1.0
