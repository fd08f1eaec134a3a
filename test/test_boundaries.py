"""Imports point one way: towards the ground of the house.

::

    cli  ->  ros  ->  view | experiments | analysis | robot  ->  fitting  ->  people | study | towers
         ->  trials  ->  worlds  ->  subgoals  ->  search  ->  board  ->  external | families
         ->  extras | located | resources | settings  ->  errors
"""

from __future__ import annotations

import re

import pytest
from source_imports import PACKAGE, Source, imports, package_sources

LAYERS = [
    {'errors'},
    {'extras', 'located', 'resources', 'settings'},
    {'external', 'families'},
    {'board'},
    {'search'},
    {'subgoals'},
    {'worlds'},
    {'trials'},
    {'people', 'study', 'towers'},
    {'fitting'},
    {'view', 'experiments', 'analysis', 'robot'},
    {'ros'},
    {'cli'},
    {'testing'},
    {'__main__'},
]
LEVEL = {part: level for level, parts in enumerate(LAYERS) for part in parts}
ROS = re.compile(r'rclpy|rclpy_.*|ament_.*|launch(_.*)?|rosidl_.*|.*_(msgs|srvs|interfaces)')
CONFINED = {
    'aiohttp': {'view'},
    'matplotlib': {'analysis', 'view'},
    'mujoco': {'robot'},
    'click': {'cli', 'view'},
    'rich': {'cli', 'view'},
}


def complaint(source: Source, imported: str) -> str | None:
    """Why this source must not import that, or None if it may."""
    own_parts = source.module.split('.')[1:]
    own = own_parts[0] if own_parts else None
    top, *below = imported.split('.')
    if top != PACKAGE:
        if top == 'numba' and 'kernels' not in own_parts:
            return 'numba belongs in modules or packages named kernels'
        if ROS.fullmatch(top) and own != 'ros':
            return f'{top} belongs in ros/'
        if top in CONFINED and own not in CONFINED[top]:
            return f'{top} belongs in {" and ".join(sorted(CONFINED[top]))}'
        return None
    if own is None:
        return 'the package itself imports nothing of its own, so that importing it is instant'
    if own not in LEVEL:
        return f'{own} has no place in LAYERS yet'
    theirs = below[0] if below else None
    # What is no part of the package is a name in its __init__, like the version.
    if theirs not in LEVEL or theirs == own or LEVEL[theirs] < LEVEL[own]:
        return None
    return f'{own} must not know {theirs}'


def complaints(source: Source) -> list[str]:
    """All forbidden imports of a source, each with its line and the reason."""
    found = []
    for name, line in imports(source):
        reason = complaint(source, name)
        if reason:
            found.append(f'{source.module}, line {line}: imports {name}: {reason}')
    return found


@pytest.mark.parametrize('source', package_sources(), ids=lambda source: source.module)
def test_imports_point_to_the_ground(source: Source) -> None:
    assert complaints(source) == []


@pytest.mark.parametrize(
    ('module', 'text', 'reason'),
    [
        ('board.rules', 'import blocks_planning.search', 'board must not know search'),
        ('board.rules', 'import blocks_planning.search.bfs as b', 'board must not know search'),
        ('board.rules', 'from blocks_planning import search', 'board must not know search'),
        ('board.rules', 'from blocks_planning import errors, ros', 'board must not know ros'),
        ('board.rules', 'from blocks_planning.trials import *', 'board must not know trials'),
        ('board.rules', 'from .. import search', 'board must not know search'),
        ('board.rules', 'from ..search.bfs import x', 'board must not know search'),
        ('errors', 'from . import board', 'errors must not know board'),
        ('errors', 'from .board import task', 'errors must not know board'),
        ('search.bfs', 'def f():\n    from ..subgoals import none', 'search must not know'),
        ('search.bfs', 'if TYPE_CHECKING:\n    from ..view import web', 'search must not know'),
        (
            'search.bfs',
            'try:\n    import rclpy\nexcept ImportError: pass',
            'rclpy belongs in ros/',
        ),
        ('search.bfs', "importlib.import_module('blocks_planning.ros')", 'search must not know'),
        ('view.web', 'from ..analysis import tables', 'view must not know analysis'),
        ('analysis.tables', 'from ..experiments import store', 'analysis must not know'),
        ('experiments.store', 'import blocks_planning.view', 'experiments must not know view'),
        ('trials.local', 'from blocks_planning_msgs.msg import Grid', 'belongs in ros/'),
        ('cli', 'from std_srvs.srv import Trigger', 'std_srvs belongs in ros/'),
        ('trials.local', 'import matplotlib.pyplot as plt', 'matplotlib belongs in analysis and'),
        ('search.solve', 'from numba import njit', 'numba belongs in'),
        ('view.picture', 'import mujoco', 'mujoco belongs in robot'),
        ('robot.film', 'from ..view import picture', 'robot must not know view'),
        ('trials.local', 'import rich', 'rich belongs in cli and view'),
        ('trials.local', 'from click import echo', 'click belongs in cli and view'),
        ('helpers', 'from . import errors', 'helpers has no place in LAYERS yet'),
    ],
)
def test_forbidden_import_is_reported(module: str, text: str, reason: str) -> None:
    [found] = complaints(Source(f'{PACKAGE}.{module}', text))
    assert reason in found


@pytest.mark.parametrize(
    ('module', 'text'),
    [
        ('board.rules', 'from . import geometry\nfrom .geometry import Board'),
        ('board.rules', 'from ..errors import InvalidInput'),
        ('board.rules', 'from blocks_planning import __version__'),
        ('board.kernels', 'import numba'),
        ('search.kernels.breadth_first', 'from numba import njit'),
        ('search.kernels.breadth_first', 'from ...board.kernels import masks'),
        ('view.web', 'import matplotlib\nfrom rich import print'),
        (
            'ros.world',
            'import rclpy.node\nfrom std_msgs.msg import Header\nfrom ..view import web',
        ),
        ('cli', 'import click\nfrom . import analysis, experiments, ros, view'),
        ('board.rules', 'import searching.kernels\nfrom search import ros'),
    ],
)
def test_allowed_import_is_not_reported(module: str, text: str) -> None:
    assert complaints(Source(f'{PACKAGE}.{module}', text)) == []


def test_imports_of_a_package_are_relative_to_itself() -> None:
    package = Source(f'{PACKAGE}.board', 'from .task import Task\nfrom ..search import bfs', True)
    assert [name for name, _ in imports(package)] == [
        f'{PACKAGE}.board.task.Task',
        f'{PACKAGE}.search.bfs',
    ]
    assert len(complaints(package)) == 1


def test_package_itself_imports_nothing_of_its_own() -> None:
    assert complaints(Source(PACKAGE, 'from . import errors', True))


def test_import_from_above_the_package_is_an_error() -> None:
    with pytest.raises(ValueError, match='line 2: import from above'):
        list(imports(Source(f'{PACKAGE}.errors', '\nfrom ..elsewhere import x')))
