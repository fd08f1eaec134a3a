"""The robot: accepts orders, moves step by step, perceives, and can be saved and restored.

::

    robot = Robot(board, RobotSettings(glue=False), seed=7)
    robot.order(Placement(Block(2, 1), column=3))
    while (progress := robot.step()).report is None:
        print(progress.phase)
    print(robot.perceive().placed)
"""

from __future__ import annotations

from collections.abc import Iterable

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput
from blocks_planning.robot import saving
from blocks_planning.robot.behaviour import Behaviour
from blocks_planning.robot.camera import Camera
from blocks_planning.robot.feeder import Feeder
from blocks_planning.robot.fitting import Perceived, fit
from blocks_planning.robot.phases import Progress, Report
from blocks_planning.robot.scene import TIMESTEP, Body, Pose
from blocks_planning.robot.seeing import see_poses
from blocks_planning.robot.settings import CAMERA, RobotSettings
from blocks_planning.robot.simulation import Simulation
from blocks_planning.robot.sizes import Sizes

STEPS_PER_TICK = 5
TICK = STEPS_PER_TICK * TIMESTEP
"""Simulated time of one :meth:`Robot.step` [s]."""
TOLERANCE = 0.25
"""Share of a cell by which a block may deviate without a warning."""
NOISE_TOLERANCE = 3
"""Tolerance of heights, in standard deviations of the noise."""


class Robot:
    """An arm beside an empty board.

    Args:
        board: its size.
        settings: of the robot, its blocks and its noise; None: the defaults.
        seed: of all noise, 0 to 2**64 - 1.

    Raises:
        ConfigurationError: if the camera is selected and this machine cannot render.

    Attributes:
        board: its size.
        settings: as given.
        seed: as given.
        simulation: for pictures, joints and poses.
        seen: the last perception.
    """

    def __init__(self, board: Board, settings: RobotSettings | None = None, seed: int = 0) -> None:
        settings = settings or RobotSettings()
        self.board = board
        self.settings = settings
        self.seed = seed
        self.seen = Perceived()
        self.simulation = Simulation(Sizes.of(board, settings), settings)
        self._behaviour = Behaviour(
            self.simulation, Feeder(self.simulation, seed), NOISE_TOLERANCE * settings.pose_noise_m
        )
        self._camera = Camera(self.simulation) if settings.perception == CAMERA else None
        self._perceptions = 0

    def begin_with(self, blocks: Iterable[Placed]) -> None:
        """Put blocks on the empty board, where they are known to be; with ``glue`` they are fixed.

        Args:
            blocks: supports before what rests on them.
        """
        sizes, known = self.simulation.sizes, list[tuple[int, Placed]]()
        for placed in blocks:
            block, x = (
                Block(placed.width, placed.height),
                sizes.centre(placed.column, placed.width),
            )
            number = self.simulation.add(block, x)
            z = (placed.row + placed.height / 2) * sizes.cell
            self.simulation.place(number, Pose((x, sizes.middle, z)))
            known.append((number, placed))
        if self.settings.glue:
            self.simulation.glue(number for number, _ in known)
        self.seen = Perceived(tuple(known))

    # --- act --------------------------------------------------------------------------------

    def order(self, placement: Placement) -> None:
        """Begin to place a block; :meth:`step` continues.

        The last perception decides whether the block can come to rest on the board.

        Raises:
            InvalidInput: if another order is being carried out.
        """
        if self.is_busy:
            raise InvalidInput(
                'the robot is carrying out another order: wait for its report, or cancel it first'
            )
        landed = rules.drop(self.board, self.seen.built(self.board), placement)
        row = None if landed is None else landed.row
        self._behaviour.begin(placement, row, self._highest())

    def step(self) -> Progress:
        """Simulate ``TICK``; the arm moves if there is an order."""
        report: Report | None = None
        for _ in range(STEPS_PER_TICK):
            report = self._behaviour.step() or report
        progress = self._behaviour.progress
        if report is not None:
            self.simulation.refresh()
        return Progress(progress.phase, progress.fraction, progress.time, report)

    def cancel(self) -> None:
        """Stop the arm. It is at rest in less than 0.2 s; then :meth:`step` returns the report.

        The arm keeps holding its block; the next order brings the block back to the feeder first.
        """
        self._behaviour.cancel()

    def place(self, placement: Placement) -> Report:
        """Carry an order out to its end."""
        self.order(placement)
        while True:
            report = self.step().report
            if report is not None:
                return report

    @property
    def is_busy(self) -> bool:
        """Whether an order is being carried out."""
        return self._behaviour.is_busy

    @property
    def is_moving(self) -> bool:
        """Whether an axis is moving."""
        return not self._behaviour.memory.arm.is_at_rest

    @property
    def held(self) -> int | None:
        """Number of the block between the fingers; None: none."""
        return self._behaviour.memory.number if self._behaviour.is_holding else None

    @property
    def time(self) -> float:
        """Simulated time [s]."""
        return self.simulation.time

    def _highest(self) -> float:
        rows = (placed.row + placed.height for placed in self.seen.placed)
        return max(rows, default=0) * self.settings.cell_m

    # --- perceive ---------------------------------------------------------------------------

    def perceive(self) -> Perceived:
        """Perceive the board; the next order uses this perception."""
        bodies = self._looked_at()
        if self._camera is None:
            spread = self.settings.pose_noise_m
            sightings = see_poses(self.simulation, bodies, spread, self.seed, self._perceptions)
        else:
            sightings = self._camera.see(bodies)
        self._perceptions += 1
        self.seen = fit(self.board, sightings, TOLERANCE)
        return self.seen

    def actual(self) -> Perceived:
        """The board without noise, for a comparison; orders do not use it."""
        sightings = see_poses(self.simulation, self._looked_at(), 0.0, self.seed, 0)
        return fit(self.board, sightings, TOLERANCE)

    def _looked_at(self) -> list[Body]:
        """Every block except those at the feeder and in the fingers."""
        held = self.held
        return [
            body
            for body in self.simulation.bodies
            if body.number != held and not self.simulation.is_at_feeder(body.number)
        ]

    # --- save -------------------------------------------------------------------------------

    def state(self) -> bytes:
        """The complete state, also in the middle of an act."""
        return saving.pack(self.simulation, self._behaviour.memory, self.seen, self._perceptions)

    def restore(self, data: bytes) -> None:
        """Continue from a :meth:`state` of a robot with the same board and settings.

        Raises:
            InvalidInput: if the data are of another robot or damaged; then nothing is changed.
        """
        saved = saving.unpack(self.simulation, data)
        self._behaviour.memory, self.seen, self._perceptions = saved
