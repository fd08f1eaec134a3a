"""The recorder as a node among others, and as a process that is stopped, killed and started."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from bag_builders import Said, contents, flushed, trial_said
from builders import CHAIR, SQUARE, spec
from peers import Graph
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter
from rosbags.highlevel import AnyReader
from std_msgs.msg import Header

from blocks_planning.errors import ConfigurationError
from blocks_planning.ros.bagging import BagError
from blocks_planning.ros.bagging.bags import trials_of
from blocks_planning.ros.bagging.repair import is_finished, repair
from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.wire.conversions.markers import markers_to_ros
from blocks_planning.ros.wire.topics import MARKERS, TOPICS, TRIAL, Topic
from blocks_planning.view.scene import scene_of
from blocks_planning.view.solids import solids_of

COMMAND = [sys.executable, '-m', 'blocks_planning.ros.nodes.bag_recorder', '--ros-args']
DEADLINE_S = 30.0
STOP_S = 2.0
"""Starting to stop takes no longer than this, also on a busy machine."""


class Peer:
    """Says on every topic what a test wants."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.node: Node = graph.add(lambda **options: Node('peer', **options))
        self.outlets = {
            topic: self.node.create_publisher(topic.ros_type, topic.name, topic.publisher_qos)
            for topic in TOPICS
        }

    def wait_for_listeners(self, listeners: int = 1) -> None:
        self.graph.spin_until(
            lambda: all(p.get_subscription_count() == listeners for p in self.outlets.values())
        )

    def say(self, said: list[Said]) -> None:
        """Publish, and see everything arrive."""
        for one in said:
            self.outlets[one.topic].publish(one.data)
            if one.topic.latched:  # the next one would take its place
                self.outlets[one.topic].wait_for_all_acked(Duration(seconds=DEADLINE_S))
        for outlet in self.outlets.values():
            assert outlet.wait_for_all_acked(Duration(seconds=DEADLINE_S))


@pytest.fixture
def peer(graph: Graph) -> Peer:
    return Peer(graph)


@pytest.fixture(scope='module')
def said() -> list[Said]:
    return [one for tower in (SQUARE, CHAIR) for one in trial_said(spec(tower))[1]]


def add_recorder(graph: Graph, bag: Path, **parameters: Any) -> BagRecorder:
    values = {'bag_dir': str(bag), **parameters}
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return graph.add(BagRecorder, parameter_overrides=overrides)


@contextmanager
def recorder(
    graph: Graph, bag: Path, *arguments: str, command: list[str] | None = None
) -> Iterator[subprocess.Popen[str]]:
    """A recorder in a process of its own, that sees everything on disk 20 times a second."""
    parameters = ['-p', f'bag_dir:={bag}', '-p', 'flush_period_s:=0.05']
    remap = ['-r', f'__ns:={graph.namespace}', '--disable-external-lib-logs']
    process = subprocess.Popen(
        [*(command or COMMAND), *remap, *parameters, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    try:
        yield process
    finally:
        process.kill()
        process.wait()
        for pipe in (process.stdout, process.stderr):
            assert pipe is not None
            pipe.close()


def stop(process: subprocess.Popen[str], number: signal.Signals) -> tuple[int, str]:
    """Exit code and stderr of a process that gets a signal."""
    began = time.monotonic()
    process.send_signal(number)
    _, err = process.communicate(timeout=DEADLINE_S)
    assert time.monotonic() - began < STOP_S
    return process.returncode, err


def by_topic(datas: list[tuple[str, bytes]]) -> dict[str, list[bytes]]:
    """What was said on each topic; topics are not ordered among each other, but each is.

    Between processes, messages are filled up to multiples of four bytes.
    """
    return {
        name: [data + bytes(-len(data) % 4) for one, data in datas if one == name]
        for name, _ in datas
    }


def recorded(bag: Path) -> dict[str, list[bytes]]:
    return by_topic([(topic, data) for topic, _, data in contents(bag)])


def expected(graph: Graph, said: list[Said]) -> dict[str, list[bytes]]:
    return by_topic([(f'{graph.namespace}/{one.topic.name}', one.data) for one in said])


# As a node


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


# As a process


@pytest.mark.parametrize('number', [signal.SIGTERM, signal.SIGINT])
def test_stopped_recorder_finishes_its_bag(
    number: signal.Signals, graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with recorder(graph, bag, '-p', 'split_bytes:=5000') as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        code, printed = stop(process, number)
        assert code == 0
        assert [line for line in printed.splitlines() if not line.startswith('[INFO]')] == []
    assert is_finished(bag)
    assert recorded(bag) == expected(graph, said)
    assert len(list(bag.glob('*.mcap'))) > 1


def test_killed_recorder_loses_what_was_not_flushed_and_goes_on(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    half = len(said) // 2
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        peer.say(said[:half])
        graph.spin_until(lambda: flushed(bag) == half)
        process.kill()
        process.wait()
    assert not is_finished(bag)
    peer.wait_for_listeners(0)
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        latched = {one.topic: one for one in said[:half] if one.topic.latched}
        graph.spin_until(lambda: flushed(bag) == half + len(latched))
        peer.say(said[half:])
        graph.spin_until(lambda: flushed(bag) == len(said) + len(latched))
        code, err = stop(process, signal.SIGTERM)
    assert code == 0
    assert f'bag_0.mcap: was truncated; kept {half} messages' in err
    again = [one for one in said[:half] if latched.get(one.topic) is one]
    assert recorded(bag) == expected(graph, [*said[:half], *again, *said[half:]])
    assert [list(one.contradictions()) for one in trials_of(bag)] == [[], []]


def test_killed_recorder_is_repaired_without_a_graph(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    bag = tmp_path / 'bag'
    with recorder(graph, bag) as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        with pytest.raises(BagError, match='another process is recording it'):
            repair(bag)
        process.kill()
        process.wait()
    [done] = repair(bag)
    assert (done.messages, done.aside_bytes) == (len(said), 0)
    assert recorded(bag) == expected(graph, said)


def test_finished_bag_ends_the_process_with_one_line(graph: Graph, tmp_path: Path) -> None:
    bag = tmp_path / 'bag'
    add_recorder(graph, bag).finish()
    with recorder(graph, bag) as process:
        _, err = process.communicate(timeout=DEADLINE_S)
    assert process.returncode == 2
    assert err == f'Error: {bag}: contains a finished bag; choose a new folder\n'


def test_full_disk_is_said_once_and_survived(
    graph: Graph, peer: Peer, said: list[Said], tmp_path: Path
) -> None:
    """A limit of 64 KiB on every file stands for the disk."""
    bag = tmp_path / 'bag'
    [outcome] = [one for one in said[-1:] if one.topic.name == 'outcome']
    limited = ['bash', '-c', 'ulimit -f 64; exec "$@"', 'bash', *COMMAND]
    with recorder(graph, bag, command=limited) as process:
        peer.wait_for_listeners()
        peer.say(said)
        graph.spin_until(lambda: flushed(bag) == len(said))
        for _ in range(100):
            outcome.message.reason = os.urandom(1000).hex()
            peer.say([Said(outcome.topic, outcome.message)])
        os.set_blocking(process.stderr.fileno(), False)  # type: ignore[union-attr]
        told = ''

        def has_told() -> bool:
            nonlocal told
            told += process.stderr.read() or ''  # type: ignore[union-attr]
            return 'cannot be written' in told

        graph.spin_until(has_told)
        before = flushed(bag)
        assert len(said) <= before < len(said) + 100
        peer.say([Said(TRIAL, said[0].message)])
        os.set_blocking(process.stderr.fileno(), True)  # type: ignore[union-attr]
        code, err = stop(process, signal.SIGTERM)
    assert code == 0
    assert (told + err).count('cannot be written: File too large') == 1
    assert 'Traceback' not in told + err
    assert 'cannot be finished: File too large' in err
    assert [done.messages for done in repair(bag)] == [before]
    assert len(list(trials_of(bag, lambda _: None))) == 2
