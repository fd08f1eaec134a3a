"""A node that no message can crash.

Messages are received as bytes and decoded here, because the middleware would drop an invalid
message without counting it. Services are guarded too, because a request for which a service of
rclpy raises an exception would end the node.
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
"""Size limit of a message [bytes]: four times the largest valid one."""
WARN_PERIOD_S = 1.0
_SHOWN = 300


def read_message(kind: type[Any], data: bytes) -> Any:
    """Decode a message of a type from CDR bytes.

    Raises:
        MessageError: if they are invalid, or more than ``MOST_BYTES``.
    """
    if len(data) > MOST_BYTES:
        raise refuse('message', f'{len(data)} bytes', f'up to {MOST_BYTES} bytes')
    try:
        return deserialize_message(data, kind)
    except Exception:  # noqa: BLE001  the middleware raises many kinds of exceptions
        raise MessageError(f'its {len(data)} bytes are not a {kind.__name__}') from None


class GuardedNode(Node):
    """Counts refused messages, and warns about them at a limited rate.

    Attributes:
        refused: number of refused messages, requests and goals.
        steady: a monotonic clock, independent of the system time.
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
        """Count an invalid message, request or goal, and warn about it at a limited rate."""
        self.refused += 1
        said = ' '.join(str(reason).split())
        self.get_logger().warning(
            f'refused {what}: {said[:_SHOWN]} ({self.refused} refused so far)',
            throttle_duration_sec=WARN_PERIOD_S,
            throttle_time_source_type=self.steady,
        )

    def take_bytes(self, topic: Topic | ViewTopic, callback: Callable[..., None]) -> None:
        """Subscribe to a topic; the callback receives messages as CDR bytes."""
        self.create_subscription(
            topic.ros_type, topic.name, callback, topic.subscription_qos, raw=True
        )

    def call_soon(self, callback: Callable[[], None]) -> None:
        """Schedule a call in the thread that spins this node; usable from any thread."""
        executor = self.executor
        if executor is not None:
            executor.create_task(callback)

    def create_service(
        self, srv_type: Any, srv_name: str, callback: Callable[..., Any], **options: Any
    ) -> Any:
        """See :class:`Node`; a request whose callback raises gets an empty response."""

        def answer(request: Any, response: Any) -> Any:
            try:
                return callback(request, response)
            except Exception as error:  # noqa: BLE001  such as a parameter of an unknown type
                self.refuse(f'a request to {srv_name}', error)
                return srv_type.Response()

        return super().create_service(srv_type, srv_name, answer, **options)
