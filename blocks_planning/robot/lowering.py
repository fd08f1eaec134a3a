"""Lowering a block until contact, with new attempts if it meets an edge.

The only sensor is the motor of the z axis: after contact the support carries a part of the load.
"""

from __future__ import annotations

from enum import Enum

from blocks_planning.robot import moving
from blocks_planning.robot.arm import GENTLE, SLOW
from blocks_planning.robot.memory import Memory
from blocks_planning.robot.simulation import Simulation

TOUCH_N, TOUCH_SHARE = 0.6, 0.25
"""Contact: decrease of the load of the motor [N], and its least share of the load."""
BUMP_N = 10.0
"""Additional decrease while the tool is fast [N], because a motor that accelerates downwards also
carries less."""
OFFSETS = (0.0, 0.0004, -0.0004, 0.0008, -0.0008, 0.0012, -0.0012)
"""Offsets along x of new attempts after contact with an edge [m]: displaced neighbours can leave
too little room."""


class Descent(Enum):
    """The state of the descent of a block."""

    GOES_ON = 'goes on'
    STANDS = 'stands'
    TOO_HIGH = 'too high'
    NOTHING_BELOW = 'nothing below'


def descend(simulation: Simulation, memory: Memory, x: float, slack: float) -> Descent:
    """Lower the tool for one time step.

    Args:
        simulation: the simulation.
        memory: of the act; its arm, attempt and raised are changed.
        x: target of the block [m].
        slack: tolerance of the height of the contact [m].
    """
    arm, x = memory.arm, x + OFFSETS[memory.attempt]
    if memory.raised is not None:
        if moving.go(simulation, arm, z=memory.raised) and moving.go(simulation, arm, x=x):
            memory.raised = None
        return Descent.GOES_ON
    near = memory.landing + slack
    is_slow = arm.z.position < near
    if _touches(simulation, memory, is_slow):
        return _touched(simulation, memory, near)
    # The motor measures only the load once the tool has come to rest.
    if not is_slow and not memory.rests(moving.go(simulation, arm, z=near)):
        return Descent.GOES_ON
    lowest = max(memory.landing - 2 * slack, simulation.sizes.lowest)
    is_lowest = moving.go(simulation, arm, z=lowest, fastest=SLOW, acceleration=GENTLE)
    return Descent.NOTHING_BELOW if is_lowest else Descent.GOES_ON


def _touches(simulation: Simulation, memory: Memory, is_slow: bool) -> bool:
    least = max(TOUCH_N, TOUCH_SHARE * memory.load) + (0 if is_slow else BUMP_N)
    return memory.load - simulation.lift > least


def _touched(simulation: Simulation, memory: Memory, near: float) -> Descent:
    """Interpret a contact; if it is too high, prepare the next attempt."""
    z = float(simulation.joints[1])
    moving.halt(simulation, memory.arm)
    if z <= near:
        return Descent.STANDS
    if memory.attempt + 1 == len(OFFSETS):
        return Descent.TOO_HIGH
    memory.attempt += 1
    memory.raised = z + 0.2 * simulation.sizes.cell
    return Descent.GOES_ON
