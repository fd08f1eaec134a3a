"""Each number of the paper is judged, and judged as defined."""

from __future__ import annotations

from typing import Any

import pytest

from blocks_planning.analysis.comparing import count_verdicts, ratio_text
from blocks_planning.analysis.paper import Interval, Kind, Reported
from blocks_planning.analysis.verdicts import DIFFERS, OVERLAP, SAME, judge, leaves_out_0


def paper(value: float | None, interval: Interval | None = None) -> Reported:
    return Reported(Kind.PRINTED, 'made up', value, interval)


def ours(mean: float | None, low: float | None = None, high: float | None = None) -> Any:
    return {'mean': mean, 'ci': [low, high]}


@pytest.mark.parametrize(
    ('reported', 'found', 'effect', 'size'),
    [
        (paper(-5, (-9, -1)), ours(-6, -8, -4), SAME, OVERLAP),
        (paper(-5, (-9, -1)), ours(-60, -80, -40), SAME, DIFFERS),
        (paper(-5, (-9, -1)), ours(6, 4, 8), DIFFERS, DIFFERS),
        # We cannot tell from 0 what the paper can, and the other way round.
        (paper(-5, (-9, -1)), ours(-5, -12, 2), DIFFERS, OVERLAP),
        (paper(-0.05, (-0.2, 0.1)), ours(-0.3, -0.5, -0.1), DIFFERS, OVERLAP),
        # Neither can be told from 0.
        (paper(-0.05, (-0.2, 0.1)), ours(-0.1, -0.5, 0.4), SAME, OVERLAP),
        (paper(-0.05, (-0.2, 0.1)), ours(0.1, -0.3, 0.4), DIFFERS, OVERLAP),
        # An end at 0 does not leave it out.
        (paper(-0.1, (-0.2, 0)), ours(-0.1, -0.3, 0), SAME, OVERLAP),
        (paper(-0.1, (-0.2, 0)), ours(-0.1, -0.3, -0.01), DIFFERS, OVERLAP),
        # 0 is no sign.
        (paper(-0.1, (-0.2, 0)), ours(0, 0, 0), DIFFERS, OVERLAP),
        # An interval of no width, or none.
        (paper(-5, (-5, -5)), ours(-6, -8, -5), SAME, OVERLAP),
        (paper(-5), ours(-6, -8, -5.01), SAME, DIFFERS),
        # The value of an interval alone is its middle.
        (paper(None, (-9, -1)), ours(-6, -8, -4), SAME, OVERLAP),
        (paper(-5, (-9, -1)), ours(None), DIFFERS, DIFFERS),
    ],
)
def test_effect_and_size(reported: Reported, found: Any, effect: str, size: str) -> None:
    verdict = judge(True, reported, found)
    assert (verdict.effect, verdict.size) == (effect, size)
    assert verdict.agrees == (effect == SAME and size == OVERLAP)


def test_level_has_a_size_only() -> None:
    assert judge(False, paper(10, (8, 12)), ours(13, 12, 14)).to_json() == {
        'effect': None,
        'size': OVERLAP,
        'ratio': None,
    }
    verdict = judge(False, paper(10, (8, 12)), ours(25, 12.1, 40))
    assert (verdict.effect, verdict.size, verdict.ratio) == (None, DIFFERS, 2.5)
    assert judge(False, paper(10), ours(None)).effect is None


def test_ratio_to_0_is_undefined() -> None:
    assert judge(False, paper(0, (0, 0)), ours(3, 2, 4)).ratio is None


def test_end_at_0_does_not_leave_it_out() -> None:
    assert leaves_out_0((0.1, 1))
    assert leaves_out_0((-1, -0.1))
    assert not leaves_out_0((0, 1))
    assert not leaves_out_0((-1, 0))


@pytest.mark.parametrize(
    ('ratio', 'size', 'text'),
    [
        (None, OVERLAP, 'overlap'),
        (2.5, DIFFERS, 'x 2.5'),
        (-2.5, DIFFERS, 'other sign'),
        (None, DIFFERS, 'differs'),
    ],
)
def test_size_in_words(ratio: float | None, size: str, text: str) -> None:
    assert ratio_text({'size': size, 'ratio': ratio}) == text


def test_verdicts_are_counted() -> None:
    rows = [
        {'is_effect': True, 'verdict': {'effect': SAME, 'size': DIFFERS}},
        {'is_effect': True, 'verdict': {'effect': DIFFERS, 'size': OVERLAP}},
        {'is_effect': False, 'verdict': {'effect': None, 'size': OVERLAP}},
    ]
    assert count_verdicts(rows) == {
        'effects': 2,
        'effects_same': 1,
        'sizes': 3,
        'sizes_overlap': 2,
    }
