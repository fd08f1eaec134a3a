"""The names of what the arm does, how long each may take, and why it fails."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from blocks_planning.board.blocks import Placement


class Phase(str, Enum):
    """What the arm does; those from APPROACH to SETTLE make an act, in this order."""

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
    """To the feeder: what is left in the gripper by an act that failed or was cancelled."""


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
"""Longest time of a phase [s], of the simulation: a board of 16 x 16 cells of 20 cm needs half."""

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
"""What it means if a phase takes longer. SETTLE ends then without a failure."""


@dataclass(frozen=True)
class Report:
    """How an act ended.

    Attributes:
        placement: what was ordered.
        phase: the last one, or the one that failed.
        reason: why it failed; None if it did not.
        text: the same as a sentence; '' if it did not fail.
        seconds: how long it took, in the time of the simulation [s].
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
    """Where an act is.

    Attributes:
        phase: what the arm does.
        fraction: how many of the phases of an act are over, 0 to 1.
        time: of the simulation [s].
        report: how the act ended; None while it goes on.
    """

    phase: Phase
    fraction: float
    time: float
    report: Report | None = None
