"""The probability of a choice, option by option, from its definition."""

from __future__ import annotations

from collections.abc import Sequence
from math import exp

Options = Sequence[Sequence[tuple[float, float]]]
"""For each option the sequences that begin with it: cells and cost of each."""


def probability(
    options: Options,
    chosen: int | None,
    drawable: int,
    lapse: float,
    per_cell: float,
    per_state: float,
) -> float:
    """How likely a choice is; options without a sequence cannot be built and are never meant.

    Args:
        options: of the state.
        chosen: index of the option; None for a region that is none.
        drawable: number of regions that a lapse may hit.
        lapse: probability of one.
        per_cell: what a cell adds to the exponent.
        per_state: what a state evaluated adds to it.
    """
    weights = [
        max((exp(per_cell * r + per_state * c) for r, c in sequences), default=0.0)
        for sequences in options
    ]
    if not any(weights):
        return 1 / drawable
    meant = weights[chosen] / sum(weights) if chosen is not None and weights[chosen] else 0.0
    return (1 - lapse) * meant + lapse / drawable
