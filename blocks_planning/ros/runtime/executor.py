"""An executor for a node that receives many messages.

The executors of rclpy rebuild their wait set twice for every message, which takes longer than
handling most messages. This one keeps the wait set, and passes messages of subscriptions to their
callbacks itself. Everything else (timers, services, actions, events, tasks) is handled by the base
class, an executor of rclpy.
"""

from __future__ import annotations

import time
from typing import Any

from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.impl.implementation_singleton import rclpy_implementation as _rclpy
from rclpy.node import Node
from rclpy.subscription import Subscription
from rclpy.waitable import NumberOfEntities

OTHERS_S = 0.05
"""Longest delay of everything but messages while messages arrive without a pause [s]."""


class MessageExecutor(SingleThreadedExecutor):
    """Spins one node."""

    def __init__(self, node: Node) -> None:
        """Add a node; its entities may change later."""
        super().__init__(context=node.context)
        self.add_node(node)
        self._node = node
        self._entities: list[Any] = []
        self._wait_set: Any = None
        self._others_at = 0.0

    def spin_once(self, timeout_sec: float | None = None) -> None:
        """Wait up to ``timeout_sec`` [s]; handle a message of each topic, or one other entity.

        Raises:
            ExternalShutdownException: if rclpy was shut down.
        """
        ready = self._ready_subscriptions(timeout_sec)
        now = time.monotonic()
        if not ready or now - self._others_at >= OTHERS_S:
            self._others_at = now
            super().spin_once(timeout_sec=0)
        for subscription in ready:
            self._handle(subscription)

    def _ready_subscriptions(self, timeout_sec: float | None) -> list[Subscription]:
        """Wait for anything, and return the subscriptions that have a message."""
        if self._tasks:
            timeout_sec = 0
        node = self._node
        subscriptions, timers = list(node.subscriptions), list(node.timers)
        clients, services = list(node.clients), list(node.services)
        guards = [*node.guards, self._guard]
        waitables = list(node.waitables)
        entities = [*subscriptions, *timers, *clients, *services, *guards, *waitables]
        try:
            if entities != self._entities:
                self._entities = entities
                self._wait_set = self._make_wait_set(
                    len(subscriptions), len(guards), len(timers), len(clients), len(services)
                )
            wait_set = self._wait_set
            wait_set.clear_entities()
            for subscription in subscriptions:
                wait_set.add_subscription(subscription.handle)
            for timer in timers:
                wait_set.add_timer(timer.handle)
            for client in clients:
                wait_set.add_client(client.handle)
            for service in services:
                wait_set.add_service(service.handle)
            for guard in guards:
                wait_set.add_guard_condition(guard.handle)
            for waitable in waitables:
                waitable.add_to_wait_set(wait_set)
            wait_set.wait(-1 if timeout_sec is None else int(timeout_sec * 1e9))
        except (
            _rclpy.InvalidHandle
        ):  # an entity was destroyed meanwhile: the base class handles that
            return []
        if not self.context.ok():
            raise ExternalShutdownException
        triggered = set(wait_set.get_ready_entities('guard_condition'))
        for guard in node.guards:  # waiting has reset them; the base class triggers them again
            guard._executor_triggered |= guard.handle.pointer in triggered  # noqa: SLF001
        found = set(wait_set.get_ready_entities('subscription'))
        return [one for one in subscriptions if one.handle.pointer in found]

    def _make_wait_set(
        self, subscriptions: int, guards: int, timers: int, clients: int, services: int
    ) -> Any:
        count = NumberOfEntities(subscriptions, guards, timers, clients, services)
        for waitable in self._node.waitables:
            count += waitable.get_num_entities()
        handle: Any = self.context.handle
        with handle:
            return _rclpy.WaitSet(
                count.num_subscriptions,
                count.num_guard_conditions,
                count.num_timers,
                count.num_clients,
                count.num_services,
                count.num_events,
                handle,
            )

    def _handle(self, subscription: Subscription) -> None:
        """Pass a message to its callback."""
        with subscription.handle:
            taken = subscription.handle.take_message(subscription.msg_type, subscription.raw)
        if taken is None:
            return
        kind = subscription._callback_type  # noqa: SLF001  rclpy has no other way to see it
        if kind is Subscription.CallbackType.MessageOnly:
            subscription.callback(taken[0])
        else:
            subscription.callback(*taken)
