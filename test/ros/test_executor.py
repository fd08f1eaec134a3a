"""The executor of the nodes: messages first, and nothing else is forgotten."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from builders import CHAIR, spec
from peers import Graph, Peer, context_of
from rcl_interfaces.srv import ListParameters
from rclpy.node import Node

from blocks_planning.ros.runtime.executor import OTHERS_S, MessageExecutor
from blocks_planning.ros.wire.topics import ACTION
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, PlaceBlock

SPEC = spec(CHAIR, depth=2)
HEARD: list[Message] = []
run_trial(SPEC, observe=HEARD.append)
ORDER = next(message for message in HEARD if isinstance(message, PlaceBlock))
DEADLINE_S = 60.0


class Spun:
    """A node with the executor, and what it has done."""

    def __init__(self, graph: Graph) -> None:
        self.graph = graph
        self.node = Node('spun', context=context_of('nodes'), namespace=graph.namespace)
        self.executor = MessageExecutor(self.node)
        self.done: list[Any] = []

    def until(self, condition: Callable[[], object]) -> None:
        """Spin the node and its peers until a condition holds."""
        end = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < end
            self.executor.spin_once(timeout_sec=0.01)
            self.graph.spin_some()


@pytest.fixture
def spun(graph: Graph) -> Iterator[Spun]:
    made = Spun(graph)
    yield made
    made.executor.shutdown()
    made.node.destroy_node()


def subscribe(spun: Spun, callback: Callable[..., None], *, raw: bool = True) -> Peer:
    """Subscribe, and make a peer that publishes."""
    qos = ACTION.subscription_qos
    spun.node.create_subscription(ACTION.ros_type, ACTION.name, callback, qos, raw=raw)
    peer = spun.graph.add(Peer, SPEC, (ACTION,), ())
    spun.until(peer.outlets[ACTION].get_subscription_count)
    return peer


def test_messages_are_handled_in_their_order(spun: Spun) -> None:
    peer = subscribe(spun, lambda message: spun.done.append(message.sequence), raw=False)
    for sequence in range(30):
        peer.say(PlaceBlock('x', sequence, ORDER.placement))
    spun.until(lambda: len(spun.done) == 30)
    assert spun.done == list(range(30))


def test_callback_gets_the_times_of_a_message_if_it_wants_them(spun: Spun) -> None:
    peer = subscribe(spun, lambda data, info: spun.done.append((data, info)))
    peer.say(ORDER)
    spun.until(lambda: spun.done)
    [(data, info)] = spun.done
    assert isinstance(data, bytes)
    assert info['source_timestamp'] > 0


def test_timers_services_and_tasks_have_their_turn_among_messages(spun: Spun) -> None:
    """Each message leads to the next: there is never a pause."""
    peer = subscribe(spun, lambda _: peer.say(ORDER))
    client = peer.create_client(ListParameters, 'spun/list_parameters')
    spun.until(client.service_is_ready)
    spun.node.create_timer(OTHERS_S, lambda: spun.done.append('timer'))
    peer.say(ORDER)
    answer = client.call_async(ListParameters.Request())
    threading.Thread(
        target=spun.executor.create_task, args=(lambda: spun.done.append('task'),)
    ).start()
    spun.until(lambda: answer.done() and {'timer', 'task'} <= set(spun.done))
    assert spun.done.count('task') == 1


def test_task_of_another_thread_ends_the_waiting(spun: Spun) -> None:
    def call() -> None:
        spun.executor.create_task(lambda: spun.done.append('task'))

    threading.Timer(0.2, call).start()
    begun = time.monotonic()
    while not spun.done and time.monotonic() - begun < DEADLINE_S:
        spun.executor.spin_once(timeout_sec=DEADLINE_S)
    assert spun.done == ['task']


def test_guard_conditions_are_not_lost(spun: Spun) -> None:
    guard = spun.node.create_guard_condition(lambda: spun.done.append('guard'))
    guard.trigger()
    spun.until(lambda: spun.done)
    guard.trigger()
    spun.until(lambda: len(spun.done) == 2)


def test_entities_may_come_and_go(spun: Spun) -> None:
    peer = subscribe(spun, lambda _: spun.done.append('one'))
    peer.say(ORDER)
    spun.until(lambda: spun.done)
    for subscription in list(spun.node.subscriptions):
        spun.node.destroy_subscription(subscription)
    other = subscribe(spun, lambda _: spun.done.append('other'))
    other.say(ORDER)
    spun.until(lambda: 'other' in spun.done)
    assert spun.done.count('one') == 1


def test_failure_of_a_callback_is_raised(spun: Spun) -> None:
    def fail(_: Any) -> None:
        raise ZeroDivisionError

    peer = subscribe(spun, fail)
    peer.say(ORDER)
    with pytest.raises(ZeroDivisionError):
        spun.until(lambda: False)
