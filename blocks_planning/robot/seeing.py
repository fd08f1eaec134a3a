"""Perception of blocks from their poses, with noise."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, degrees, pi

from blocks_planning.robot import noise
from blocks_planning.robot.coverage import Sighting, cover, rectangle
from blocks_planning.robot.scene import Body, Pose
from blocks_planning.robot.simulation import Simulation

LEAST_UPRIGHT = 0.87
"""Cosine of the largest angle between a block and the plane of the board: 30 degrees."""


def see_poses(
    simulation: Simulation, bodies: Iterable[Body], spread: float, seed: int, count: int
) -> list[Sighting]:
    """Sightings of blocks from their poses.

    Args:
        simulation: the simulation.
        bodies: the blocks to perceive.
        spread: standard deviation of a position [m].
        seed: of the noise.
        count: number of earlier perceptions.
    """
    return [_see(simulation, body, spread, seed, count) for body in bodies]


def _see(simulation: Simulation, body: Body, spread: float, seed: int, count: int) -> Sighting:
    pose, sizes = simulation.pose(body.number), simulation.sizes
    half_x, _, half_z = sizes.half(body.block)
    across, up, turn = noise.normal(seed, 'perceive', count, body.number, size=3)
    angle = angle_of(pose) + spread * turn / max(half_x, half_z)
    x, y, z = pose.position
    centre = x + spread * across, z + spread * up
    # The gap belongs to the cells that a block fills.
    half = half_x + sizes.gap / 2, half_z
    quarter = pi / 2
    return Sighting(
        body.number,
        body.block,
        cover(rectangle(centre, half, angle), sizes.cell),
        degrees(abs(angle - quarter * round(angle / quarter))),
        abs(y - sizes.middle) > sizes.cell / 2 or abs(depth_of(pose)) < LEAST_UPRIGHT,
    )


def angle_of(pose: Pose) -> float:
    """Rotation of a block in the plane of the board [rad], counterclockwise in the picture."""
    w, x, y, z = pose.orientation
    # Direction of the block's own x axis, along x and z of the board.
    return atan2(2 * (x * z - w * y), 1 - 2 * (y * y + z * z))


def depth_of(pose: Pose) -> float:
    """Cosine between the block's own y axis and that of the board."""
    _, x, _, z = pose.orientation
    return 1 - 2 * (x * x + z * z)
