"""A node that no message can bring down.

What comes from the graph is taken as bytes and read here, because a message that can't be read
would otherwise be lost without being counted; and a request that a service of rclpy itself stumbles
over would end the node.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from rclpy.clock import Clock, ClockType
from rclpy.node import Node
from rclpy.serialization import deserialize_message

from blocks_planning.ros.wire.conversions.fields import MessageError, refuse
from blocks_planning.ros.wire.topics import Topic, ViewTopic

MOST_BYTES = 8 << 20
"""Four times what the largest board and planner can have to say."""
WARN_PERIOD_S = 1.0
_SHOWN = 300


def read_message(kind: type[Any], data: bytes) -> Any:
    """The message of a type that some bytes say, in CDR.

    Raises:
        MessageError: if they say none, or are more than ``MOST_BYTES``.
    """
    if len(data) > MOST_BYTES:
        raise refuse('message', f'{len(data)} bytes', f'up to {MOST_BYTES} bytes')
    try:
        return deserialize_message(data, kind)
    except Exception:  # noqa: BLE001  whatever the middleware thinks of it
        raise MessageError(f'its {len(data)} bytes are no {kind.__name__}') from None


class GuardedNode(Node):
    """Counts what it refuses, and warns of it at a limited rate.

    Attributes:
        refused: how many messages, requests and goals.
        steady: a clock that no jump of another one matters to.
    """

    def __init__(self, name: str, **options: Any) -> None:
        """See :class:`Node`."""
        self.refused = 0
        self.steady = Clock(clock_type=ClockType.STEADY_TIME)
        super().__init__(name, **options)

    @property
    def now_s(self) -> float:
        """What the steady clock says [s]."""
        return float(self.steady.now().nanoseconds / 1e9)

    def refuse(self, what: str, reason: object) -> None:
        """Count something that is not as it must be, and warn of it if that was not just done."""
        self.refused += 1
        said = ' '.join(str(reason).split())
        self.get_logger().warning(
            f'refused {what}: {said[:_SHOWN]} ({self.refused} refused so far)',
            throttle_duration_sec=WARN_PERIOD_S,
            throttle_time_source_type=self.steady,
        )

    def take_bytes(self, topic: Topic | ViewTopic, callback: Callable[..., None]) -> None:
        """Subscribe to a topic; its messages are handed on as they travel, as CDR."""
        self.create_subscription(
            topic.ros_type, topic.name, callback, topic.subscription_qos, raw=True
        )

    def call_soon(self, callback: Callable[[], None]) -> None:
        """Call something in the thread that spins this node; from any thread."""
        executor = self.executor
        if executor is not None:
            executor.create_task(callback)

    def create_service(
        self, srv_type: Any, srv_name: str, callback: Callable[..., Any], **options: Any
    ) -> Any:
        """See :class:`Node`; what the callback stumbles over is refused with an empty response."""

        def answer(request: Any, response: Any) -> Any:
            try:
                return callback(request, response)
            except Exception as error:  # noqa: BLE001  such as a parameter of an unknown type
                self.refuse(f'a request to {srv_name}', error)
                return srv_type.Response()

        return super().create_service(srv_type, srv_name, answer, **options)
