"""The launch file starts what is installed, with parameters that exist.

``launch`` is part of a ROS installation and not of this environment, so what the file says is
taken down by stand-ins.
"""

from __future__ import annotations

import runpy
import sys
from types import ModuleType
from typing import Any

import pytest
import yaml
from source_imports import ROOT

from blocks_planning.ros.wire.graph import GRAPH, WATCHER


class Said:
    """Anything of ``launch``: keeps what it was made of."""

    def __init__(self, *values: Any, **options: Any) -> None:
        self.values, self.options = values, options


@pytest.fixture
def launch_file(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    names = {
        'launch': ['LaunchDescription'],
        'launch.actions': ['DeclareLaunchArgument', 'EmitEvent', 'RegisterEventHandler'],
        'launch.conditions': ['IfCondition'],
        'launch.event_handlers': ['OnProcessExit'],
        'launch.events': ['Shutdown'],
        'launch.substitutions': ['LaunchConfiguration', 'PythonExpression'],
        'launch_ros': [],
        'launch_ros.actions': ['Node'],
        'launch_ros.parameter_descriptions': ['ParameterValue'],
    }
    for name, members in names.items():
        module = ModuleType(name)
        for member in members:
            setattr(module, member, type(member, (Said,), {}))
        monkeypatch.setitem(sys.modules, name, module)
    return runpy.run_path(str(ROOT / 'launch' / 'trial.launch.py'))


def actions(launch_file: dict[str, Any], kind: str) -> list[Said]:
    """What the description has of a kind."""
    (found,) = launch_file['generate_launch_description']().values
    return [action for action in found if type(action).__name__ == kind]


def test_every_node_is_started_under_its_name(launch_file: dict[str, Any]) -> None:
    nodes = actions(launch_file, 'Node')
    assert {node.options['executable'] for node in nodes} == set(GRAPH) - {WATCHER.name}
    assert all(node.options['name'] == node.options['executable'] for node in nodes)
    assert len({id(node) for node in nodes}) == len(nodes) == len(GRAPH) - 1


def test_parameters_exist(launch_file: dict[str, Any]) -> None:
    known = yaml.safe_load((ROOT / 'config' / 'nodes.yaml').read_text(encoding='utf-8'))
    for node in actions(launch_file, 'Node'):
        declared = known[f'/**/{node.options["executable"]}']['ros__parameters']
        for given in node.options.get('parameters', []):
            assert set(given) <= set(declared)


def test_arguments_are_described_and_used(launch_file: dict[str, Any]) -> None:
    text = (ROOT / 'launch' / 'trial.launch.py').read_text(encoding='utf-8')
    declared = actions(launch_file, 'DeclareLaunchArgument')
    assert [one.values[0] for one in declared] == list(launch_file['ARGUMENTS'])
    for one in declared:
        assert one.options['description']
        assert f"Configuration('{one.values[0]}')" in text or f"text('{one.values[0]}')" in text
