"""Phases of the arm, their time limits, and the reasons of failure."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from blocks_planning.board.blocks import Placement


class Phase(str, Enum):
    """Phases of the arm; an act consists of those from APPROACH to SETTLE, in this order."""

    IDLE = 'idle'
    APPROACH = 'approach'
    GRASP = 'grasp'
    LIFT = 'lift'
    CARRY = 'carry'
    LOWER = 'lower'
    RELEASE = 'release'
    RETREAT = 'retreat'
    SETTLE = 'settle'
    BRING_BACK = 'bring_back'
    """Carry the block of a failed or cancelled act back to the feeder."""


class Reason(str, Enum):
    """Why an act failed."""

    NOTHING_GRASPED = 'nothing_grasped'
    DROPPED = 'dropped'
    COLLISION = 'collision'
    OUT_OF_REACH = 'out_of_reach'
    CANCELLED = 'cancelled'


ACT = (
    Phase.APPROACH,
    Phase.GRASP,
    Phase.LIFT,
    Phase.CARRY,
    Phase.LOWER,
    Phase.RELEASE,
    Phase.RETREAT,
    Phase.SETTLE,
)

BOUNDS_S = {
    Phase.APPROACH: 12.0,
    Phase.GRASP: 2.0,
    Phase.LIFT: 8.0,
    Phase.CARRY: 8.0,
    Phase.LOWER: 20.0,
    Phase.RELEASE: 2.0,
    Phase.RETREAT: 8.0,
    Phase.SETTLE: 4.0,
    Phase.BRING_BACK: 30.0,
}
"""Time limit of each phase, in simulated time [s]: a board of 16 x 16 cells of 20 cm needs half."""

LATE = {
    Phase.APPROACH: Reason.COLLISION,
    Phase.GRASP: Reason.NOTHING_GRASPED,
    Phase.LIFT: Reason.COLLISION,
    Phase.CARRY: Reason.COLLISION,
    Phase.LOWER: Reason.OUT_OF_REACH,
    Phase.RELEASE: Reason.COLLISION,
    Phase.RETREAT: Reason.COLLISION,
    Phase.BRING_BACK: Reason.COLLISION,
}
"""The reason of failure if a phase exceeds its limit. SETTLE then ends without a failure."""


@dataclass(frozen=True)
class Report:
    """The report of an act.

    Attributes:
        placement: the order.
        phase: the last one, or the one that failed.
        reason: reason of the failure; None if there was none.
        text: the reason as a sentence; '' if there was no failure.
        seconds: duration in simulated time [s].
        settled: whether everything had come to rest at the end.
    """

    placement: Placement
    phase: Phase
    reason: Reason | None
    text: str
    seconds: float
    settled: bool


@dataclass(frozen=True)
class Progress:
    """The progress of an act.

    Attributes:
        phase: the current phase.
        fraction: share of the phases that are finished, 0 to 1.
        time: simulated time [s].
        report: the report of the act; None while it is in progress.
    """

    phase: Phase
    fraction: float
    time: float
    report: Report | None = None
