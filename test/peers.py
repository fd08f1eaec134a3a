"""Nodes inside a test: a ROS domain of this process alone, and peers to talk with."""

from __future__ import annotations

import atexit
import os
import sys
import tempfile
import time
from collections.abc import Callable, Iterable
from functools import cache, partial
from typing import Any, TypeVar
from uuid import uuid4

from blocks_planning.ros.runtime.domain import Domain

# Before anything of rclpy is imported. The claim holds as long as this process lives.
DOMAIN = Domain()
atexit.register(DOMAIN.release)
os.environ.update(DOMAIN.environment(os.environ))
os.environ.setdefault('ROS_LOG_DIR', tempfile.mkdtemp(prefix='ros-log-'))

import rclpy  # noqa: E402
from rclpy.context import Context  # noqa: E402
from rclpy.duration import Duration  # noqa: E402
from rclpy.executors import SingleThreadedExecutor  # noqa: E402
from rclpy.node import Node  # noqa: E402
from rclpy.signals import SignalHandlerOptions  # noqa: E402

from blocks_planning.ros.runtime.part_node import PartNode  # noqa: E402
from blocks_planning.ros.wire.graph import NodeTopics  # noqa: E402
from blocks_planning.ros.wire.topics import TOPICS, TRIAL, Topic  # noqa: E402
from blocks_planning.trials.messages import Message  # noqa: E402
from blocks_planning.trials.spec import TrialSpec  # noqa: E402

DEADLINE_S = 60.0
_SPIN_S = 0.002
_TOPIC_OF = {topic.kind: topic for topic in TOPICS}

AnyNode = TypeVar('AnyNode', bound=Node)


@cache
def context_of(side: str) -> Context:
    """A context of this process: one for the nodes under test, another for their peers.

    They are never taken down. Deleting a participant of Fast DDS that has just seen another come
    or go can wait forever, with the GIL held (Fast DDS issue 6513); so the process ends instead.
    """
    context = Context()
    rclpy.init(args=[], context=context, signal_handler_options=SignalHandlerOptions.NO)
    atexit.register(_leave)
    return context


exit_status = 0
"""What the process ends with; set when the session is over."""


def _leave() -> None:
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(exit_status)


class Graph:
    """Nodes of one test, each with an executor of its own, in a namespace of the test.

    They are spun in turns by the thread of the test: nothing happens but inside
    :meth:`spin_until`.
    """

    def __init__(self) -> None:
        """No nodes yet."""
        self.namespace = f'/test_{uuid4().hex[:8]}'
        self._members: dict[Node, SingleThreadedExecutor] = {}

    def add(self, make_node: Callable[..., AnyNode], *arguments: Any, **options: Any) -> AnyNode:
        """Make a node; it gets the test's namespace, and peers are in another context."""
        is_peer = (
            isinstance(make_node, type) and make_node.__module__.split('.')[0] != 'blocks_planning'
        )
        context = context_of('peers' if is_peer else 'nodes')
        options.setdefault('namespace', self.namespace)
        node = make_node(*arguments, context=context, **options)
        executor = SingleThreadedExecutor(context=context)
        executor.add_node(node)
        self._members[node] = executor
        return node

    def remove(self, node: Node) -> None:
        """End a node."""
        executor = self._members.pop(node)
        finish = getattr(node, 'finish', None)
        if finish is not None:
            finish()
        executor.shutdown(timeout_sec=1.0)
        node.destroy_node()

    def spin_until(self, condition: Callable[[], object], deadline_s: float = DEADLINE_S) -> None:
        """Spin all nodes until a condition holds.

        Raises:
            AssertionError: if it does not hold in time.
        """
        end = time.monotonic() + deadline_s
        while not condition():
            assert time.monotonic() < end, f'not within {deadline_s} s'
            self.spin_some()

    def spin_some(self) -> None:
        """Give every node a turn."""
        for executor in list(self._members.values()):
            executor.spin_once(timeout_sec=_SPIN_S)

    def close(self) -> None:
        """End all nodes."""
        for node in list(self._members):
            self.remove(node)


class Peer(Node):
    """Says what a node listens to, and hears what it says.

    Attributes:
        heard: what the node said, in the order in which it came.
    """

    def __init__(
        self,
        spec: TrialSpec,
        says: Iterable[Topic],
        hears: Iterable[Topic],
        name: str = 'peer',
        **options: Any,
    ) -> None:
        """Advertise and subscribe; ``spec`` is of the trial that it talks about."""
        super().__init__(name, **options)
        self.heard: list[Any] = []
        self.hears = tuple(hears)
        self._board = spec.task.board
        self.outlets = {
            topic: self.create_publisher(topic.ros_type, topic.name, topic.publisher_qos)
            for topic in says
        }
        for topic in self.hears:
            self.create_subscription(
                topic.ros_type, topic.name, partial(self._hear, topic), topic.subscription_qos
            )

    def say(self, message: Message) -> None:
        """Say something that a part would say."""
        topic = _TOPIC_OF[type(message)]
        self.outlets[topic].publish(topic.to_ros(self._board, message))

    def _hear(self, topic: Topic, message: Any) -> None:
        self.heard.append(topic.from_ros(self._board, message))

    def only(self, *kinds: type[Any]) -> list[Any]:
        """What was heard of some kinds."""
        return [message for message in self.heard if isinstance(message, kinds)]


class Bench:
    """A node, and a peer that plays everybody else."""

    def __init__(
        self,
        graph: Graph,
        topics: NodeTopics,
        node: PartNode,
        spec: TrialSpec,
    ) -> None:
        """Wait until both know each other."""
        self.graph = graph
        self.topics = topics
        self.node = node
        self.spec = spec
        self.peer = graph.add(Peer, spec, topics.listens, topics.says)
        self.meet(self.peer)

    def meet(self, peer: Peer) -> None:
        """Wait until the node and a peer know each other."""
        ends = [*peer.outlets.values(), *self.node._outlets.values()]
        heard = [topic for topic in peer.hears if topic in self.topics.says]
        self.graph.spin_until(
            lambda: (
                all(end.get_subscription_count() for end in ends)
                and all(peer.count_publishers(topic.name) for topic in heard)
            )
        )

    def tell(self, *messages: Message) -> None:
        """Say something, and see that the node has heard it, one after the other."""
        for message in messages:
            topic = _TOPIC_OF[type(message)]
            self.peer.say(message)
            # What is latched makes room for what comes next, also if it was lost on its way.
            self.peer.outlets[topic].wait_for_all_acked(Duration(seconds=DEADLINE_S))
            self.fence(topic)

    def fence(self, topic: Topic) -> None:
        """See that the node has taken everything on a topic, by a message that it must refuse."""
        before = self.node.refused
        trial = self.node.trial
        trial_id = '' if topic is TRIAL or trial is None else trial.trial_id
        if topic is not TRIAL and trial is None:
            topic = TRIAL
        self.peer.outlets[topic].publish(topic.ros_type(trial_id=trial_id))
        self.graph.spin_until(lambda: self.node.refused > before)

    def hear(self, count: int, *kinds: type[Any]) -> list[Any]:
        """The first so many messages of some kinds (or any) that the node says."""
        kinds = kinds or (object,)
        self.graph.spin_until(lambda: len(self.peer.only(*kinds)) >= count)
        return self.peer.only(*kinds)
