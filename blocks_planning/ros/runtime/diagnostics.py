"""The health of a node, once a second on ``/diagnostics``, as ROS tools expect it.

One status per node, by its fully qualified name; values are texts. All nodes have ``state``,
``trial``, ``peers_present`` and ``peers_missing``; other values depend on the node.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

TOPIC = '/diagnostics'
PERIOD_S = 1.0
_DEPTH = 10


@dataclass(frozen=True)
class Health:
    """The health of a node.

    Attributes:
        state: a word: idle, waiting, building, searching, recording ...
        trial: id of the running trial; '' if there is none.
        missing: names of missing peers.
        failure: a sentence that describes a failure; '' if there is none.
        values: other values, by name.
    """

    state: str
    trial: str = ''
    present: Iterable[str] = ()
    missing: Iterable[str] = ()
    failure: str = ''
    values: Mapping[str, object] = field(default_factory=dict)

    def status(self, name: str) -> DiagnosticStatus:
        """As a message; ``name`` is the fully qualified name of the node."""
        missing = ', '.join(self.missing)
        level, message = DiagnosticStatus.OK, self.state
        if missing:
            level, message = DiagnosticStatus.WARN, f'waiting for {missing}'
        if self.failure:
            level, message = DiagnosticStatus.ERROR, self.failure
        values = {
            'state': self.state,
            'trial': self.trial,
            **self.values,
            'peers_present': ', '.join(self.present),
            'peers_missing': missing,
        }
        return DiagnosticStatus(
            level=level,
            name=name,
            message=message,
            hardware_id='',
            values=[KeyValue(key=key, value=str(value)) for key, value in values.items()],
        )


class Diagnostics:
    """Publishes the health of a node from a timer of the node."""

    def __init__(self, node: Node, look: Callable[[], Health]) -> None:
        """Create the publisher and its timer.

        Args:
            node: the node.
            look: returns the current health.
        """
        self._node, self._look = node, look
        self._outlet = node.create_publisher(DiagnosticArray, TOPIC, _DEPTH)
        node.create_timer(PERIOD_S, self.say, clock=Clock(clock_type=ClockType.STEADY_TIME))

    def say(self) -> None:
        """Publish the current health."""
        message = DiagnosticArray(
            status=[self._look().status(self._node.get_fully_qualified_name())]
        )
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._outlet.publish(message)
