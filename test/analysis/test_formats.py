"""Numbers as the report writes them."""

from __future__ import annotations

from typing import Any

import pytest

from blocks_planning.analysis.formats import (
    format_count,
    format_number,
    format_own,
    format_p,
    with_interval,
)


@pytest.mark.parametrize(
    ('value', 'text'),
    [
        *((None, '–'), (0.0, '0'), (0.4375, '0.438'), (-0.25, '-0.25'), (0.0001, '1.0e-04')),
        *((1520.4, '1,520'), (-19_030.8, '-19,031'), (9_406_820, '9.41 M')),
    ],
)
def test_number(value: float | None, text: str) -> None:
    assert format_number(value) == text


@pytest.mark.parametrize(
    ('estimate', 'text'),
    [
        ({'p': None}, ''),
        ({'p': 0.0415}, 'p = 0.0415 (two-sided 0.166)'),
        ({'p': 0.4}, 'p = 0.4 (two-sided 1)'),
        ({'p': 0.0}, 'p < 0.001'),
        ({'p': 0.001, 'p_below': True}, 'p < 0.001'),
    ],
)
def test_p(estimate: dict[str, Any], text: str) -> None:
    assert format_p(estimate) == text


def test_interval_without_a_value() -> None:
    assert with_interval({'mean': None, 'ci': [-6.19, 0.002]}) == '[-6.19, 0.002]'
    assert with_interval({'mean': 1.0, 'ci': None}) == '1'
    assert with_interval({'mean': None, 'ci': None}) == '–'


def test_own_mean() -> None:
    assert format_own({'mean': 0.5, 'se': 0.01}) == '0.5 ± 0.01'
    assert format_own({'mean': 0.5, 'se': None}) == '0.5'
    assert format_own({'mean': 0.5, 'of_means': 0.75, 'se': 0.25}) == '0.75 ± 0.25'
    assert format_own({'mean': None, 'se': None}) == '–'


def test_count() -> None:
    assert format_count(8_887_586_440) == '8,887,586,440'
    assert format_count(35**15) == '1.4 × 10^23'
