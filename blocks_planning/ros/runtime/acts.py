"""An order that an arm is carrying out, and the goals of ``place`` that ask for it."""

from __future__ import annotations

from typing import Any

from blocks_planning_msgs.action import Place
from rclpy.task import Future

from blocks_planning.robot.phases import Phase, Progress
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode

NEWS_PERIOD_S = 0.2
"""Least time between two reports of progress in the same phase [s]."""


class Act:
    """An order that is being carried out.

    Args:
        order: the order.
        began_s: when, by the steady clock [s].
        robot_s: simulated time when it began [s].
    """

    def __init__(self, order: ArmOrder, began_s: float, robot_s: float) -> None:
        self.order = order
        self.began_s = began_s
        self.robot_s = robot_s
        self.phase: Phase | None = None
        self._told_s = 0.0
        self._asked: dict[bytes, tuple[Any, Future]] = {}

    @property
    def is_wanted(self) -> bool:
        """Whether a goal still asks for it."""
        return bool(self._asked)

    def ask(self, goal: Any) -> Future:
        """A future of the report, for one more goal."""
        future: Future = Future()
        self._asked[_id_of(goal)] = goal, future
        return future

    def leave(self, goal: Any, reason: str) -> bool:
        """Report to one goal that it was cancelled; whether it had asked."""
        _, future = self._asked.pop(_id_of(goal), (None, None))
        if future is not None:
            future.set_result(self._cancelled(reason))
        return future is not None

    def tell(self, progress: Progress, now_s: float) -> None:
        """Give every goal feedback, if the phase is new or some time has passed."""
        if progress.phase is self.phase and now_s - self._told_s < NEWS_PERIOD_S:
            return
        self.phase, self._told_s = progress.phase, now_s
        said = Place.Feedback(phase=progress.phase.value, progress=progress.fraction)
        for goal, _ in self._asked.values():
            goal.publish_feedback(said)

    def end(self, report: ArmReport) -> None:
        """Report to every goal."""
        for _, future in self._asked.values():
            future.set_result(report)
        self._asked.clear()

    def cancel(self, reason: str) -> None:
        """Report to every goal that the order was not carried out."""
        self.end(self._cancelled(reason))

    def _cancelled(self, reason: str) -> ArmReport:
        return self.order.report(PlacementCode.TRY_AGAIN, reason=reason)


def _id_of(goal: Any) -> bytes:
    return bytes(goal.goal_id.uuid)
