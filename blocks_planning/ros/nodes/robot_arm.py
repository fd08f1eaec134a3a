"""Node ``robot_arm``: a simulated robot that carries out orders and perceives the board.

It serves the action ``place`` beside the node ``world``, in trials of world `observed`. The driver
of a real arm can replace this node without other changes. See docs/robot.md for the robot, its
phases and what it perceives. With a ``state_dir`` a robot that was killed and restarted has its
blocks where they were, and begins the interrupted act again.

| | |
|---|---|
| subscribes | `trial`, `outcome` (latched) |
| shows | `joint_states`; `robot/markers` (latched); `/tf`, where tf2_msgs is installed; `/clock`, with `publish_clock`; `camera/image_raw` and `camera/camera_info`, with a `camera_period_s` |
| serves | action `place` |
| parameters | `remind_period_s`; `frame_id`; `state_dir`: folder of the robot's state; `speed`: simulated seconds per second, 0 for as fast as possible; `camera_period_s`: least time between two pictures, 0 for none; `publish_clock`: whether simulated time is published; `glue`; `perception`; `pose_noise_m`; `grip_noise_m`; `cell_m`; `gap_m`; `density`; `friction`; `grip_force_n`: as in docs/robot.md |
"""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from blocks_planning_msgs.action import Place
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from blocks_planning.errors import BlocksPlanningError, ConfigurationError, InvalidInput
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.ros.runtime.acts import Act
from blocks_planning.ros.runtime.arm import ACTION
from blocks_planning.ros.runtime.journal import file_name
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.runtime.showing import Shower
from blocks_planning.ros.wire.conversions.place import order_from_ros, report_to_ros
from blocks_planning.ros.wire.graph import ROBOT_ARM
from blocks_planning.settings import all_settings
from blocks_planning.trials.messages import (
    ArmReport,
    Message,
    PlacementCode,
    TrialEnded,
    TrialStarted,
)

if TYPE_CHECKING:
    from blocks_planning.robot.trial import RobotTrial

STATE_DIR = Parameter('state_dir', '', 'Folder of the state of the robot; none: it is not kept.')
SPEED = Parameter(
    'speed', 0.0, 'Simulated seconds per second; 0: as fast as possible.', (0.0, 1000.0)
)
CAMERA_PERIOD = Parameter(
    'camera_period_s', 0.0, 'Least time between two pictures [s]; 0: none.', (0.0, 3600.0)
)
PUBLISH_CLOCK = Parameter('publish_clock', False, 'Publish simulated time on /clock.')
SETTINGS = tuple(
    Parameter(
        one.name,
        one.default,
        one.text,
        None if one.least is None or one.most is None else (one.least, one.most),
    )
    for one in all_settings(RobotSettings)
)
SUFFIX = '.robot'
TICK_S = 0.001
"""Least time between two turns of the simulation [s]."""
TURN_S = 0.02
"""Longest turn of the simulation: after it, messages and cancels are handled [s]."""
CELL_TOLERANCE_M = 1e-6


class _Attending:
    """A part that sends nothing; its memory is the running trial, or None."""

    Memory: Any = staticmethod(lambda: None)

    def step(
        self, memory: TrialStarted | None, message: Message
    ) -> tuple[TrialStarted | None, tuple[Message, ...]]:
        """Note which trial runs."""
        if isinstance(message, TrialStarted):
            return message, ()
        is_over = isinstance(message, TrialEnded) and memory is not None
        if is_over and memory.trial_id == message.trial_id:  # type: ignore[union-attr]
            return None, ()
        return memory, ()


class RobotArm(PartNode):
    """A robot for the trial that runs."""

    def __init__(self, **options: Any) -> None:
        """See :class:`PartNode`.

        Raises:
            ConfigurationError: for settings that the robot cannot have.
        """
        parameters = (STATE_DIR, SPEED, CAMERA_PERIOD, PUBLISH_CLOCK, *SETTINGS)
        super().__init__(ROBOT_ARM, _Attending(), parameters, **options)
        try:
            self._settings = RobotSettings(**{one.name: self.values[one.name] for one in SETTINGS})
        except ConfigurationError as error:
            raise ConfigurationError(f'node {self.get_name()}: {error}') from None
        self._folder = Path(self.values['state_dir']) if self.values['state_dir'] else None
        if self._folder is not None:
            try:
                self._folder.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise ConfigurationError(
                    f'node {self.get_name()}: parameter state_dir: {self._folder} cannot be made: '
                    f'{error.strerror}'
                ) from None
        self.robot: RobotTrial | None = None
        self._act: Act | None = None
        self._placed = 0
        self._shower = Shower(
            self,
            self.values['frame_id'],
            self.values['camera_period_s'],
            has_clock=self.values['publish_clock'],
        )
        self._turns = self.create_timer(TICK_S, self._turn, clock=self.steady)
        self._turns.cancel()
        self._server = ActionServer(
            self,
            Place,
            ACTION,
            execute_callback=self._execute,
            goal_callback=lambda _: GoalResponse.ACCEPT,
            cancel_callback=self._cancel,
            callback_group=ReentrantCallbackGroup(),
        )

    # --- trials -----------------------------------------------------------------------------

    def advance(self, message: Message) -> tuple[Message, ...]:
        """See :class:`PartNode`; a trial whose world needs an arm gets a robot until it ends."""
        before = self.memory
        said = super().advance(message)
        if self.memory is before:
            return said
        if before is not None and (self.memory is None or self.memory.trial_id != before.trial_id):
            self._leave()
        trial = self.memory
        if trial is not None and self.robot is None and not trial.spec.world.simulates:
            self.robot = self._robot_for(trial)
            self._shower.show(self.robot.robot, self.now_s)
        return said

    def _robot_for(self, trial: TrialStarted) -> RobotTrial:
        from blocks_planning.robot.trial import Conditions, RobotTrial

        spec = trial.spec
        conditions = Conditions(spec.task.board, self._settings, spec.seed, spec.built)
        path = self._folder / (file_name(trial.trial_id) + SUFFIX) if self._folder else None
        try:
            return RobotTrial(trial.trial_id, conditions, path)
        except (InvalidInput, OSError) as error:
            self.get_logger().warning(f'{error}; the robot begins anew')
            return RobotTrial(trial.trial_id, conditions)

    def _leave(self) -> None:
        self._end_act('the trial is over')
        if self.robot is not None:
            self.robot.stop()
            self.robot.forget()
            self.robot = None

    @property
    def is_busy(self) -> bool:
        """See :class:`PartNode`."""
        return self.memory is not None

    def load(self) -> dict[str, object]:
        """See :class:`PartNode`."""
        phase = None if self._act is None else self._act.phase
        return {'orders_carried_out': self._placed, 'phase': '' if phase is None else phase.value}

    # --- orders -----------------------------------------------------------------------------

    async def _execute(self, goal: Any) -> Place.Result:
        result = self._begin(goal)
        if isinstance(result, Future):
            result = report_to_ros(await result)
        if goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.succeed()
        return result

    def _begin(self, goal: Any) -> Place.Result | Future:
        """The result of an order, or a future of its report."""
        request, robot = goal.request, self.robot
        if robot is None or self.memory.trial_id != request.trial_id:
            reason = f'no trial {request.trial_id} of world observed is announced on topic trial'
            return Place.Result(code=int(PlacementCode.TRY_AGAIN), reason=reason)
        try:
            order = order_from_ros(self.board, request)
            self._check(request)
        except InvalidInput as error:
            self.refuse(f'a goal of {ACTION}', error)
            return Place.Result(code=int(PlacementCode.FAILED), reason=str(error))
        report = robot.take(order)
        if report is not None:
            return report_to_ros(report)
        if self._act is None or self._act.order != order:
            self._end_act('another order was given')
            self._act = Act(order, self.now_s, robot.robot.time)
            self._turns.reset()
        return self._act.ask(goal)

    def _check(self, request: Place.Goal) -> None:
        """Raise InvalidInput if an order does not fit this robot."""
        if abs(request.cell_size - self._settings.cell_m) > CELL_TOLERANCE_M:
            raise InvalidInput(
                f'the order is for cells of {request.cell_size} m, those of the robot have '
                f'{self._settings.cell_m} m: set cell_size of world, or cell_m of robot_arm'
            )

    def _cancel(self, goal: Any) -> CancelResponse:
        act = self._act
        if act is not None and act.leave(goal, 'the goal was cancelled') and not act.is_wanted:
            self._end_act('')
            if self.robot is not None:
                self.robot.stop()
        return CancelResponse.ACCEPT

    def _end_act(self, reason: str) -> None:
        act, self._act = self._act, None
        self._turns.cancel()
        if act is not None:
            act.cancel(reason)

    # --- the simulation ---------------------------------------------------------------------

    def _turn(self) -> None:
        """Simulate for a short time."""
        act, robot = self._act, self.robot
        if act is None or robot is None:
            self._turns.cancel()
            return
        began_s = self.now_s
        while self.now_s - began_s < TURN_S and not self._is_ahead(act, robot):
            try:
                progress, report = robot.step()
            except (BlocksPlanningError, OSError) as error:
                self.get_logger().error(f'the state of the robot cannot be kept: {error}')
                report = act.order.report(PlacementCode.FAILED, reason=str(error))
            if report is not None:
                self._finish(act, report)
                break
            act.tell(progress, self.now_s)
        self._shower.show(robot.robot, self.now_s)

    def _is_ahead(self, act: Act, robot: RobotTrial) -> bool:
        """Whether the simulation has to wait for the clock."""
        speed = self.values['speed']
        gone_s = self.now_s - act.began_s
        return bool(speed) and robot.robot.time - act.robot_s >= speed * gone_s

    def _finish(self, act: Act, report: ArmReport) -> None:
        self._act = None
        self._placed += 1
        self._turns.cancel()
        act.end(report)


def make_node(**options: Any) -> RobotArm:
    """The node, not yet spinning.

    Raises:
        MissingExtra: if the simulation is not installed.
    """
    import_module('blocks_planning.robot.trial')
    return RobotArm(**options)


def main() -> None:
    """Run the node until SIGINT or SIGTERM."""
    run(lambda _: make_node())


if __name__ == '__main__':
    main()
