"""The action ``run_trial``: one goal at a time, with feedback, a result and a way to cancel.

Every goal is accepted, so that its client receives a reason if the trial cannot start: such a goal
is aborted at once, with the reason in its outcome.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from blocks_planning_msgs.action import RunTrial
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from blocks_planning.errors import InvalidInput
from blocks_planning.ros.wire.conversions.trial import refusal, spec_from_ros
from blocks_planning.trials.spec import TrialSpec

ACTION = 'run_trial'


class Runner(Protocol):
    """A node that runs the trials of goals."""

    def start_trial(self, trial_id: str, spec: TrialSpec) -> None:
        """Announce a trial, and record it."""
        ...

    def cancel_trial(self) -> None:
        """End the running trial, if there is one."""
        ...

    def refuse(self, what: str, reason: object) -> None:
        """Count and report an invalid message or goal."""
        ...

    def stamped(self, message: Any) -> Any:
        """A message with its headers filled in."""
        ...


class GoalServer:
    """Runs the trials of goals on a node that is a :class:`Runner`."""

    def __init__(self, runner: Any, is_open: Callable[[], bool]) -> None:
        """Offer the action.

        Args:
            runner: the node.
            is_open: whether trials of goals may be run now.
        """
        self._runner: Runner = runner
        self._is_open = is_open
        self._goal: Any = None
        self._done: Future | None = None
        self._judged: dict[bytes, TrialSpec | str] = {}
        self._server = ActionServer(
            runner,
            RunTrial,
            ACTION,
            execute_callback=self._execute,
            goal_callback=lambda _: GoalResponse.ACCEPT,
            cancel_callback=self._cancel,
            handle_accepted_callback=self._accept,
            callback_group=ReentrantCallbackGroup(),
        )

    @property
    def is_busy(self) -> bool:
        """Whether the trial of a goal is running."""
        return self._done is not None

    @property
    def is_heard(self) -> bool:
        """Whether a client receives feedback."""
        return self._goal is not None

    def tell(self, feedback: RunTrial.Feedback) -> None:
        """Send feedback to the client."""
        self._goal.publish_feedback(feedback)

    def end(self, outcome: Any) -> bool:
        """End the running goal with an outcome; return whether there was one."""
        if self._done is None:
            return False
        self._done.set_result(outcome)
        return True

    def _accept(self, goal: Any) -> None:
        """Check a goal, and start it if no trial is running."""
        judged = self._judge(goal.request.trial)
        self._judged[bytes(goal.goal_id.uuid)] = judged
        if not isinstance(judged, str):
            self._done = Future()
        goal.execute()

    def _judge(self, message: Any) -> TrialSpec | str:
        """The trial of a goal, or why it cannot be run."""
        if self.is_busy or not self._is_open():
            return 'a trial is running'
        try:
            return spec_from_ros(message)
        except InvalidInput as error:
            return str(error)

    def _cancel(self, goal: Any) -> CancelResponse:
        """End the trial of the goal, if it has begun; else :meth:`_execute` does."""
        if self._goal is goal:
            self._runner.cancel_trial()
        return CancelResponse.ACCEPT

    async def _execute(self, goal: Any) -> RunTrial.Result:
        """Run the trial of a goal to its end."""
        uuid = bytes(goal.goal_id.uuid)
        spec = self._judged.pop(uuid)
        if isinstance(spec, str):
            self._runner.refuse('a goal', spec)
            goal.abort()
            return RunTrial.Result(outcome=self._runner.stamped(refusal(spec)))
        self._goal, done = goal, self._done
        assert done is not None
        self._runner.start_trial(f'{spec.trial_id}-{uuid.hex()[:8]}', spec)
        if goal.is_cancel_requested:
            self._runner.cancel_trial()
        outcome = await done
        self._goal, self._done = None, None
        if outcome.code == outcome.CODE_SUCCESS:
            goal.succeed()
        elif outcome.code == outcome.CODE_CANCELLED and goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return RunTrial.Result(outcome=outcome)
