"""Formats of the numbers in the report."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from blocks_planning.analysis.paper import TWO_SIDED

_SMALLEST_P = 0.001


def format_number(value: float | None) -> str:
    """A readable number: three or four digits, thousands separated, '–' for none."""
    if value is None:
        return '–'
    if abs(value) >= 1e6:
        return f'{value / 1e6:,.2f} M'
    if abs(value) >= 100:
        return f'{value:,.0f}'
    return f'{value:.3g}' if value == 0 or abs(value) >= 1e-3 else f'{value:.1e}'


def format_interval(estimate: Mapping[str, Any]) -> str:
    """The interval of an estimate as text; empty if it has none."""
    bounds = estimate.get('ci')
    if not bounds or bounds[0] is None:
        return ''
    low, high = map(format_number, bounds)
    return f'[{low}, {high}]'


def with_interval(estimate: Mapping[str, Any]) -> str:
    """Value and interval, as far as they exist."""
    value = estimate['mean']
    words = ['' if value is None else format_number(value), format_interval(estimate)]
    return ' '.join(filter(None, words)) or format_number(None)


def format_p(estimate: Mapping[str, Any]) -> str:
    """p as the paper computes it, and two-sided; empty if there is none."""
    p = estimate.get('p')
    if p is None:
        return ''
    if estimate.get('p_below') or p < _SMALLEST_P:
        return f'p < {max(p, _SMALLEST_P):g}'
    return f'p = {p:.3g} (two-sided {min(1.0, TWO_SIDED * p):.3g})'


def format_own(estimate: Mapping[str, Any]) -> str:
    """Our own mean with its standard error."""
    value = estimate.get('of_means', estimate['mean'])
    error = estimate.get('se')
    if value is None:
        return format_number(None)
    return format_number(value) + ('' if error is None else f' ± {format_number(error)}')


def format_count(number: int) -> str:
    """A whole number of any size: separated up to twelve digits, else as a power of ten."""
    return f'{number:,}' if number < 10**12 else format_power(number)


def format_power(number: float) -> str:
    """A large number with two digits and its power of ten."""
    digits, _, power = f'{number:.1e}'.partition('e')
    return f'{digits} × 10^{int(power)}'
