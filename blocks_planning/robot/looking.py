"""What a viewer needs of a simulation: its shapes, and the pose and focal length of a camera."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians, tan

import numpy as np
from numpy.typing import NDArray

from blocks_planning.extras import extra
from blocks_planning.robot.scene import FILM_CAMERA, Pose
from blocks_planning.robot.simulation import Simulation

with extra('robot'):
    import mujoco


@dataclass(frozen=True)
class Shape:
    """A box of the scene.

    Attributes:
        name: in the model; a block is called ``block_NUMBER``.
        pose: of its centre.
        size: along its own x, y and z [m].
        colour: red, green, blue and opacity, 0 to 1.
    """

    name: str
    pose: Pose
    size: tuple[float, float, float]
    colour: tuple[float, float, float, float]


def shapes_of(simulation: Simulation) -> Iterator[Shape]:
    """Every box: board, feeder, arm and blocks."""
    model, data = simulation.model, simulation.data
    for index in range(model.ngeom):
        if model.geom_type[index] == mujoco.mjtGeom.mjGEOM_BOX:
            x, y, z = (2 * model.geom_size[index]).tolist()
            red, green, blue, opacity = model.geom_rgba[index].tolist()
            yield Shape(
                model.geom(index).name,
                _pose(data.geom_xpos[index], data.geom_xmat[index]),
                (x, y, z),
                (red, green, blue, opacity),
            )


def camera_pose(simulation: Simulation) -> Pose:
    """The pose of the film camera as an optical frame: z forwards, x right, y down (REP 103)."""
    camera = simulation.model.camera(FILM_CAMERA).id
    # In MuJoCo a camera looks along -z, and y is up.
    turned = simulation.data.cam_xmat[camera].reshape(3, 3) @ np.diag([1.0, -1.0, -1.0])
    return _pose(simulation.data.cam_xpos[camera], turned.reshape(9))


def focal_length(simulation: Simulation, height: int) -> float:
    """Focal length of the film camera for pictures of this height [pixels]."""
    angle = radians(float(simulation.model.camera(FILM_CAMERA).fovy[0]))
    return height / 2 / tan(angle / 2)


def _pose(position: NDArray[np.float64], matrix: NDArray[np.float64]) -> Pose:
    orientation = np.empty(4)
    mujoco.mju_mat2Quat(orientation, np.ascontiguousarray(matrix))
    x, y, z = position.tolist()
    return Pose((x, y, z), tuple(orientation.tolist()))
