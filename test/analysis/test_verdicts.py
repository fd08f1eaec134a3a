"""Every claim of the paper is judged, and judged as defined."""

from __future__ import annotations

from typing import Any

import pytest

from blocks_planning.analysis.paper import Claim, Kind, claims
from blocks_planning.analysis.verdicts import FAILS, SAME, WITHIN, judge

LEVEL, EFFECT, NO_EFFECT = Kind


def ours(mean: float | None, low: float | None = None, high: float | None = None) -> Any:
    return {'mean': mean, 'ci': [low, high]}


@pytest.mark.parametrize(
    ('kind', 'value', 'interval', 'found', 'verdict'),
    [
        (LEVEL, 10, (8, 12), ours(11.9, 11, 13), WITHIN),
        (LEVEL, 10, (8, 12), ours(19, 18, 21), SAME),
        (LEVEL, 10, (8, 12), ours(21, 20.5, 22), FAILS),
        (LEVEL, 10, None, ours(30, 5, 60), SAME),
        (LEVEL, 10, None, ours(None), FAILS),
        (EFFECT, -5, (-9, -1), ours(-2, -3, 1), WITHIN),
        (EFFECT, -5, None, ours(-90, -99, -80), SAME),
        (EFFECT, -5, None, ours(-5, -12, 2), FAILS),
        (EFFECT, -5, None, ours(5, 4, 6), FAILS),
        (NO_EFFECT, -0.05, None, ours(0.3, -0.1, 0.7), SAME),
        (NO_EFFECT, -0.05, None, ours(0.3, 0.1, 0.7), FAILS),
        (NO_EFFECT, 1.4, (-0.2, 3.3), ours(0.5, 0.2, 0.8), WITHIN),
    ],
)
def test_verdict(kind: Kind, value: float, interval: Any, found: Any, verdict: str) -> None:
    assert judge(Claim('id', 'words', value, interval, (), kind), found) == verdict


def test_claims_have_names_of_their_own() -> None:
    names = [claim.id for claim in claims()]
    assert len(set(names)) == len(names) == 55


def test_paper_agrees_with_itself() -> None:
    for claim in claims():
        if claim.interval is not None:
            low, high = claim.interval
            assert low <= claim.value <= high, claim.id
