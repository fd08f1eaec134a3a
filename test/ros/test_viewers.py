"""The files for RViz and Foxglove name what there is. Neither program runs here."""

from __future__ import annotations

import importlib
import json
import re
from collections.abc import Iterator
from math import atan, cos, degrees, pi, radians, sin
from typing import Any

import pytest
import yaml
from builders import spec
from source_imports import ROOT

from blocks_planning.ros.nodes.marker_publisher import CELL_SIZE
from blocks_planning.ros.runtime.part_node import FRAME_ID
from blocks_planning.ros.wire.topics import MARKERS, TOPICS
from blocks_planning.trials.local import run_trial
from blocks_planning.view.scene import scene_of, scenes_of
from blocks_planning.view.solids import LINE_SPACING, Words, solids_of

RVIZ = yaml.safe_load((ROOT / 'config' / 'blocks_planning.rviz').read_text(encoding='utf-8'))
MANAGER = RVIZ['Visualization Manager']
FOXGLOVE = json.loads((ROOT / 'config' / 'foxglove_layout.json').read_text(encoding='utf-8'))
PANELS: dict[str, dict[str, Any]] = FOXGLOVE['configById']
TYPES = {f'/{topic.name}': topic.ros_type for topic in (*TOPICS, MARKERS)}
FIELD_OF_VIEW_DEG = 45.0
"""Upright, of the cameras of both."""


def layers() -> set[str]:
    """Everything that solids can stand for."""
    scenes = scenes_of(run_trial(spec()))
    return {solid.layer for scene in scenes for solid in solids_of(scene)}


def height_m(side: int) -> float:
    """From the ground to the top of the words above a board of so many rows [m]."""
    scene = scene_of(spec('/'.join(['#' * side] * side)))
    words = [solid for solid in solids_of(scene) if isinstance(solid, Words)]
    top = max(line.centre[2] + LINE_SPACING * line.height / 2 for line in words)
    return float(CELL_SIZE.default * top)


def assert_sees(eye: list[float], target: list[float], side: int) -> None:
    """See that a camera in front of a board of so many cells a side has it whole in its view."""
    width, height = CELL_SIZE.default * side, height_m(side)
    assert eye[1] < 0, 'columns would go to the left'
    assert target == pytest.approx([width / 2, CELL_SIZE.default / 2, height / 2], abs=0.03)
    half = degrees(atan(height / 2 / (target[1] - eye[1])))
    assert half < FIELD_OF_VIEW_DEG / 2 < 2.5 * half


# RViz


def test_rviz_shows_the_markers_as_they_are_said() -> None:
    [display] = MANAGER['Displays']
    assert display['Class'] == 'rviz_default_plugins/MarkerArray'
    assert display['Enabled'] is True
    profile = MARKERS.publisher_qos
    assert display['Topic'] == {
        'Value': f'/{MARKERS.name}',
        'Depth': profile.depth,
        'History Policy': profile.history.short_key.replace('_', ' ').title(),
        'Reliability Policy': profile.reliability.short_key.title(),
        'Durability Policy': profile.durability.short_key.replace('_', ' ').title(),
    }
    assert display['Namespaces'] == dict.fromkeys(layers(), True)


def test_rviz_needs_no_transform() -> None:
    assert MANAGER['Global Options']['Fixed Frame'] == FRAME_ID.default
    views = [MANAGER['Views']['Current'], *MANAGER['Views']['Saved']]
    assert {view['Target Frame'] for view in views} == {'<Fixed Frame>'}


@pytest.mark.parametrize(('index', 'side'), [(0, 8), (1, 16)])
def test_rviz_looks_at_the_board_from_the_front(index: int, side: int) -> None:
    view = [MANAGER['Views']['Current'], *MANAGER['Views']['Saved']][index]
    assert view['Class'] == 'rviz_default_plugins/Orbit'
    target = [view['Focal Point'][axis] for axis in 'XYZ']
    yaw, pitch, distance = view['Yaw'], view['Pitch'], view['Distance']
    assert yaw == pytest.approx(3 * pi / 2)
    direction = (cos(yaw) * cos(pitch), sin(yaw) * cos(pitch), sin(pitch))
    eye = [t + distance * d for t, d in zip(target, direction, strict=True)]
    assert_sees(eye, target, side)


# Foxglove


def test_foxglove_has_the_parts_that_an_import_asks_for() -> None:
    for key in ('configById', 'globalVariables', 'userNodes', 'layout'):
        assert isinstance(FOXGLOVE[key], dict)
    assert isinstance(FOXGLOVE['playbackConfig']['speed'], (int, float))


def test_foxglove_layout_shows_every_panel_once() -> None:
    assert sorted(leaves(FOXGLOVE['layout'])) == sorted(PANELS)
    kinds = {name.partition('!')[0] for name in PANELS}
    assert kinds == {'3D', 'Plot', 'Table', 'RawMessages', 'DiagnosticSummary'}


def leaves(node: Any) -> Iterator[str]:
    """The panels in a part of the layout: a panel, or two parts beside each other."""
    if isinstance(node, str):
        yield node
        return
    assert node['direction'] in ('row', 'column')
    assert 0 < node['splitPercentage'] < 100
    yield from leaves(node['first'])
    yield from leaves(node['second'])


def test_foxglove_shows_the_markers_from_the_front() -> None:
    [panel] = (panel for name, panel in PANELS.items() if name.startswith('3D!'))
    assert panel['followTf'] == FRAME_ID.default
    assert {name for name, one in panel['topics'].items() if one['visible']} == {'/markers'}
    camera = panel['cameraState']
    assert camera['fovy'] == FIELD_OF_VIEW_DEG
    assert camera['perspective'] is True  # without it one looks from above
    down, around = radians(camera['phi']), radians(camera['thetaOffset'])
    direction = (sin(down) * -sin(around), -sin(down) * cos(around), cos(down))
    eye = [
        t + camera['distance'] * d for t, d in zip(camera['targetOffset'], direction, strict=True)
    ]
    assert_sees(eye, camera['targetOffset'], 8)
    assert camera['near'] < camera['distance'] / 2 < camera['far']


def paths() -> list[str]:
    """The message paths of all panels but that of /diagnostics."""
    plotted = [series['value'] for panel in PANELS.values() for series in panel.get('paths', ())]
    return plotted + [panel['topicPath'] for panel in PANELS.values() if 'topicPath' in panel]


@pytest.mark.parametrize('path', paths())
def test_foxglove_shows_fields_that_messages_have(path: str) -> None:
    topic, *fields = path.split('.')
    kind = TYPES[topic]
    for field in fields:
        name, index = re.fullmatch(r'(\w+)(\[-?\d+\])?', field).groups()  # type: ignore[union-attr]
        ros_type = kind.get_fields_and_field_types()[name]
        element = re.fullmatch(r'sequence<(.+)>', ros_type)
        assert element or not index, f'{name} is no list'
        kind = message_class(element[1] if element else ros_type)


def message_class(ros_type: str) -> Any:
    """The class of a message type, such as 'std_msgs/Header'; None for a plain type."""
    package, _, name = ros_type.partition('/')
    return getattr(importlib.import_module(f'{package}.msg'), name) if name else None


def test_foxglove_shows_the_health_of_nodes_where_ros_says_it() -> None:
    [panel] = (panel for panel in PANELS.values() if 'topicToRender' in panel)
    assert panel['topicToRender'] == '/diagnostics'
