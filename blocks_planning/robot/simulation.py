"""The physics: MuJoCo with the arm and the current blocks.

To add, glue or remove a block, the model is rebuilt; moving bodies keep their positions and speeds.
A glued block becomes a part of the table, so it needs no computing time.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from blocks_planning.board.blocks import Block
from blocks_planning.extras import extra
from blocks_planning.robot.gantry import DAMPING, JOINTS, STIFFNESS
from blocks_planning.robot.scene import Body, Pose, model_text
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.sizes import Sizes

with extra('robot'):
    import mujoco

Floats: TypeAlias = NDArray[np.float64]
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
Z = 1
"""Index of the z axis in ``JOINTS``."""
STILL = 0.003
"""Speed of corners below which a block is at rest [m/s]."""


class Simulation:
    """Blocks, arm and simulated time.

    Attributes:
        bodies: the current blocks.
        next_number: of the next block.
    """

    def __init__(self, sizes: Sizes, settings: RobotSettings) -> None:
        """An empty board, the arm at rest."""
        self.sizes = sizes
        self.settings = settings
        self.bodies: tuple[Body, ...] = ()
        self.next_number = 0
        self._load()

    @property
    def time(self) -> float:
        """Time since the beginning [s]."""
        return float(self.data.time)

    @property
    def text(self) -> str:
        """The model as MJCF."""
        return model_text(self.sizes, self.settings, self.bodies)

    def step(self) -> None:
        """Simulate one ``TIMESTEP``."""
        mujoco.mj_step(self.model, self.data)

    def refresh(self) -> None:
        """Compute derived quantities from positions, without motion."""
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    # --- the arm ----------------------------------------------------------------------------

    @property
    def joints(self) -> Floats:
        """Positions of ``JOINTS`` [m]."""
        return np.array(self.data.qpos[: len(JOINTS)])

    @property
    def speeds(self) -> Floats:
        """Speeds of ``JOINTS`` [m/s]."""
        return np.array(self.data.qvel[: len(JOINTS)])

    @property
    def lift(self) -> float:
        """Upward force of the motor of the z axis [N]: the weight that hangs from the tool.

        It is computed from the control law of the servo, because MuJoCo stores the force of the
        previous step, which is missing after a restore.
        """
        lag = float(self.data.ctrl[Z] - self.data.qpos[Z])
        return STIFFNESS * lag - DAMPING * float(self.data.qvel[Z])

    def command(self, targets: Iterable[float]) -> None:
        """Set the set points of ``JOINTS`` [m]."""
        self.data.ctrl[:] = tuple(targets)

    def put_arm(self, positions: Iterable[float]) -> None:
        """Set the joint positions without motion."""
        self.data.qpos[: len(JOINTS)] = tuple(positions)
        self.data.ctrl[:] = self.data.qpos[: len(JOINTS)]

    # --- the blocks -------------------------------------------------------------------------

    def add(self, block: Block, x: float) -> int:
        """Place a block on the table with its centre at ``x``; return its number."""
        half = self.sizes.half(block)
        number, self.next_number = self.next_number, self.next_number + 1
        body = Body(number, block, Pose((x, self.sizes.middle, half[2])))
        self._rebuild((*self.bodies, body))
        return number

    def remove(self, numbers: Iterable[int]) -> None:
        """Remove blocks."""
        unwanted = set(numbers)
        if unwanted:
            self._rebuild(tuple(body for body in self.bodies if body.number not in unwanted))

    def glue(self, numbers: Iterable[int]) -> None:
        """Fix blocks in their current poses."""
        wanted = set(numbers)
        if wanted:
            self._rebuild(
                tuple(
                    replace(body, pose=self.pose(body.number), fixed=True)
                    if body.number in wanted
                    else body
                    for body in self.bodies
                )
            )

    def body(self, number: int) -> Body:
        """The current block of a number."""
        return next(body for body in self.bodies if body.number == number)

    @property
    def free(self) -> tuple[Body, ...]:
        """The blocks that can move."""
        return tuple(body for body in self.bodies if not body.fixed)

    def is_at_feeder(self, number: int) -> bool:
        """Whether a block is at the feeder, or beyond it."""
        return self.pose(number).position[0] < -2 * self.sizes.cell

    def pose(self, number: int) -> Pose:
        """The current pose of a block."""
        body = self.body(number)
        if body.fixed:
            return body.pose
        values = self._positions(body).tolist()
        return Pose((values[0], values[1], values[2]), tuple(values[3:7]))

    def place(self, number: int, pose: Pose) -> None:
        """Set the pose of a loose block, at rest."""
        self._positions(self.body(number))[:] = (*pose.position, *pose.orientation)
        self._velocities(self.body(number))[:] = 0

    def push(self, number: int, velocity: tuple[float, float, float]) -> None:
        """Give a loose block a velocity [m/s]."""
        self._velocities(self.body(number))[:3] = velocity

    def fastest(self, numbers: Iterable[int]) -> float:
        """Upper bound of the speed of corners of some loose blocks [m/s]."""
        fastest = 0.0
        for number in numbers:
            body = self.body(number)
            velocity = self._velocities(body)
            radius = float(np.linalg.norm(self.sizes.half(body.block)))
            speed = float(np.linalg.norm(velocity[:3]))
            fastest = max(fastest, speed + radius * float(np.linalg.norm(velocity[3:])))
        return fastest

    def _positions(self, body: Body) -> Floats:
        """A view of position and orientation of a loose block."""
        start = self.model.joint(body.name).qposadr[0]
        view: Floats = self.data.qpos[start : start + 7]
        return view

    def _velocities(self, body: Body) -> Floats:
        """A view of the linear and angular velocity of a loose block."""
        start = self.model.joint(body.name).dofadr[0]
        view: Floats = self.data.qvel[start : start + 6]
        return view

    # --- the state --------------------------------------------------------------------------

    @property
    def state(self) -> Floats:
        """The complete state of the current bodies."""
        values = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, values, _STATE)
        return values

    def restore(self, bodies: tuple[Body, ...], next_number: int, state: Floats) -> None:
        """Restore a state.

        Raises:
            ValueError: if the state does not fit these bodies; then nothing is changed.
        """
        before = self.bodies, self.next_number
        self.bodies, self.next_number = bodies, next_number
        self._load()
        if state.shape != (mujoco.mj_stateSize(self.model, _STATE),):
            self.bodies, self.next_number = before
            self._load()
            raise ValueError(f'a state of {state.size} numbers does not fit the scene')
        mujoco.mj_setState(self.model, self.data, state, _STATE)
        self.refresh()

    def _load(self) -> None:
        self.model: Any = mujoco.MjModel.from_xml_string(self.text)
        self.data: Any = mujoco.MjData(self.model)
        self.refresh()

    def _rebuild(self, bodies: tuple[Body, ...]) -> None:
        """Rebuild the model for other bodies; loose bodies keep their state."""
        count = len(JOINTS)
        old, kept = self.data, self.free
        poses = {body.number: np.array(self._positions(body)) for body in kept}
        velocities = {body.number: np.array(self._velocities(body)) for body in kept}
        self.bodies = bodies
        self._load()
        self.data.time = old.time
        self.data.qpos[:count], self.data.qvel[:count] = old.qpos[:count], old.qvel[:count]
        self.data.ctrl[:] = old.ctrl
        for body in self.free:
            if body.number in poses:
                self._positions(body)[:] = poses[body.number]
                self._velocities(body)[:] = velocities[body.number]
        self.refresh()
