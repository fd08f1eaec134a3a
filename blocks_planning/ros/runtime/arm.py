"""An arm that carries out orders: the client of the action ``place``, one order at a time."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from action_msgs.msg import GoalStatus
from blocks_planning_msgs.action import Place
from rclpy.action.client import ActionClient, ClientGoalHandle
from rclpy.task import Future

from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput
from blocks_planning.ros.runtime.guarded import GuardedNode
from blocks_planning.ros.wire.conversions.place import order_to_ros, report_from_ros
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode

ACTION = 'place'
NEWS_PERIOD_S = 0.5
"""Least time between two reports of progress in the same phase [s]."""
ASK_AGAIN_S = 5.0
"""Silence after which a repeated order becomes a goal again: the server may have been restarted
[s]."""


class Arm:
    """Client of the action ``place``; reports the outcome of each order once.

    An order that is repeated during its execution changes nothing, unless the server is silent.
    """

    def __init__(
        self,
        node: GuardedNode,
        stamp: Callable[[Any], Any],
        report: Callable[[ArmReport], None],
        cell_m: float,
    ) -> None:
        """Look for the server.

        Args:
            node: whose client this is.
            stamp: fills in the header of a goal.
            report: is given the reports, in the thread that spins the node.
            cell_m: the side of a cell [m].
        """
        self._node = node
        self._stamp = stamp
        self._report = report
        self._cell_m = cell_m
        self._client = ActionClient(node, Place, ACTION)
        self._order: ArmOrder | None = None
        self._goals: list[ClientGoalHandle] = []
        self._phase = ''
        self._told_s = self._heard_s = 0.0

    def carry_out(self, order: ArmOrder, board: Board) -> None:
        """Begin an order on a board; stop an earlier order that is still running."""
        if not self._client.server_is_ready():
            self.stop()
            self._report(_again(order, f'no node serves the action {ACTION}'))
            return
        now_s = self._node.now_s
        if order != self._order:
            self.stop()
            self._order, self._phase, self._told_s = order, '', 0.0
        elif now_s - self._heard_s < ASK_AGAIN_S:
            return
        self._heard_s = now_s
        goal = self._stamp(order_to_ros(order, self._cell_m))
        sending = self._client.send_goal_async(goal, partial(self._on_feedback, order))
        sending.add_done_callback(partial(self._on_answer, order, board))

    def stop(self) -> None:
        """Stop the arm; its order is not reported any more."""
        self._order = None
        for goal in self._goals:
            goal.cancel_goal_async()
        self._goals.clear()

    def _on_feedback(self, order: ArmOrder, message: Any) -> None:
        phase, progress = message.feedback.phase, message.feedback.progress
        self._heard_s = self._node.now_s
        is_news = phase != self._phase or self._node.now_s - self._told_s >= NEWS_PERIOD_S
        if order == self._order and is_news and 0 <= progress <= 1:
            self._phase, self._told_s = phase, self._node.now_s
            code = PlacementCode.IN_PROGRESS
            self._report(order.report(code, reason=phase, progress=progress))

    def _on_answer(self, order: ArmOrder, board: Board, sent: Future) -> None:
        goal: ClientGoalHandle = sent.result()
        if order != self._order:  # it was stopped meanwhile
            if goal.accepted:
                goal.cancel_goal_async()
        elif goal.accepted:
            self._goals.append(goal)
            goal.get_result_async().add_done_callback(partial(self._on_result, order, board))
        else:
            self._end(_again(order, 'the arm did not accept the order'))

    def _on_result(self, order: ArmOrder, board: Board, got: Future) -> None:
        if order != self._order:
            return
        if got.result().status == GoalStatus.STATUS_UNKNOWN:  # its server was restarted
            self._end(_again(order, 'the arm no longer knows the order'))
            return
        try:
            report = report_from_ros(board, order, got.result().result)
        except InvalidInput as error:
            self._node.refuse(f'a result of {ACTION}', error)
            report = order.report(PlacementCode.FAILED, reason=f'result of the arm: {error}')
        self._end(report)

    def _end(self, report: ArmReport) -> None:
        self._order = None
        self._goals.clear()
        self._report(report)


def _again(order: ArmOrder, reason: str) -> ArmReport:
    return order.report(PlacementCode.TRY_AGAIN, reason=reason)
