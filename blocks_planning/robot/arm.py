"""Set points of the arm: axes with bounded speed and acceleration, and the gripper."""

from __future__ import annotations

from dataclasses import dataclass, field

from blocks_planning.robot.gantry import DAMPING, STIFFNESS
from blocks_planning.robot.scene import TIMESTEP
from blocks_planning.robot.sizes import Sizes

ACCELERATION = 2.0
"""Acceleration of a moving axis [m/s2]."""
BRAKING = 5.0
"""Deceleration of an axis that must stop immediately [m/s2]."""
FAST = 0.5
"""Speed of an axis in free space [m/s]: it can stop in 0.1 s."""
SLOW, GENTLE = 0.02, 0.1
"""Speed [m/s] and acceleration [m/s2] towards a contact: so low that the motor senses only the
contact."""
FINGER_SPEED = 0.12
"""[m/s]"""


@dataclass
class Axis:
    """The position [m] and speed [m/s] of the set point of an axis."""

    position: float = 0.0
    speed: float = 0.0

    @property
    def command(self) -> float:
        """The command of the servo [m]: ahead of the set point, against the lag of its damping."""
        return self.position + self.speed * DAMPING / STIFFNESS

    def towards(
        self, target: float, fastest: float = FAST, acceleration: float = ACCELERATION
    ) -> None:
        """Move for one time step."""
        distance = target - self.position
        sign = 1.0 if distance > 0 else -1.0
        wanted = sign * min(fastest, (2 * acceleration * abs(distance)) ** 0.5)
        self._change_speed(wanted, acceleration)
        if abs(self.speed) * TIMESTEP >= abs(distance) and self.speed * distance >= 0:
            self.position, self.speed = target, 0.0
        else:
            self.position += self.speed * TIMESTEP

    def stop(self) -> None:
        """Slow down for one time step."""
        self._change_speed(0.0, BRAKING)
        self.position += self.speed * TIMESTEP

    def _change_speed(self, wanted: float, rate: float) -> None:
        most = rate * TIMESTEP
        self.speed += max(-most, min(most, wanted - self.speed))


@dataclass
class Arm:
    """The set points: tool position, and closing distance of the fingers [m]."""

    x: Axis = field(default_factory=Axis)
    z: Axis = field(default_factory=Axis)
    grip: float = 0.0

    @property
    def commands(self) -> tuple[float, float, float, float]:
        """The commands of the servos, in the order of the joints of the scene."""
        return self.x.command, self.z.command, self.grip, self.grip

    def grip_towards(self, target: float) -> None:
        """Close or open the fingers for one time step."""
        most = FINGER_SPEED * TIMESTEP
        self.grip += max(-most, min(most, target - self.grip))

    def stop(self) -> None:
        """Slow down both axes for one time step; the fingers do not move."""
        self.x.stop()
        self.z.stop()

    @property
    def is_at_rest(self) -> bool:
        """Whether no axis is moving."""
        return self.x.speed == 0 and self.z.speed == 0


def closed(sizes: Sizes) -> float:
    """Set point of the fingers that hold a block."""
    return face(sizes) + sizes.overclosing


def face(sizes: Sizes) -> float:
    """The closing distance at which the fingers touch a block."""
    return sizes.open_gap + sizes.gap / 2
