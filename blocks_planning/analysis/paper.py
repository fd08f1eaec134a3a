"""What Binder et al. (2021) report, number by number: Table 1, section "Results", Figures 2 and 4.

Costs are in states evaluated. An interval is None where the paper gives none. A claim says where
its number stands in the results of :func:`.results.summarise`.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import Enum

Interval = tuple[float, float] | None


class Kind(Enum):
    """What it means that a number goes the paper's way."""

    LEVEL = 'level'  # about as large
    EFFECT = 'effect'  # of the same sign
    NO_EFFECT = 'no effect'  # not to be told from 0


@dataclass(frozen=True)
class Claim:
    """A number of the paper.

    Attributes:
        id: short and stable.
        statement: what is claimed, in words.
        value: the paper's number.
        interval: the paper's 95 % confidence interval.
        path: the number's place in the results: keys, and settings that select from a list.
        kind: see :class:`Kind`.
    """

    id: str
    statement: str
    value: float
    interval: Interval
    path: tuple[object, ...]
    kind: Kind = Kind.LEVEL


_NAMES = {'bfs': 'BFS', 'astar': 'A*', 'random': 'random placement'}

_TABLE_1: tuple[tuple[str, int | None, float, Interval, float, Interval], ...] = (
    ('random', None, 0.038, (0, 0.125), 0, None),
    ('bfs', 1, 0.0996, (0, 0.25), 82.9, (82.0, 84.8)),
    ('bfs', 2, 0.187, (0.0625, 0.3125), 1520, (1447, 1593)),
    ('bfs', 3, 0.263, (0.125, 0.4375), 24_545, (22_165, 26_919)),
    ('bfs', 4, 0.41, (0.1875, 0.625), 351_777, (314_981, 383_281)),
    ('astar', 8, 0.0615, (0, 0.1875), 120, (115, 126)),
    ('astar', 64, 0.083, (0, 0.1875), 342, (328, 371)),
    ('astar', 4096, 0.123, (0, 0.25), 16_533, (14_530, 18_528)),
    ('astar', 65_536, 0.100, (0, 0.25), 157_444, (139_316, 173_152)),
)

_PLANNERS: tuple[tuple[str, str, str, float, Interval], ...] = (
    ('bfs', 'none', 'success', 0.4375, None),
    ('bfs', 'none', 'action_planning_cost', 22_417, (21_755, 26_764)),
    ('astar', 'none', 'success', 0.3125, None),
    ('astar', 'none', 'action_planning_cost', 54_176, None),
    ('bfs', 'scoping', 'success', 0.892, (0.8125, 1)),
    ('bfs', 'scoping', 'action_planning_cost', 11_698, (6_556, 19_088)),
    ('bfs', 'scoping', 'subgoal_planning_cost', 790_000, None),
    ('astar', 'scoping', 'success', 0.857, (0.75, 0.9375)),
    ('astar', 'scoping', 'action_planning_cost', 41_910, (35_938, 51_382)),
    ('astar', 'scoping', 'subgoal_planning_cost', 880_000, None),
    ('bfs', 'full', 'success', 1, None),
    ('bfs', 'full', 'action_planning_cost', 3_344, (3_220, 3_823)),
    ('bfs', 'full', 'subgoal_planning_cost', 10_280_000, (10_010_000, 11_390_000)),
    ('astar', 'full', 'success', 1, None),
    ('astar', 'full', 'action_planning_cost', 27_670, None),
    ('astar', 'full', 'subgoal_planning_cost', 13_940_000, None),
)

_DIFFERENCES: tuple[tuple[str, str, str, str, float, Interval, Kind], ...] = (
    ('bfs', 'full', 'none', 'action_planning_cost', -19_031, None, Kind.EFFECT),
    ('astar', 'full', 'none', 'action_planning_cost', -26_506, None, Kind.EFFECT),
    ('bfs', 'scoping', 'full', 'success', -0.104, (-0.1875, 0), Kind.EFFECT),
    ('astar', 'scoping', 'full', 'success', -0.145, (-0.25, -0.0625), Kind.EFFECT),
    ('bfs', 'scoping', 'full', 'action_planning_cost', 9_107, (3_767, 17_014), Kind.EFFECT),
    ('astar', 'scoping', 'full', 'action_planning_cost', 14_842, (8_268, 25_458), Kind.EFFECT),
    ('bfs', 'scoping', 'full', 'subgoal_planning_cost', -9_530_000, None, Kind.EFFECT),
    ('astar', 'scoping', 'full', 'subgoal_planning_cost', -13_060_000, None, Kind.EFFECT),
    ('bfs', 'scoping', 'full', 'blocks', -2.27, (-6.06, 1.69), Kind.NO_EFFECT),
    ('astar', 'scoping', 'full', 'blocks', -3.10, (-6.19, 0.002), Kind.NO_EFFECT),
    ('bfs', 'scoping', 'none', 'blocks', 5.33, (2.69, 7.88), Kind.EFFECT),
    ('astar', 'scoping', 'none', 'blocks', 1.41, (-0.25, 3.31), Kind.NO_EFFECT),
)

_CORRELATIONS: tuple[tuple[str, float, float], ...] = (
    ('action_planning_cost', -0.93, -0.58),
    ('success', -0.95, -0.84),
    ('subgoals', 0.98, 0.96),
    ('subgoal_planning_cost', 0.96, 0.92),
    ('blocks', 0.56, -0.05),
)

_MEASURES = {
    'success': 'success',
    'action_planning_cost': 'action planning cost',
    'subgoal_planning_cost': 'subgoal planning cost',
    'blocks': 'blocks used',
    'subgoals': 'number of subgoals',
}


def claims() -> list[Claim]:
    """Every number that the paper states."""
    return [*_table_1(), *_planners(), *_differences(), *_correlations()]


def table_1_settings(search: str, amount: int | None) -> dict[str, object]:
    """The settings that select a row of Table 1."""
    if amount is None:
        return {'search': search}
    return {'search': search, 'depth' if search == 'bfs' else 'iterations': amount}


def _table_1() -> Iterator[Claim]:
    for search, amount, success, interval, cost, cost_interval in _TABLE_1:
        place = ('table1', table_1_settings(search, amount))
        name = f'table1.{search}' + (f'-{amount}' if amount else '')
        words = _NAMES[search] + ('' if amount is None else f' {amount}')
        yield Claim(
            f'{name}.success', f'Table 1, {words}: success', success, interval, (*place, 'success')
        )
        if amount:
            yield Claim(
                f'{name}.cost',
                f'Table 1, {words}: states evaluated',
                cost,
                cost_interval,
                (*place, 'states_evaluated'),
            )


def _planners() -> Iterator[Claim]:
    for search, strategy, measure, value, interval in _PLANNERS:
        yield Claim(
            f'{search}.{strategy}.{measure}',
            f'{_NAMES[search]}, {strategy}: {_MEASURES[measure]}'
            + ', mean over lambda' * (strategy == 'scoping'),
            value,
            interval,
            ('planners', search, strategy, measure),
        )


def _differences() -> Iterator[Claim]:
    for search, first, second, measure, value, interval, kind in _DIFFERENCES:
        selected = {'search': search, 'first': first, 'second': second, 'measure': measure}
        yield Claim(
            f'{search}.{first}-minus-{second}.{measure}',
            f'{_NAMES[search]}, {first} minus {second}: {_MEASURES[measure]}',
            value,
            interval,
            ('differences', selected),
            kind,
        )


def _correlations() -> Iterator[Claim]:
    for measure, *values in _CORRELATIONS:
        for search, value in zip(('bfs', 'astar'), values, strict=True):
            yield Claim(
                f'{search}.r-lambda.{measure}',
                f'{_NAMES[search]}, scoping: correlation of lambda with {_MEASURES[measure]}',
                value,
                None,
                ('lambda', search, 'correlation', measure),
                Kind.NO_EFFECT if abs(value) < 0.1 else Kind.EFFECT,
            )
