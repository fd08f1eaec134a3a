"""Quality of service, by intent."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

STREAM_DEPTH = 1000
"""A queue that is shallower at either end than a burst is long loses messages without a word."""


def latched_state(depth: int = 1) -> QoSProfile:
    """For who publishes what holds until further notice: the latest reach late comers too."""
    return _profile(depth, DurabilityPolicy.TRANSIENT_LOCAL)


def every_latched_state() -> QoSProfile:
    """For who listens to a latched topic: begin with the latest, then miss none."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.TRANSIENT_LOCAL)


def stream() -> QoSProfile:
    """For what has to arrive once, at both ends."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.VOLATILE)


def _profile(depth: int, durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(
        depth=depth,
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=durability,
    )
