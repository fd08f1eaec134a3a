"""Settings of the robot and its blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import Configured, setting

POSES, CAMERA = 'poses', 'camera'


@dataclass(frozen=True)
class RobotSettings(Configured):
    """Settings of the robot, its blocks, and its noise.

    Raises:
        ConfigurationError: for a value out of its range.
    """

    name: ClassVar[str] = 'gantry'

    glue: bool = setting(True, 'Fix a block where it has come to rest.')
    perception: str = setting(POSES, 'Source of perceived blocks.', choices=(POSES, CAMERA))
    pose_noise_m: float = setting(
        0.0, 'Standard deviation of a perceived position.', least=0, most=0.1, unit='m'
    )
    grip_noise_m: float = setting(
        0.0, 'Standard deviation of the grip position.', least=0, most=0.1, unit='m'
    )
    cell_m: float = setting(0.04, 'Side of a cell.', least=0.01, most=0.2, unit='m')
    gap_m: float = setting(
        0.0005,
        'Difference between the width of the cells and of a block.',
        least=0,
        most=0.005,
        unit='m',
    )
    density: float = setting(400.0, 'Density of the blocks.', least=50, most=5000, unit='kg/m3')
    friction: float = setting(0.8, 'Friction between blocks.', least=0.05, most=2)
    grip_force_n: float = setting(20.0, 'Force of a finger.', least=0.1, most=200, unit='N')
