"""Reads ``paper.yaml``, which contains every number of Binder et al. (2021)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from blocks_planning.analysis.paper import (
    MEASURES,
    SEARCHES,
    Claim,
    Interval,
    Kind,
    Paper,
    Reported,
)
from blocks_planning.located import Located, read_yaml

DATA = Path(__file__).with_name('paper.yaml')


@cache
def the_paper() -> Paper:
    """The paper's numbers as they ship with the package."""
    return read_paper(DATA)


def read_paper(path: Path) -> Paper:
    """Read a file like ``paper.yaml``.

    Raises:
        ConfigurationError: naming file, line and key, for a missing or unknown key, a value that is
            not a number, or an interval that is reversed or does not contain its value.
    """
    top = read_yaml(path).entries(
        *('paper', 'kinds', 'design', 'table1', 'planners', 'differences', 'correlations'),
        *('remarks', 'people', 'presets', 'switches', 'same'),
    )
    claims = (
        *_table_1(top['table1']),
        *_by_search(top['planners'], 'planners', ('strategy', 'measure')),
        *_by_search(top['differences'], 'differences', ('first', 'second', 'measure')),
        *_by_search(top['correlations'], 'lambda', ('measure',)),
    )
    return Paper(
        claims=claims,
        kinds=top['kinds'].plain(),
        design=top['design'].plain(),
        remarks={
            name: _reported(entry.entries('P')['P'], Kind.PRINTED)
            for name, entry in top['remarks'].mapping().items()
        },
        people=top['people'].plain(),
        presets=top['presets'].plain(),
        switches=tuple(
            _words(item, 'what', 'setting', 'published', 'text', 'says')
            for item in top['switches'].items()
        ),
        same=tuple(_words(item, 'what', 'says') for item in top['same'].items()),
    )


def _words(item: Located, *keys: str) -> dict[str, str]:
    return {key: str(value.content) for key, value in item.entries(*keys).items()}


def _table_1(section: Located) -> Iterator[Claim]:
    for item in section.items():
        entries = item.entries('of', 'success', 'states_evaluated')
        of = entries['of'].plain()
        if of.get('search') not in SEARCHES:
            raise entries['of'].fail(f'expected a search of {", ".join(SEARCHES)}')
        settings = [value for key, value in of.items() if key != 'search']
        name = '-'.join(map(str, (of['search'], *settings)))
        words = ' '.join(map(str, (SEARCHES[of['search']], *settings)))
        for measure in ('success', 'states_evaluated'):
            yield _claim(
                entries[measure],
                f'table1.{name}.{measure}',
                f'Table 1, {words}: {MEASURES[measure]}',
                ('table1', of, measure),
                is_effect=False,
            )


def _by_search(section: Located, place: str, keys: tuple[str, ...]) -> Iterator[Claim]:
    """The claims of a section that has a number for BFS and one for A* in each entry."""
    for item in section.items():
        entries = item.entries('of', 'bfs', 'astar')
        of = {key: value.content for key, value in entries['of'].entries(*keys).items()}
        if of['measure'] not in MEASURES:
            raise entries['of'].fail(f'{of["measure"]!r} is not a measure')
        for search in ('bfs', 'astar'):
            name, words, path = _NAMED[place](search, of)
            yield _claim(
                entries[search],
                name,
                f'{SEARCHES[search]}, {words}',
                path,
                is_effect=place != 'planners',
            )


def _name_planner(search: str, of: dict[str, str]) -> tuple[str, str, tuple[object, ...]]:
    strategy, measure = of['strategy'], of['measure']
    over = ', mean over lambda' * (strategy == 'scoping')
    words = f'{strategy}: {MEASURES[measure]}{over}'
    return f'{search}.{strategy}.{measure}', words, ('planners', search, strategy, measure)


def _name_difference(search: str, of: dict[str, str]) -> tuple[str, str, tuple[object, ...]]:
    first, second, measure = of['first'], of['second'], of['measure']
    words = f'{first} minus {second}: {MEASURES[measure]}'
    name = f'{search}.{first}-minus-{second}.{measure}'
    return name, words, ('differences', {'search': search, **of})


def _name_correlation(search: str, of: dict[str, str]) -> tuple[str, str, tuple[object, ...]]:
    measure = of['measure']
    words = f'scoping: correlation of lambda with {MEASURES[measure]}'
    return f'{search}.r-lambda.{measure}', words, ('lambda', search, 'correlation', measure)


_NAMED = {
    'planners': _name_planner,
    'differences': _name_difference,
    'lambda': _name_correlation,
}


def _claim(
    entry: Located, name: str, statement: str, path: tuple[object, ...], *, is_effect: bool
) -> Claim:
    entries = entry.entries(optional=('P', 'A', 'contradiction'))
    told = str(entries['contradiction'].content) if 'contradiction' in entries else ''
    numbers = {
        kind: _reported(entries[kind.value], kind, contradicted=bool(told))
        for kind in Kind
        if kind.value in entries
    }
    if not numbers:
        raise entry.fail('expected a number of kind P or A')
    return Claim(
        name,
        statement,
        path,
        is_effect,
        numbers.get(Kind.PRINTED),
        numbers.get(Kind.ANALYSIS),
        told,
    )


_ROUNDED = 5e-6
"""Relative difference caused by rounding to six digits."""


def _reported(entry: Located, kind: Kind, *, contradicted: bool = False) -> Reported:
    entries = entry.entries('source', optional=('value', 'interval', 'p'))
    value = _number(entries['value']) if 'value' in entries else None
    interval = _interval(entries['interval']) if 'interval' in entries else None
    if value is None and interval is None:
        raise entry.fail('expected a value or an interval')
    if value is not None and interval is not None and not contradicted:
        slack = _ROUNDED * abs(value)
        if not interval[0] - slack <= value <= interval[1] + slack:
            raise entry.fail(f'the interval {list(interval)} does not contain the value {value:g}')
    p, below = _p_value(entries['p']) if 'p' in entries else (None, False)
    return Reported(kind, str(entries['source'].content), value, interval, p, below)


def _number(entry: Located) -> float:
    number = entry.content
    is_number = isinstance(number, (int, float)) and not isinstance(number, bool)
    if not is_number or not math.isfinite(number):
        raise entry.fail(f'expected a number, got {entry}')
    return float(number)


def _interval(entry: Located) -> Interval:
    bounds = [_number(item) for item in entry.items()]
    if len(bounds) != 2 or bounds[0] > bounds[1]:
        raise entry.fail(f'expected [low, high], got {bounds}')
    return bounds[0], bounds[1]


def _p_value(entry: Located) -> tuple[float, bool]:
    """p, and whether it is written as '<p'."""
    text = str(entry.content)
    try:
        p = float(text.removeprefix('<'))
    except ValueError:
        p = -1.0
    if not 0 <= p <= 1:
        raise entry.fail(f'expected a p-value such as 0.04 or <0.001, got {entry}')
    return p, text.startswith('<')
