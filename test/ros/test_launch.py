"""The launch file starts what is installed, with parameters that exist.

``launch`` is part of a ROS installation and not of this environment, so what the file says is
taken down by stand-ins.
"""

from __future__ import annotations

import runpy
import sys
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
import yaml
from source_imports import ROOT

from blocks_planning.ros.wire.graph import GRAPH, WATCHER


class Said:
    """Anything of ``launch``: keeps what it was made of."""

    def __init__(self, *values: Any, **options: Any) -> None:
        self.values, self.options = values, options

    def perform(self, context: dict[str, str]) -> str:
        """The value of a LaunchConfiguration; the context is the arguments."""
        return context[self.values[0]]


@pytest.fixture
def launch_file(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    names = {
        'launch': ['LaunchDescription'],
        'launch.actions': [
            'DeclareLaunchArgument',
            'EmitEvent',
            'OpaqueFunction',
            'RegisterEventHandler',
        ],
        'launch.event_handlers': ['OnProcessExit'],
        'launch.events': ['Shutdown'],
        'launch.substitutions': ['LaunchConfiguration'],
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


def described(launch_file: dict[str, Any]) -> list[Said]:
    """What the description has."""
    (found,) = launch_file['generate_launch_description']().values
    return list(found)


def started(launch_file: dict[str, Any], **arguments: str) -> dict[str, dict[str, Any]]:
    """The nodes that are started, with their parameters."""
    defaults = {name: default for name, (default, _) in launch_file['ARGUMENTS'].items()}
    (opaque,) = [one for one in described(launch_file) if type(one).__name__ == 'OpaqueFunction']
    actions = opaque.options['function']({**defaults, **arguments})
    nodes = [action for action in actions if type(action).__name__ == 'Node']
    assert all(node.options['name'] == node.options['executable'] for node in nodes)
    return {node.options['name']: _plain(node.options['parameters'][0]) for node in nodes}


def _plain(parameters: dict[str, Any]) -> dict[str, Any]:
    for value in parameters.values():
        if isinstance(value, Said):
            assert value.options == {'value_type': str}
    return {k: v.values[0] if isinstance(v, Said) else v for k, v in parameters.items()}


ALL = {'bag_dir': 'bag', 'markers': 'true', 'view': 'true', 'robot': 'true'}


def test_every_node_can_be_started(launch_file: dict[str, Any]) -> None:
    assert set(started(launch_file, **ALL)) == set(GRAPH) - {WATCHER.name}
    assert list(started(launch_file)) == [*launch_file['NODES'], 'trial_orchestrator']


def test_parameters_exist(launch_file: dict[str, Any]) -> None:
    known = yaml.safe_load((ROOT / 'config' / 'nodes.yaml').read_text(encoding='utf-8'))
    for name, given in started(launch_file, **ALL).items():
        declared = known[f'/**/{name}']['ros__parameters']
        assert {key: type(value) for key, value in given.items()} == {
            key: type(declared[key]) for key in given
        }


def test_orchestrator_waits_for_what_is_started(launch_file: dict[str, Any]) -> None:
    nodes = started(launch_file, **ALL)
    assert nodes['trial_orchestrator']['wait_for'] == list(nodes)[:-1]
    assert started(launch_file, peer_timeout_s='7')['trial_orchestrator']['peer_timeout_s'] == 7.0


@pytest.mark.parametrize('text', ['pilot: two', 'run #1', '1e5', "it's", '[a]', 'true', '{x}'])
def test_text_is_text(launch_file: dict[str, Any], text: str) -> None:
    nodes = started(launch_file, out_dir=text, bag_dir=text, participant=text)
    assert nodes['trial_orchestrator']['out_dir'] == text
    assert nodes['trial_orchestrator']['participant'] == text
    assert nodes['bag_recorder']['bag_dir'] == text
    assert nodes['world']['journal_dir'] == f'{text}/journal'


@pytest.mark.parametrize(
    ('name', 'value', 'said'),
    [
        ('markers', 'yes', "markers must be true or false, got 'yes'"),
        ('view', '', "view must be true or false, got ''"),
        ('out_dir', '', "out_dir must be the name of a folder, got ''"),
        (
            'peer_timeout_s',
            'soon',
            "peer_timeout_s must be a number of seconds above 0, got 'soon'",
        ),
        ('peer_timeout_s', 'nan', 'peer_timeout_s must be'),
        ('peer_timeout_s', '-1', 'peer_timeout_s must be'),
    ],
)
def test_bad_arguments_are_refused_before_anything_starts(
    launch_file: dict[str, Any], name: str, value: str, said: str
) -> None:
    with pytest.raises(RuntimeError, match=said):
        started(launch_file, **{name: value})


def test_launch_fails_if_the_orchestrator_failed(launch_file: dict[str, Any]) -> None:
    after = launch_file['after_orchestrator']
    (shutdown,) = after(SimpleNamespace(returncode=0), None)
    assert type(shutdown).__name__ == 'EmitEvent'
    with pytest.raises(RuntimeError, match='trial_orchestrator ended with exit code 2'):
        after(SimpleNamespace(returncode=2), None)


def test_arguments_are_described_and_used(launch_file: dict[str, Any]) -> None:
    text = (ROOT / 'launch' / 'trial.launch.py').read_text(encoding='utf-8')
    declared = [o for o in described(launch_file) if type(o).__name__ == 'DeclareLaunchArgument']
    assert [one.values[0] for one in declared] == list(launch_file['ARGUMENTS'])
    for one in declared:
        assert one.options['description']
        assert text.count(f"'{one.values[0]}'") > 1
