"""What can be chosen about the robot and its blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from blocks_planning.settings import Configured, setting

POSES, CAMERA = 'poses', 'camera'


@dataclass(frozen=True)
class RobotSettings(Configured):
    """The robot, its blocks, and how well it sees and grips.

    Raises:
        ConfigurationError: for a value out of its range.
    """

    name: ClassVar[str] = 'gantry'

    glue: bool = setting(True, 'Fix a block where it has come to rest.')
    perception: str = setting(POSES, 'What blocks are seen with.', choices=(POSES, CAMERA))
    pose_noise_m: float = setting(
        0.0, 'Standard deviation of a seen position.', least=0, most=0.1, unit='m'
    )
    grip_noise_m: float = setting(
        0.0, 'Standard deviation of where a block is gripped.', least=0, most=0.1, unit='m'
    )
    cell_m: float = setting(0.04, 'Side of a cell.', least=0.01, most=0.2, unit='m')
    gap_m: float = setting(
        0.0005, 'How much narrower a block is than its cells.', least=0, most=0.005, unit='m'
    )
    density: float = setting(400.0, 'Density of the blocks.', least=50, most=5000, unit='kg/m3')
    friction: float = setting(0.8, 'Friction between blocks.', least=0.05, most=2)
    grip_force_n: float = setting(20.0, 'Force of a finger.', least=0.1, most=200, unit='N')
