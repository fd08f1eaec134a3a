"""An orchestrator that does not wait long, and a listener to what it says."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from peers import Graph
from rclpy.node import Node
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.runtime.diagnostics import TOPIC
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.wire.topics import OUTCOME


class Listener(Node):
    """Hears the health of all nodes, and the outcomes of all trials."""

    def __init__(self, **options: Any) -> None:
        super().__init__('listener', **options)
        self.health: list[DiagnosticStatus] = []
        self.outcomes: list[Any] = []
        self.create_subscription(DiagnosticArray, TOPIC, self._hear, 10)
        self.create_subscription(
            OUTCOME.ros_type, OUTCOME.name, self.outcomes.append, OUTCOME.subscription_qos
        )

    def _hear(self, message: Any) -> None:
        self.health += message.status

    def of(self, node: Node) -> list[dict[str, str]]:
        """What a node has said of itself."""
        own = [s for s in self.health if s.name == node.get_fully_qualified_name()]
        return [{value.key: value.value for value in status.values} for status in own]


def orchestrator(graph: Graph, folder: Path, *wait_for: str, **parameters: Any) -> Any:
    """The orchestrator, that does not wait long."""
    values = {
        'out_dir': str(folder),
        'wait_for': list(wait_for) or ['world', 'subgoal_selector', 'action_searcher'],
        'peer_timeout_s': 0.2,
        **parameters,
    }
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    return graph.add(
        lambda **options: TrialOrchestrator(
            threading.Event(), parameter_overrides=overrides, **options
        )
    )


def wait_for_peers(graph: Graph, node: PartNode, *names: str) -> None:
    """Until a node sees some others; what it sees the next node of its context sees at once."""
    graph.spin_until(lambda: not node.peers.missing(names))
