"""Recorders of bags, inside a test and as processes, and a peer for them."""

from __future__ import annotations

import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from bag_builders import Said, contents
from peers import Graph
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes.bag_recorder import BagRecorder
from blocks_planning.ros.wire.topics import TOPICS

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
