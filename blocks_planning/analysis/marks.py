"""The paper's numbers as marks in figures: filled if printed, hollow if only in the analysis."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

from blocks_planning.analysis.paper import Claim, Kind
from blocks_planning.analysis.paper_file import the_paper

SHAPE = 'D'
LABELS = {
    Kind.PRINTED: 'paper, printed',
    Kind.ANALYSIS: 'paper, published analysis',
}


class Mark(NamedTuple):
    """A number of the paper, and its source."""

    value: float
    kind: Kind


@cache
def _by_path() -> dict[str, Claim]:
    return {str(claim.path): claim for claim in the_paper().claims}


def mark_of(*path: object) -> Mark | None:
    """The paper's number for a place in the results; None if there is none."""
    claim = _by_path().get(str(path))
    if claim is None:
        return None
    reported = claim.judged
    return None if reported.value is None else Mark(reported.value, reported.kind)


def style_of(kind: Kind, colour: str) -> dict[str, Any]:
    """The style of a mark."""
    printed = kind is Kind.PRINTED
    return {
        'marker': SHAPE,
        'mfc': colour if printed else 'white',
        'mec': 'black' if printed else colour,
        'mew': 0.9 if printed else 1.6,
        'ms': 6,
        'ls': 'none',
    }


def legend_handles(ax: Any, colour: str = '#777777') -> list[Any]:
    """A mark of each kind for a legend."""
    return [
        ax.plot([], [], label=label, **style_of(kind, colour))[0] for kind, label in LABELS.items()
    ]
