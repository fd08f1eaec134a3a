"""What the arm can be told, and what it can tell, whatever it is doing."""

from __future__ import annotations

from blocks_planning.robot.arm import ACCELERATION, FAST, Arm, face
from blocks_planning.robot.simulation import Simulation

ARRIVED = 0.002
"""An axis at its target is slower than this [m/s]."""
ASTRAY = 0.004
"""An axis that lags this far behind its set point is blocked [m]; its motor pushes with 160 N."""


def go(
    simulation: Simulation,
    arm: Arm,
    x: float | None = None,
    z: float | None = None,
    fastest: float = FAST,
    acceleration: float = ACCELERATION,
) -> bool:
    """Move on towards a target for one time step; whether the arm is there.

    Args:
        simulation: where the arm is.
        arm: its set points, which are changed.
        x: target of the tool [m]; None: stays.
        z: the same upwards.
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
    """Move up to ``travel``, then to ``x``; whether the arm is at ``x``, at whatever height."""
    if arm.x.position == x and abs(simulation.speeds[0]) < ARRIVED:
        return True
    if arm.x.speed == 0 and not go(simulation, arm, z=travel):
        return False
    return go(simulation, arm, x=x)


def halt(simulation: Simulation, arm: Arm) -> None:
    """Stay where the arm is now, so that it does not push on."""
    arm.x.position, arm.z.position = map(float, simulation.joints[:2])
    arm.x.speed = arm.z.speed = 0.0


def is_blocked(simulation: Simulation, arm: Arm) -> bool:
    """Whether something keeps an axis from where it should be."""
    x, z = simulation.joints[:2]
    return bool(max(abs(arm.x.position - x), abs(arm.z.position - z)) > ASTRAY)


def is_holding(simulation: Simulation, arm: Arm) -> bool:
    """Whether there is something between closed fingers."""
    sizes = simulation.sizes
    closing = float(simulation.joints[2:].mean())
    return arm.grip > face(sizes) and closing < face(sizes) + sizes.overclosing / 2
