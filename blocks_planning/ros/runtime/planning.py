"""The action ``plan_tower``: towers are planned in a thread, one at a time, and nothing is built.

Every goal is accepted, so that its client hears why it could not be planned.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from typing import Any

from blocks_planning_msgs.action import PlanTower
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from blocks_planning.errors import BlocksPlanningError, InvalidInput
from blocks_planning.ros.runtime.guarded import GuardedNode
from blocks_planning.ros.wire.conversions.plan import no_plan, plan_to_ros, planned_from_ros
from blocks_planning.search.result import CancelToken
from blocks_planning.search.warming import Kernels
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, WorldState
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

ACTION = 'plan_tower'


class PlanServer:
    """Plans what goals ask for."""

    def __init__(self, node: GuardedNode, kernels: Kernels) -> None:
        """Offer the action; ``kernels`` are those of the node."""
        self._node = node
        self._kernels = kernels
        self._thread = ThreadPoolExecutor(1, 'plan')
        self._cancels: dict[bytes, CancelToken] = {}
        self._server = ActionServer(
            node,
            PlanTower,
            ACTION,
            execute_callback=self._execute,
            goal_callback=lambda _: GoalResponse.ACCEPT,
            cancel_callback=self._cancel,
            callback_group=ReentrantCallbackGroup(),
        )

    def _cancel(self, goal: Any) -> CancelResponse:
        cancel = self._cancels.get(bytes(goal.goal_id.uuid))
        if cancel is not None:
            cancel.cancel()
        return CancelResponse.ACCEPT

    async def _execute(self, goal: Any) -> PlanTower.Result:
        if self._cancels:
            return self._refused(goal, 'another tower is being planned')
        try:
            spec = planned_from_ros(goal.request.trial)
        except InvalidInput as error:
            return self._refused(goal, str(error))
        uuid = bytes(goal.goal_id.uuid)
        cancel = self._cancels[uuid] = CancelToken()
        done: Future = Future()
        self._thread.submit(self._plan, goal, spec, cancel, done)
        try:
            result = await done
        finally:
            del self._cancels[uuid]
        if isinstance(result, str):
            return self._refused(goal, result)
        if result.status is TrialStatus.SUCCESS:
            goal.succeed()
        elif goal.is_cancel_requested:
            goal.canceled()
        else:
            goal.abort()
        return plan_to_ros(result)

    def _refused(self, goal: Any, reason: str) -> PlanTower.Result:
        self._node.refuse('a goal', reason)
        goal.abort()
        return no_plan(reason)

    def _plan(self, goal: Any, spec: TrialSpec, cancel: CancelToken, done: Future) -> None:
        """Plan in the thread; the result is handed to the thread of the node."""
        feedback = PlanTower.Feedback()

        def observe(message: Message) -> None:
            match message:
                case WorldState():
                    feedback.blocks = message.sequence
                case SubgoalChosen():
                    feedback.decisions = len(message.decisions)
                case _:
                    return
            goal.publish_feedback(feedback)

        try:
            self._kernels.prepare(spec.search, spec.task.board)
            result: object = run_trial(spec, cancel, observe)
        except BlocksPlanningError as error:
            result = str(error)
        except BaseException as error:  # noqa: BLE001  raised again in the node's own thread
            failure = error
            self._node.call_soon(lambda: done.set_exception(failure))
            return
        self._node.call_soon(lambda: done.set_result(result))
