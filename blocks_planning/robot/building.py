"""A whole trial in one process: planners decide from what the robot perceives after each act."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from blocks_planning.robot.driving import Score, score
from blocks_planning.robot.phases import Reason
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.trial import Conditions, RobotTrial
from blocks_planning.trials.local import LocalTrial
from blocks_planning.trials.messages import (
    ArmOrder,
    ArmReport,
    CancelTrial,
    Message,
    PlacementCode,
    TrialStarted,
)
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec

RETRIES = 10
"""How often an order is given again that the robot did not carry out."""
_NOT_DONE = (PlacementCode.TRY_AGAIN, PlacementCode.IMPOSSIBLE)


@dataclass
class Building:
    """A trial that a robot builds.

    Attributes:
        trial: the planners, and their record.
        robot: the robot.
        codes: number of acts by outcome.
        reasons: number of acts that failed by reason.
    """

    trial: LocalTrial
    robot: RobotTrial
    codes: Counter[PlacementCode] = field(default_factory=Counter)
    reasons: Counter[Reason] = field(default_factory=Counter)

    @property
    def record(self) -> TrialRecord:
        """The record of the trial."""
        return self.trial.record()

    @property
    def score(self) -> Score:
        """Agreement of the silhouette with the blocks as they are, not as they are perceived."""
        task = self.trial.spec.task
        return score(task.silhouette, self.robot.robot.actual().built(task.board))

    def act(self, order: ArmOrder) -> ArmReport:
        """Carry out an order."""
        report = self.robot.take(order)
        while report is None:
            progress, report = self.robot.step()
            if report is not None and progress.report is not None and progress.report.reason:
                self.reasons[progress.report.reason] += 1
        self.codes[report.code] += 1
        return report


def build(spec: TrialSpec, settings: RobotSettings) -> Building:
    """Let a robot build a tower, until the trial ends.

    As in the graph, an order that was not carried out is given again, at most :data:`RETRIES`
    times; then the trial is cancelled with the reason of the last attempt.

    Args:
        spec: the trial; its world must be ``observed``.
        settings: of the robot; the seed of its noise is that of the trial.
    """
    orders: list[ArmOrder] = []

    def note(message: Message) -> None:
        if isinstance(message, ArmOrder):
            orders.append(message)

    conditions = Conditions(spec.task.board, settings, spec.seed, spec.built)
    building = Building(LocalTrial(spec, observe=note), RobotTrial(spec.trial_id, conditions))
    building.trial.say(TrialStarted(spec.trial_id, spec))
    while orders:
        building.trial.say(_end_of(building, orders.pop()))
    return building


def _end_of(building: Building, order: ArmOrder) -> Message:
    """What the robot has done at last, or that the trial cannot go on."""
    for _ in range(1 + RETRIES):
        report = building.act(order)
        if report.code not in _NOT_DONE:
            break
    else:
        reason = f'the order was given {1 + RETRIES} times: {report.reason}'
        return CancelTrial(order.trial_id, reason)
    if report.code is PlacementCode.FAILED:
        return CancelTrial(order.trial_id, report.reason)
    return report
