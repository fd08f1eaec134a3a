"""The table of what each switch does, on trials that are made so that the answer is known."""

from __future__ import annotations

from typing import Any

import pandas as pd
import pytest

from blocks_planning.analysis.report_tables import switch_rows, table_1_rows
from blocks_planning.analysis.trials import MEASURES


def scoping(lam: float, commit: str, dead_ends: str, cost: float, seed: int = 0) -> dict[str, Any]:
    return {
        'stimulus': 'a',
        'strategy': 'scoping',
        'search': 'bfs',
        'budget': 100,
        'seed': seed,
        'lambda': lam,
        'commit': commit,
        'dead_ends': dead_ends,
        'divisor': None,
        'execute': None,
        'success': True,
        **dict.fromkeys(MEASURES, 1),
        'action_planning_cost': cost,
    }


def test_means_are_over_the_values_of_lambda_and_seeds_that_all_have() -> None:
    rows = [
        scoping(0.0, 'subgoal', 'worst', 1),
        scoping(0.004, 'subgoal', 'worst', 1000),  # is not in the other part
        scoping(0.008, 'subgoal', 'worst', 3),
        scoping(0.008, 'subgoal', 'worst', 1000, seed=1),  # nor is this
        scoping(0.0, 'action', 'worst', 5),
        scoping(0.008, 'action', 'worst', 7),
    ]
    words = ('stimulus', 'strategy', 'search', 'commit', 'dead_ends', 'divisor', 'execute')
    found = switch_rows(
        pd.DataFrame(rows).astype({**dict.fromkeys(words, 'category'), 'success': bool})
    )
    keys = ('settings', 'commit', 'lambdas', 'seeds')
    assert [tuple(row[key] for key in keys) for row in found] == [
        ('published', 'subgoal', 2, 1),
        ('published', 'action', 2, 1),
    ]
    assert [row['action_planning_cost']['mean'] for row in found] == [2, 6]


def test_rows_of_table_1_are_in_its_order_and_random_is_there_once() -> None:
    level = {'mean': 0.1, 'ci': [0.0, 0.2], 'p': None, 'se': 0.01}
    measured = {'success': level, 'states_evaluated': level, 'exact': None}
    table = [
        {'search': 'astar', 'iterations': 8, **measured},
        {'search': 'bfs', 'depth': 2, **measured},
        {'search': 'bfs', 'depth': 1, **measured},
        {'search': 'random', **measured},
        {'search': 'astar', 'iterations': 512, **measured},
    ]
    rows = table_1_rows({'published': {'table1': table}, 'text': {'table1': table}})
    assert [(row['name'], row['budget'], row['preset']) for row in rows] == [
        ('random', '–', ''),
        ('BFS', 'depth 1', 'published'),
        ('BFS', 'depth 1', 'text'),
        ('BFS', 'depth 2', 'published'),
        ('BFS', 'depth 2', 'text'),
        ('A*', '8 iterations', 'published'),
        ('A*', '8 iterations', 'text'),
        ('A*', '512 iterations', 'published'),
        ('A*', '512 iterations', 'text'),
    ]
    paper = rows[1]['paper']['success']
    assert paper is not None
    assert paper['mean'] == pytest.approx(0.099625)
    assert rows[-1]['paper'] == {'success': None, 'states_evaluated': None}
