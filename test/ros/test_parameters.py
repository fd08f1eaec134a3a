"""Parameters of nodes, and what is written about them."""

from __future__ import annotations

import importlib
import re
import subprocess
import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml
from graphs import NODES
from part_nodes import PART_IDS, PARTS
from peers import Graph
from rclpy.node import Node
from rclpy.parameter import Parameter
from source_imports import ROOT

from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.nodes.marker_publisher import MarkerPublisher
from blocks_planning.ros.nodes.robot_arm import RobotArm
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.nodes.trial_view import TrialView
from blocks_planning.ros.wire.graph import GRAPH
from blocks_planning.ros.wire.topics import TOPICS

EVERY_NODE = [name for name in GRAPH if name != 'watcher']
each_node = pytest.mark.parametrize('name', EVERY_NODE)


@pytest.fixture
def make(monkeypatch: pytest.MonkeyPatch, tmp_path: Path, graph: Graph) -> Callable[..., Any]:
    """Makes a node by its name, in an empty working directory."""
    monkeypatch.chdir(tmp_path)
    makers: dict[str, Callable[..., Any]] = {
        **dict(zip(PART_IDS, (make_node for _, make_node in PARTS), strict=True)),
        'trial_orchestrator': lambda **options: TrialOrchestrator(threading.Event(), **options),
        'bag_recorder': BagRecorder,
        'marker_publisher': MarkerPublisher,
        'trial_view': TrialView,
        'robot_arm': RobotArm,
    }

    def call(name: str, **parameters: Any) -> Any:
        overrides = [Parameter(key, value=value) for key, value in parameters.items()]
        return graph.add(makers[name], parameter_overrides=overrides)

    return call


def own_parameters(node: Node) -> dict[str, Any]:
    """The parameters of a node that are not those of every node."""
    names = node.list_parameters([], 0).names
    own = [n for n in names if not n.startswith(('use_sim_time', 'start_type', 'qos_overrides'))]
    return {name: node.get_parameter(name).value for name in own}


@each_node
def test_configuration_lists_what_is_declared(name: str, make: Callable[..., Any]) -> None:
    """No parameter less, none more, each with its default."""
    path = ROOT / 'config' / 'nodes.yaml'
    listed = yaml.safe_load(path.read_text(encoding='utf-8'))[f'/**/{name}']['ros__parameters']
    declared = own_parameters(make(name))
    assert listed == declared
    assert {key: type(value) for key, value in listed.items()} == {
        key: type(value) for key, value in declared.items()
    }


def test_configuration_lists_every_node() -> None:
    path = ROOT / 'config' / 'nodes.yaml'
    listed = yaml.safe_load(path.read_text(encoding='utf-8'))
    assert list(listed) == [f'/**/{name}' for name in EVERY_NODE]


@each_node
def test_parameters_are_described_and_can_not_be_changed(
    name: str, make: Callable[..., Any]
) -> None:
    node = make(name)
    for parameter in own_parameters(node):
        descriptor = node.describe_parameter(parameter)
        assert descriptor.description.endswith(('.', ']'))
        assert descriptor.read_only
        is_number = type(node.get_parameter(parameter).value) in (int, float)
        ranges = [*descriptor.integer_range, *descriptor.floating_point_range]
        assert len(ranges) == int(is_number)
        result = node.set_parameters([Parameter(parameter, value=7)])[0]
        assert not result.successful


@each_node
def test_unknown_parameters_are_refused(name: str, make: Callable[..., Any]) -> None:
    with pytest.raises(ConfigurationError, match=rf"{name} has no parameter 'spped'"):
        make(name, spped=1)


@each_node
def test_parameters_of_a_wrong_type_or_value_are_refused(
    name: str, make: Callable[..., Any]
) -> None:
    for parameter, default in own_parameters(make(name)).items():
        wrong: list[Any] = [[1, 2], 12 if not isinstance(default, int) else 1.5]
        wrong.append('much' if isinstance(default, bool) else True)
        if isinstance(default, (int, float)) and not isinstance(default, bool):
            wrong += ['much', type(default)(-1), type(default)(2**62)]
        for value in wrong:
            with pytest.raises(ConfigurationError) as refused:
                make(name, **{parameter: value})
            assert f'parameter {parameter} ' in str(refused.value)
            shown = re.escape(str(value).strip('[]'))
            assert re.search(rf'got .*{shown}', str(refused.value))


@pytest.mark.parametrize(
    ('name', 'parameter', 'said'),
    [
        ('world', 'remind_period_s:=0.0', 'parameter remind_period_s must be'),
        ('trial_view', 'host:=nowhere.invalid', 'cannot be served at nowhere.invalid:0: '),
        *(
            pytest.param(*case, marks=pytest.mark.long)
            for case in (
                ('subgoal_selector', 'colour:=red', "has no parameter 'colour'"),
                ('action_searcher', 'workers:=many', 'parameter workers must be'),
                ('trial_orchestrator', 'script:=nowhere.yaml', 'nowhere.yaml: cannot be read'),
                ('bag_recorder', 'flush_period_s:=1e9', 'parameter flush_period_s must be'),
                ('marker_publisher', 'cell_size:=0.0', 'parameter cell_size must be'),
                ('marker_publisher', "frame_id:=''", 'parameter frame_id must be a name'),
                ('trial_view', 'token:=short', 'token must be 16 or more letters'),
            )
        ),
    ],
)
def test_process_with_bad_parameters_ends_with_one_line(
    name: str, parameter: str, said: str, tmp_path: Path
) -> None:
    done = subprocess.run(
        [sys.executable, '-m', NODES, name, '--ros-args', '-p', parameter],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert done.returncode == 2
    assert done.stdout == ''
    assert re.fullmatch(r'Error: [^\n]*\n', done.stderr)
    assert said in done.stderr


def test_parameters_are_read_from_the_file_that_ships(tmp_path: Path) -> None:
    """With one value changed to nonsense, that one is named."""
    text = (ROOT / 'config' / 'nodes.yaml').read_text(encoding='utf-8')
    path = tmp_path / 'nodes.yaml'
    path.write_text(text.replace('workers: 2', 'workers: 0'), encoding='utf-8')
    done = subprocess.run(
        [
            *(sys.executable, '-m', NODES, 'action_searcher'),
            *('--ros-args', '--params-file', str(path)),
        ],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert (done.returncode, done.stdout) == (2, '')
    assert 'workers' in done.stderr
    assert 'got 0' in done.stderr


@each_node
def test_docstring_names_topics_and_parameters(name: str, make: Callable[..., Any]) -> None:
    module = importlib.import_module(f'blocks_planning.ros.nodes.{name}')
    assert module.__doc__ is not None
    rows = dict(re.findall(r'^\| (\w+) \| (.*) \|$', module.__doc__, re.MULTILINE))
    topics = GRAPH[name]
    if rows['subscribes'] == 'every topic':
        assert set(topics.listens) == set(TOPICS)
    else:
        assert named(rows['subscribes']) == {topic.name: topic.latched for topic in topics.listens}
    assert named(rows.get('publishes', '')) == {
        **{topic.name: topic.latched for topic in topics.says},
        **{topic.name: True for topic in topics.views},
    }
    parameters = re.findall(r'(?:^|; )`(\w+)`', rows['parameters'])
    assert parameters == list(own_parameters(make(name)))
    assert ('action' in rows) == (name in ('trial_orchestrator', 'action_searcher'))
    assert ('services' in rows) == (name == 'trial_orchestrator')


def named(row: str) -> dict[str, bool]:
    """The topics of a row of a table, and whether it says that they are latched."""
    found: dict[str, bool] = {}
    for names, qos in re.findall(r'((?:`[\w/]+`(?:, )?)+) \((latched|stream)\)', row):
        found |= dict.fromkeys(re.findall(r'`([\w/]+)`', names), qos == 'latched')
    return found
