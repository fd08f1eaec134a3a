"""Status of a trial."""

from __future__ import annotations

from enum import Enum


class TrialStatus(str, Enum):
    """The current or final status of a trial."""

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
