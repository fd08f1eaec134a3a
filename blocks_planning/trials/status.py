"""How a trial can end."""

from __future__ import annotations

from enum import Enum


class TrialStatus(str, Enum):
    """How a trial stands, or ended."""

    BUILDING = 'building'
    SUCCESS = 'success'
    """The filled cells are the silhouette: the paper's perfect reconstruction."""
    STUCK = 'stuck'
    """Nothing legal is left."""
    COLLAPSED = 'collapsed'
    """The tower of loose blocks fell."""
    GAVE_UP = 'gave_up'
    """The planner places no further block."""
    CANCELLED = 'cancelled'
