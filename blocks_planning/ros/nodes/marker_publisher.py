"""Node ``marker_publisher``: shows the tower in RViz and Foxglove.

Every array begins with a marker that deletes all others, so the latest array is the whole scene;
see :mod:`blocks_planning.view.solids` for its contents. When scenes change faster than they are
published, intermediate ones are skipped.

| | |
|---|---|
| subscribes | `trial`, `state`, `subgoal`, `outcome` (latched) |
| publishes | `markers` (latched) |
| parameters | `remind_period_s`; `frame_id`; `cell_size`: side of a cell in metres; `publish_period_s`: longest time until a change is shown |
"""

from __future__ import annotations

from typing import Any

from rclpy.duration import Duration
from std_msgs.msg import Header

from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import ACKNOWLEDGE_S
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.runtime.watcher import Watcher
from blocks_planning.ros.wire.conversions.markers import markers_to_ros
from blocks_planning.ros.wire.graph import MARKER_PUBLISHER
from blocks_planning.ros.wire.topics import MARKERS
from blocks_planning.view.scene import Scene
from blocks_planning.view.solids import solids_of

CELL_SIZE = Parameter('cell_size', 0.05, 'Side of a cell [m].', (1e-4, 100.0))
PUBLISH_PERIOD = Parameter(
    'publish_period_s', 0.05, 'Longest time until a change is shown [s].', (0.02, 60.0)
)


class MarkerPublisher(Watcher):
    """Publishes the latest scene if it differs from the last published one."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`."""
        super().__init__(MARKER_PUBLISHER, (CELL_SIZE, PUBLISH_PERIOD), **options)
        self._shown: Scene | None = None
        self._outlet = self.create_publisher(MARKERS.ros_type, MARKERS.name, MARKERS.publisher_qos)
        self.create_timer(self.values['publish_period_s'], self._show, clock=self.steady)

    def _show(self) -> None:
        """Publish the scene, unless it is already published."""
        if self.scene is None or self.scene is self._shown:
            return
        self._shown = self.scene
        header = Header(stamp=self.get_clock().now().to_msg(), frame_id=self.values['frame_id'])
        solids = solids_of(self.scene)
        self._outlet.publish(markers_to_ros(solids, header, self.values['cell_size']))

    def finish(self) -> None:
        """Before shutdown: show how the last trial ended."""
        self._show()
        self._outlet.wait_for_all_acked(Duration(seconds=ACKNOWLEDGE_S))


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: MarkerPublisher())


if __name__ == '__main__':
    main()
