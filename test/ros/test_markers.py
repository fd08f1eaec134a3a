"""Markers, as a viewer keeps them, and the node that says them."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest
from builders import CHAIR, SQUARE, ended, spec
from peers import Bench, Graph
from rclpy.node import Node
from rclpy.parameter import Parameter
from visualization_msgs.msg import Marker, MarkerArray

from blocks_planning.ros.nodes.marker_publisher import MarkerPublisher
from blocks_planning.ros.wire.graph import MARKER_PUBLISHER
from blocks_planning.ros.wire.topics import MARKERS, OUTCOME
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import (
    Message,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view import palette
from blocks_planning.view.scene import Scene, last_scene, scene_after, scene_of
from blocks_planning.view.solids import GAP, REGION_OPACITY

CELL_M = 0.1
TRIAL_SPEC = spec(CHAIR, lam=0.2, depth=2)
OTHER = spec(SQUARE, lam=0.2, depth=2)


class Viewer(Node):
    """Shows what markers say, as RViz does.

    Attributes:
        arrays: everything that was heard.
        shown: the markers that are to be seen, by namespace and id.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__('viewer', **options)
        self.arrays: list[MarkerArray] = []
        self.shown: dict[tuple[str, int], Marker] = {}
        self.create_subscription(MARKERS.ros_type, MARKERS.name, self._show, MARKERS.publisher_qos)

    def _show(self, array: MarkerArray) -> None:
        self.arrays.append(array)
        for marker in array.markers:
            if marker.action == Marker.DELETEALL:
                self.shown.clear()
            else:
                assert marker.action == Marker.ADD
                self.shown[marker.ns, marker.id] = marker

    def layer(self, name: str) -> list[Marker]:
        """The markers of a namespace, by their numbers."""
        return [self.shown[key] for key in sorted(self.shown) if key[0] == name]


def heard_of(trial: TrialSpec) -> tuple[TrialRecord, list[Message]]:
    """The record of a trial, and what is said of it to who only looks."""
    heard: list[Message] = []
    record = run_trial(trial, observe=heard.append)
    kinds = (TrialStarted, WorldState, SubgoalChosen)
    return record, [message for message in heard if isinstance(message, kinds)]


RECORD, HEARD = heard_of(TRIAL_SPEC)


def add_bench(graph: Graph, **parameters: Any) -> Bench:
    """The node with somebody who tells it of trials; it shows a change within 20 ms."""
    values = {'publish_period_s': 0.02, 'cell_size': CELL_M, **parameters}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    node = graph.add(MarkerPublisher, parameter_overrides=overrides)
    return Bench(graph, MARKER_PUBLISHER, node, TRIAL_SPEC)


def words(viewer: Viewer) -> str:
    """What is written above the board."""
    return '\n'.join(marker.text for marker in viewer.layer('text'))


def xyz(vector: Any) -> tuple[float, float, float]:
    """The parts of a point or vector."""
    return vector.x, vector.y, vector.z


def colour(marker: Marker) -> str:
    """The colour of a marker, as '#rrggbb'."""
    levels = (marker.color.r, marker.color.g, marker.color.b)
    return '#' + ''.join(f'{round(255 * level):02x}' for level in levels)


def finish(on: Bench) -> None:
    """Say how the trial ended."""
    on.peer.outlets[OUTCOME].publish(OUTCOME.to_ros(None, ended(TRIAL_SPEC.trial_id, RECORD)))


def test_every_block_is_where_it_stands_in_the_colour_of_its_subgoal(graph: Graph) -> None:
    on = add_bench(graph)
    viewer = graph.add(Viewer)
    on.tell(*HEARD)
    finish(on)
    graph.spin_until(lambda: 'success' in words(viewer))
    blocks = viewer.layer('blocks')
    scene = last_scene(RECORD)
    assert [marker.type for marker in blocks] == [Marker.CUBE] * len(RECORD.placements)
    for marker, placed in zip(blocks, RECORD.placements, strict=True):
        assert xyz(marker.pose.position) == pytest.approx(
            (
                CELL_M * (placed.column + placed.width / 2),
                CELL_M / 2,
                CELL_M * (placed.row + placed.height / 2),
            )
        )
        assert xyz(marker.scale) == pytest.approx(
            [CELL_M * (side - 2 * GAP) for side in (placed.width, 1, placed.height)]
        )
        assert marker.pose.orientation.w == 1
        assert marker.color.a == 1
    assert [colour(marker) for marker in blocks] == palette.fills_of(scene.blocks)
    assert {marker.header.frame_id for marker in viewer.shown.values()} == {'board'}
    assert viewer.layer('region') == []


def test_region_lines_and_words_are_in_metres(graph: Graph) -> None:
    on = add_bench(graph, frame_id='table')
    viewer = graph.add(Viewer)
    until = next(i for i, m in enumerate(HEARD) if isinstance(m, SubgoalChosen))
    on.tell(*HEARD[: until + 1])
    graph.spin_until(lambda: viewer.layer('region'))
    [region] = viewer.layer('region')
    scene: Scene = on.node.scene  # type: ignore[attr-defined]
    cells = list(TRIAL_SPEC.task.board.cells(scene.region))
    assert region.type == Marker.CUBE_LIST
    assert [xyz(point) for point in region.points] == [
        pytest.approx((CELL_M * (x + 0.5), CELL_M / 2, CELL_M * (z + 0.5))) for x, z in cells
    ]
    assert xyz(region.scale) == pytest.approx([CELL_M * (1 - 2 * GAP)] * 3)
    assert colour(region) == palette.COLOURS[0]
    assert region.color.a == pytest.approx(REGION_OPACITY)
    [lines] = viewer.layer('silhouette')
    assert lines.type == Marker.LINE_LIST
    assert max(point.x for point in lines.points) == pytest.approx(CELL_M * 4)
    assert max(point.z for point in lines.points) == pytest.approx(CELL_M * 6)
    assert lines.scale.x == pytest.approx(CELL_M * 0.08)
    for text in viewer.layer('text'):
        assert text.type == Marker.TEXT_VIEW_FACING
        assert text.scale.z == pytest.approx(CELL_M * 0.25)
        assert 0 < text.scale.x < text.scale.z, 'the width of a space'
        assert text.pose.position.z > CELL_M * 6
    [ground] = viewer.layer('ground')
    assert ground.type == Marker.CUBE
    assert xyz(ground.scale) == pytest.approx((CELL_M * 4, CELL_M, CELL_M * 0.1))
    assert {marker.header.frame_id for marker in viewer.shown.values()} == {'table'}


def test_who_comes_late_sees_the_same_as_who_was_there(graph: Graph) -> None:
    on = add_bench(graph)
    viewer = graph.add(Viewer)
    on.tell(*HEARD)
    finish(on)
    graph.spin_until(lambda: 'success' in words(viewer))
    late = graph.add(Viewer)
    graph.spin_until(lambda: late.arrays)
    assert len(late.arrays) == 1
    assert late.shown == viewer.shown


def test_nothing_of_the_last_trial_is_left_when_the_next_begins(graph: Graph) -> None:
    on = add_bench(graph)
    viewer = graph.add(Viewer)
    on.tell(*HEARD)
    graph.spin_until(lambda: len(viewer.layer('blocks')) == len(RECORD.placements))
    on.tell(TrialStarted(OTHER.trial_id, replace(OTHER, stimulus='next')))
    graph.spin_until(lambda: 'next: building' in words(viewer))
    assert {key[0] for key in viewer.shown} == {'ground', 'frame', 'silhouette', 'text'}
    assert all(array.markers[0].action == Marker.DELETEALL for array in viewer.arrays)


def test_scenes_that_come_too_fast_are_left_out_and_the_last_is_shown(graph: Graph) -> None:
    on = add_bench(graph, publish_period_s=60.0)
    viewer = graph.add(Viewer)
    graph.spin_until(lambda: viewer.count_publishers(MARKERS.name) == 1)
    on.tell(*HEARD)
    assert isinstance(on.node, MarkerPublisher)
    on.node.finish()
    on.node.finish()  # there is nothing new
    graph.spin_until(lambda: viewer.arrays)
    late = graph.add(Viewer)
    graph.spin_until(lambda: late.arrays)
    assert len(viewer.arrays) == 1
    assert len(viewer.layer('blocks')) == len(RECORD.placements)


def test_largest_board_arrives_whole(graph: Graph) -> None:
    full = spec('/'.join(['#' * 16] * 16), library='1x1', strategy='none', search='random')
    record, heard = heard_of(full)
    on = add_bench(graph)
    viewer = graph.add(Viewer)
    on.tell(heard[0])
    on.node.take(heard[-1])
    graph.spin_until(lambda: len(viewer.layer('blocks')) == len(record.placements) == 256)


def test_scene_is_that_of_the_messages(graph: Graph) -> None:
    on = add_bench(graph)
    scene = scene_of(TRIAL_SPEC)
    on.tell(HEARD[0])
    for message in HEARD[1:]:
        scene = scene_after(scene, message)
        on.tell(message)
        assert on.node.memory == scene
    finish(on)
    graph.spin_until(lambda: on.node.memory.status is RECORD.status)
    assert on.node.memory == scene_after(scene, TrialEnded(TRIAL_SPEC.trial_id, RECORD.status))
