"""Elementary motions and states of the arm, independent of the phase."""

from __future__ import annotations

from blocks_planning.robot.arm import ACCELERATION, FAST, Arm, face
from blocks_planning.robot.simulation import Simulation

ARRIVED = 0.002
"""Speed below which an axis is at its target [m/s]."""
ASTRAY = 0.004
"""Lag behind the set point at which an axis is blocked [m]; its motor then pushes with 160 N."""


def go(
    simulation: Simulation,
    arm: Arm,
    x: float | None = None,
    z: float | None = None,
    fastest: float = FAST,
    acceleration: float = ACCELERATION,
) -> bool:
    """Move towards a target for one time step; return whether the arm is there.

    Args:
        simulation: the simulation.
        arm: its set points, which are changed.
        x: target of the tool [m]; None: no motion along x.
        z: the same along z.
        fastest: speed of an axis [m/s].
        acceleration: of an axis [m/s2].
    """
    speeds = simulation.speeds
    is_there = True
    for axis, target, speed in ((arm.x, x, speeds[0]), (arm.z, z, speeds[1])):
        if target is not None:
            axis.towards(target, fastest, acceleration)
            is_there &= axis.position == target and bool(abs(speed) < ARRIVED)
    return is_there


def go_over(simulation: Simulation, arm: Arm, x: float, travel: float) -> bool:
    """Move up to ``travel``, then to ``x``; return whether the arm is at ``x``, at any height."""
    if arm.x.position == x and abs(simulation.speeds[0]) < ARRIVED:
        return True
    if arm.x.speed == 0 and not go(simulation, arm, z=travel):
        return False
    return go(simulation, arm, x=x)


def halt(simulation: Simulation, arm: Arm) -> None:
    """Set the set points to the current position, so that the arm does not keep pushing."""
    arm.x.position, arm.z.position = map(float, simulation.joints[:2])
    arm.x.speed = arm.z.speed = 0.0


def is_blocked(simulation: Simulation, arm: Arm) -> bool:
    """Whether an obstacle blocks an axis."""
    x, z = simulation.joints[:2]
    return bool(max(abs(arm.x.position - x), abs(arm.z.position - z)) > ASTRAY)


def is_holding(simulation: Simulation, arm: Arm) -> bool:
    """Whether the closed fingers hold something."""
    sizes = simulation.sizes
    front, back = simulation.joints[2:].tolist()
    closing = (front + back) / 2
    return arm.grip > face(sizes) and closing < face(sizes) + sizes.overclosing / 2
