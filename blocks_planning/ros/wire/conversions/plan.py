"""The action ``plan_tower``: a trial that is only planned."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros
from blocks_planning_msgs.action import PlanTower

from blocks_planning.ros.wire.conversions.cells import blocks_to_ros
from blocks_planning.ros.wire.conversions.decisions import decision_to_ros
from blocks_planning.ros.wire.conversions.fields import MessageError
from blocks_planning.ros.wire.conversions.trial import ended_to_ros, spec_from_ros
from blocks_planning.trials.messages import TrialEnded
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.world import Simulated

_COSTS = ('action_planning_cost', 'subgoal_planning_cost', 'solution_cost')


def planned_from_ros(message: ros.TrialSpec) -> TrialSpec:
    """The trial to plan, in a world that obeys.

    Raises:
        MessageError: if it cannot be planned.
    """
    message.planner.world, message.planner.world_settings = Simulated.name, []
    spec = spec_from_ros(message)
    if spec.strategy.asks_person:
        raise MessageError(
            f'planner.strategy: {spec.strategy.name} asks a person, but plan_tower asks nobody; '
            'use a strategy that decides by itself'
        )
    return spec


def plan_to_ros(record: TrialRecord) -> PlanTower.Result:
    """The result for a planned trial."""
    ended = ended_to_ros(None, TrialEnded('', record.status, record.reason, record))
    board = record.spec.task.board
    return PlanTower.Result(
        code=ended.code,
        reason=ended.reason,
        placements=blocks_to_ros(
            placed for seen in record.observations[1:] for placed in seen.landed
        ),
        decisions=[decision_to_ros(board, entry) for entry in record.decisions],
        **{name: getattr(ended, name) for name in _COSTS},
    )


def no_plan(reason: str) -> PlanTower.Result:
    """The result of a goal that could not be planned."""
    return PlanTower.Result(code=ros.TrialOutcome.CODE_REFUSED, reason=reason)
