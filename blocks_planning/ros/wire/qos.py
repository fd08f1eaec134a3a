"""Quality of service, by intent."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

STREAM_DEPTH = 1000
"""A queue that is shallower than a burst at either end silently drops messages."""


def latched_state(depth: int = 1) -> QoSProfile:
    """For publishers of latched topics: late subscribers receive the latest messages too."""
    return _profile(depth, DurabilityPolicy.TRANSIENT_LOCAL)


def every_latched_state() -> QoSProfile:
    """For subscribers of latched topics: begin with the latest message, then miss none."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.TRANSIENT_LOCAL)


def stream() -> QoSProfile:
    """For messages that have to arrive once; used at both ends."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.VOLATILE)


def _profile(depth: int, durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(
        depth=depth,
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=durability,
    )
