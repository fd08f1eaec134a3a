"""Profiles of quality of service, by purpose."""

from __future__ import annotations

from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

STREAM_DEPTH = 1000
"""Depth of queues: a queue at either end that is shallower than a burst silently drops messages."""


def latched_state(depth: int = 1) -> QoSProfile:
    """For publishers of latched topics: late subscribers receive the latest messages too."""
    return _profile(depth, DurabilityPolicy.TRANSIENT_LOCAL)


def every_latched_state() -> QoSProfile:
    """For subscribers of latched topics: receive the latest message, then all later ones."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.TRANSIENT_LOCAL)


def stream() -> QoSProfile:
    """For messages that must arrive once; used at both ends."""
    return _profile(STREAM_DEPTH, DurabilityPolicy.VOLATILE)


def _profile(depth: int, durability: DurabilityPolicy) -> QoSProfile:
    return QoSProfile(
        depth=depth,
        history=HistoryPolicy.KEEP_LAST,
        reliability=ReliabilityPolicy.RELIABLE,
        durability=durability,
    )
