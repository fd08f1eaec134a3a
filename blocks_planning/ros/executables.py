"""The executables of ``ros2 run``: one function per node.

Importing a node takes a while (rclpy, numba), and a signal during the import would end in a
traceback. So this module imports almost nothing. Until a node has its own handlers, a signal simply
ends the process; there is nothing to shut down yet.
"""

from __future__ import annotations

import os
import signal
import sys
from importlib import import_module


def _start(name: str) -> None:
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: os._exit(0))
    import_module(f'blocks_planning.ros.nodes.{name}').main()


def world() -> None:
    """Owns the board."""
    _start('world')


def subgoal_selector() -> None:
    """Chooses the next region."""
    _start('subgoal_selector')


def action_searcher() -> None:
    """Plans how to fill a region."""
    _start('action_searcher')


def trial_orchestrator() -> None:
    """Runs the trials."""
    _start('trial_orchestrator')


def bag_recorder() -> None:
    """Records a bag."""
    _start('bag_recorder')


def marker_publisher() -> None:
    """Shows the tower in RViz and Foxglove."""
    _start('marker_publisher')


def trial_view() -> None:
    """Serves the page."""
    _start('trial_view')


def robot_arm() -> None:
    """Carries out orders with a simulated robot."""
    _start('robot_arm')


if __name__ == '__main__':
    _start(sys.argv.pop(1))
