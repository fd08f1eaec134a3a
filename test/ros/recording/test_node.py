"""The recorder as a node among others."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import pytest
from bag_builders import Said, contents
from builders import SQUARE, spec
from peers import Graph
from recorders import Peer, add_recorder, expected, recorded
from rosbags.highlevel import AnyReader
from std_msgs.msg import Header

from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.wire.conversions.markers import markers_to_ros
from blocks_planning.ros.wire.topics import MARKERS, TOPICS, Topic
from blocks_planning.view.scene import scene_of
from blocks_planning.view.solids import solids_of


def test_everything_said_is_in_the_bag(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    node = add_recorder(graph, tmp_path / 'bag')
    peer.wait_for_listeners()
    before_ns = time.time_ns()
    for number, one in enumerate(said, start=1):
        peer.outlets[one.topic].publish(one.data)
        graph.spin_until(lambda: node.count == number)  # noqa: B023  called at once
    hashes = {
        topic.name: str(
            peer.node.get_publishers_info_by_topic(peer.outlets[topic].topic_name)[
                0
            ].topic_type_hash
        )
        for topic in TOPICS
    }
    node.finish()
    assert recorded(tmp_path / 'bag') == expected(graph, said)
    times = [time_ns for _, time_ns, _ in contents(tmp_path / 'bag')]
    assert times == sorted(times)
    assert before_ns <= times[0] <= times[-1] <= time.time_ns()
    with AnyReader([tmp_path / 'bag']) as reader:
        found = {
            entry.topic.removeprefix(f'{graph.namespace}/'): entry
            for entry in reader.connections
            if not entry.topic.endswith(f'/{MARKERS.name}')
        }
    assert {name: entry.digest for name, entry in found.items()} == hashes
    assert [one.record.status.value for one in trials_of(tmp_path / 'bag')] == ['success'] * 2


def test_who_comes_late_records_what_is_latched(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    for one in said:
        peer.outlets[one.topic].publish(one.data)
    node = add_recorder(graph, tmp_path / 'bag')
    latched: dict[Topic, bytes] = {one.topic: one.data for one in said if one.topic.latched}
    graph.spin_until(lambda: node.count == len(latched))
    node.finish()
    assert recorded(tmp_path / 'bag') == expected(
        graph, [one for one in said if latched.get(one.topic) == one.data]
    )
    [trial] = trials_of(tmp_path / 'bag')
    assert list(trial.contradictions()) == []


def test_burst_is_recorded_whole(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    node = add_recorder(graph, tmp_path / 'bag')
    peer.wait_for_listeners()
    [stream, *_] = [one for one in said if not one.topic.latched]
    for _ in range(900):
        peer.outlets[stream.topic].publish(stream.data)
    graph.spin_until(lambda: node.count == 900)
    node.finish()
    assert len(contents(tmp_path / 'bag')) == 900


def test_markers_are_recorded_and_no_part_of_a_trial(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    outlet = peer.node.create_publisher(MARKERS.ros_type, MARKERS.name, MARKERS.publisher_qos)
    node = add_recorder(graph, tmp_path / 'bag')
    peer.wait_for_listeners()
    graph.spin_until(lambda: outlet.get_subscription_count() == 1)
    solids = solids_of(scene_of(spec(SQUARE)))
    array = markers_to_ros(solids, Header(frame_id='board'), cell_m=0.05)
    for number, one in enumerate(said, start=1):
        peer.outlets[one.topic].publish(one.data)
        outlet.publish(array)
        graph.spin_until(lambda: node.count == 2 * number)  # noqa: B023  called at once
    node.finish()
    trials = list(trials_of(tmp_path / 'bag'))
    assert [list(trial.contradictions()) for trial in trials] == [[], []]
    read: list[Any] = []
    with AnyReader([tmp_path / 'bag']) as reader:
        [connection] = [one for one in reader.connections if one.topic.endswith('/markers')]
        for _, _, data in reader.messages([connection]):
            read.append(reader.deserialize(data, connection.msgtype))
    assert len(read) == len(said)
    assert [(one.ns, one.id, one.type, one.text) for one in read[-1].markers] == [
        (one.ns, one.id, one.type, one.text) for one in array.markers
    ]


def test_parameters_out_of_their_range_are_refused(graph: Graph, tmp_path: Path) -> None:
    with pytest.raises(ConfigurationError, match=r'parameter flush_period_s must be a float'):
        add_recorder(graph, tmp_path / 'bag', flush_period_s=0.0)
    assert not (tmp_path / 'bag').exists()


def test_bag_of_another_recorder_is_refused(graph: Graph, tmp_path: Path) -> None:
    node = add_recorder(graph, tmp_path / 'bag')
    with pytest.raises(BagError, match='another process is recording it'):
        add_recorder(graph, tmp_path / 'bag')
    node.finish()
    with pytest.raises(BagError, match='contains a finished bag'):
        add_recorder(graph, tmp_path / 'bag')
