"""The physics: MuJoCo with the arm and the blocks that there are now.

A block appears, is glued or taken away by making the model anew; what moves goes on with its
positions and speeds. A glued block is a part of the table from then on, so it costs no time.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from blocks_planning.board.blocks import Block
from blocks_planning.extras import extra
from blocks_planning.robot.scene import DAMPING, JOINTS, STIFFNESS, Body, Pose, model_text
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.sizes import Sizes

with extra('robot'):
    import mujoco

Floats: TypeAlias = NDArray[np.float64]
_STATE = mujoco.mjtState.mjSTATE_INTEGRATION
Z = 1
"""Index of the z axis in ``JOINTS``."""
STILL = 0.003
"""A corner of a block at rest is slower than this [m/s]."""


class Simulation:
    """Blocks and arm, and the time that has passed.

    Attributes:
        bodies: the blocks that are there.
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
        """Let the next ``TIMESTEP`` pass."""
        mujoco.mj_step(self.model, self.data)

    def refresh(self) -> None:
        """Compute what follows from positions; nothing moves."""
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
        """Force of the motor of the z axis upwards [N]: the weight of what hangs from the tool.

        It is computed from the law of the servo, because what MuJoCo keeps is that of the step
        before, and is not there after a restore.
        """
        lag = float(self.data.ctrl[Z] - self.data.qpos[Z])
        return STIFFNESS * lag - DAMPING * float(self.data.qvel[Z])

    def command(self, targets: Iterable[float]) -> None:
        """Give the set points of ``JOINTS`` [m]."""
        self.data.ctrl[:] = tuple(targets)

    def put_arm(self, positions: Iterable[float]) -> None:
        """Set the joints without moving there."""
        self.data.qpos[: len(JOINTS)] = tuple(positions)
        self.data.ctrl[:] = self.data.qpos[: len(JOINTS)]

    # --- the blocks -------------------------------------------------------------------------

    def add(self, block: Block, x: float) -> int:
        """Stand a block on the table with its middle at ``x``; return its number."""
        half = self.sizes.half(block)
        number, self.next_number = self.next_number, self.next_number + 1
        body = Body(number, block, Pose((x, self.sizes.middle, half[2])))
        self._rebuild((*self.bodies, body))
        return number

    def remove(self, numbers: Iterable[int]) -> None:
        """Take blocks away."""
        unwanted = set(numbers)
        if unwanted:
            self._rebuild(tuple(body for body in self.bodies if body.number not in unwanted))

    def glue(self, numbers: Iterable[int]) -> None:
        """Fix blocks where they are now."""
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
        """The block of a number that is there."""
        return next(body for body in self.bodies if body.number == number)

    @property
    def free(self) -> tuple[Body, ...]:
        """The blocks that can move."""
        return tuple(body for body in self.bodies if not body.fixed)

    def is_at_feeder(self, number: int) -> bool:
        """Whether a block is where the feeder presents its own, or beyond."""
        return self.pose(number).position[0] < -2 * self.sizes.cell

    def pose(self, number: int) -> Pose:
        """Where a block is now."""
        body = self.body(number)
        if body.fixed:
            return body.pose
        values = self._positions(body).tolist()
        return Pose((values[0], values[1], values[2]), tuple(values[3:7]))

    def place(self, number: int, pose: Pose) -> None:
        """Set a loose block down somewhere, at rest."""
        self._positions(self.body(number))[:] = (*pose.position, *pose.orientation)
        self._velocities(self.body(number))[:] = 0

    def push(self, number: int, velocity: tuple[float, float, float]) -> None:
        """Give a loose block a velocity [m/s]."""
        self._velocities(self.body(number))[:3] = velocity

    def fastest(self, numbers: Iterable[int]) -> float:
        """Greatest speed of a corner among some loose blocks [m/s], from above."""
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
        """All that the future depends on, for the bodies that are there now."""
        values = np.empty(mujoco.mj_stateSize(self.model, _STATE))
        mujoco.mj_getState(self.model, self.data, values, _STATE)
        return values

    def restore(self, bodies: tuple[Body, ...], next_number: int, state: Floats) -> None:
        """Go back to a state.

        Raises:
            ValueError: if the state is none of these bodies; nothing is changed then.
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
        """Make the model of other bodies; those that stay loose go on as they were."""
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
