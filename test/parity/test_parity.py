"""The record of a trial through the ROS graph is the record of the same trial in one process.

``make parity`` compares more trials, over all 16 towers.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import bag_builders  # noqa: F401  finds ROS packages
import pytest
from graphs import local_lines, record_lines, run_graph, write_script

from blocks_planning.ros.bagging.bags import trials_of

_SMALL: list[dict[str, Any]] = [
    {  # 10
        'stimuli': ['cogsci2021/5', 'cogsci2021/9'],
        'searches': [{'name': 'bfs', 'depth': 2}],
        'strategies': [
            {'name': 'none'},
            {'name': 'scoping', 'lambda': [0.0, 0.01], 'commit': ['subgoal', 'action']},
        ],
        'first_seed': 3,
        'seeds': 1,
    },
    {  # 14
        'stimuli': ['cogsci2021/7'],
        'searches': [
            {'name': 'astar', 'iterations': 64, 'divisor': ['smallest', 'mean']},
            {'name': 'best_first', 'iterations': 64, 'execute': ['first', 'path']},
            {'name': 'random'},
            {'name': 'exact'},
            {'name': 'bfs', 'depth': 1},
        ],
        'strategies': [{'name': 'scoping', 'lambda': 0.001}, {'name': 'full', 'lambda': 0.1}],
        'budget': 5000,
        'first_seed': 2**64 - 1,
        'seeds': 1,
    },
    {  # 18
        'stimuli': ['cogsci2021/5', 'cogsci2021/13'],
        'searches': [{'name': 'bfs', 'depth': 2}],
        'strategies': [
            {'name': 'scoping', 'aim': 'most'},
            {'name': 'full', 'surprise': ['replan', 'blind']},
        ],
        'worlds': [
            {'name': 'simulated', 'slip': 0.3, 'loss': [0.0, 0.4]},
            {'name': 'simulated', 'blocks': 'loose'},
        ],
        'budget': 5000,
        'seeds': 1,
    },
    {  # 3
        'stimuli': ['cogsci2021/5'],
        'searches': [{'name': 'bfs', 'depth': 1}],
        'strategies': [
            {'name': 'scoping', 'regions': 'rectangles', 'choice': 'softmax'},
            {
                'name': 'scoping',
                'regions': 'rectangles',
                'min_cells': 4,
                'horizon': 2,
                'max_sequences': 300,
            },
            {'name': 'scoping', 'horizon': 3, 'choice': 'softmax', 'aggregate': 'softmax'},
        ],
        'budget': 500,
        'seeds': 1,
    },
    {  # 3
        'stimuli': ['cogsci2021/5'],
        'searches': [{'name': 'stable_bfs', 'depth': 1}],
        'strategies': [
            {'name': 'none'},
            {'name': 'scoping', 'commit': 'action'},
            {'name': 'full', 'lambda': 0.1},
        ],
        'worlds': [{'name': 'simulated', 'slip': 0.1, 'blocks': 'loose'}],
        'budget': 10,
        'seeds': 1,
    },
]
_LARGE: list[dict[str, Any]] = [
    {  # 128
        'stimuli': ['cogsci2021'],
        'searches': [{'name': 'bfs', 'depth': 3}],
        'strategies': [
            {'name': 'none'},
            {'name': 'scoping', 'lambda': [0.0, 0.002, 0.03]},
            {'name': 'full', 'lambda': [0.002, 1]},
            {'name': 'scoping', 'lambda': [0.0, 0.002], 'commit': 'action'},
        ],
        'seeds': 1,
    },
    {  # 96
        'stimuli': ['cogsci2021'],
        'searches': [
            {'name': 'astar', 'iterations': 256, 'execute': 'path', 'divisor': 'mean'},
            {'name': 'random'},
            {'name': 'exact'},
        ],
        'strategies': [{'name': 'scoping'}],
        'first_seed': 11,
        'seeds': 2,
    },
    {  # 96
        'stimuli': ['cogsci2021'],
        'searches': [{'name': 'bfs', 'depth': 3}],
        'strategies': [
            {'name': 'scoping', 'aim': 'most'},
            {'name': 'full', 'surprise': ['replan', 'blind']},
        ],
        'worlds': [{'name': 'simulated', 'slip': 0.1, 'loss': [0.0, 0.2]}],
        'seeds': 1,
    },
    {  # 20
        'stimuli': ['cogsci2021/3', 'cogsci2021/12'],
        'library': '1x1,3x1,1x3,2x2',
        'searches': [{'name': 'bfs', 'depth': [1, 2]}, {'name': 'best_first'}],
        'strategies': [{'name': 'none'}, {'name': 'scoping', 'lambda': 0.005}],
        'budget': 20000,
        'seeds': 2,
    },
]
SCRIPTS = [*_SMALL, *(pytest.param(script, marks=pytest.mark.long) for script in _LARGE)]


@pytest.mark.parametrize('script', SCRIPTS, ids=map(str, range(len(SCRIPTS))))
def test_records_are_equal_byte_for_byte(script: dict[str, Any], tmp_path: Path) -> None:
    path = write_script(tmp_path, **script)
    done = run_graph(path, '--out', tmp_path / 'out', '--bag', tmp_path / 'bag')
    assert done.returncode in (0, 1), done.stderr
    assert record_lines(tmp_path / 'out') == local_lines(path)
    trials = list(trials_of(tmp_path / 'bag'))
    assert [trial.record.to_line() for trial in trials] == record_lines(tmp_path / 'out')
    assert [list(trial.contradictions()) for trial in trials] == [[] for _ in trials]
