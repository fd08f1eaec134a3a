"""The robot in a trial: orders by their numbers, each carried out once, and what was perceived.

After every act the robot's own state is kept in a file, so that a process that was killed continues
with the blocks where they were. An act that was interrupted begins anew.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

from blocks_planning.board.blocks import Block, Placed, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.errors import InvalidInput
from blocks_planning.robot.fitting import Misfit, Perceived, change
from blocks_planning.robot.phases import Progress, Reason, Report
from blocks_planning.robot.robot import Robot
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode
from blocks_planning.worlds.observation import Blocks

_UNCHANGED = {
    None: PlacementCode.LOST,
    Reason.NOTHING_GRASPED: PlacementCode.TRY_AGAIN,
    Reason.COLLISION: PlacementCode.TRY_AGAIN,
    Reason.CANCELLED: PlacementCode.TRY_AGAIN,
    Reason.DROPPED: PlacementCode.LOST,
    Reason.OUT_OF_REACH: PlacementCode.IMPOSSIBLE,
}
"""What became of an order after which the board is as before, by why the act failed."""
_OBSERVED = frozenset(
    [PlacementCode.PLACED, PlacementCode.SLIPPED, PlacementCode.LOST, PlacementCode.COLLAPSED]
)
"""Codes after which the next order refers to another state of the board."""


@dataclass(frozen=True)
class Conditions:
    """What a robot is made for.

    Attributes:
        board: its size.
        settings: of the robot.
        seed: of its noise.
        built: blocks that stand at the start, supports before what rests on them.
    """

    board: Board
    settings: RobotSettings
    seed: int
    built: Blocks = ()

    def robot(self) -> Robot:
        """A robot beside the board of the start."""
        robot = Robot(self.board, self.settings, self.seed)
        robot.begin_with(self.built)
        return robot


class RobotTrial:
    """A robot that builds in one trial.

    Attributes:
        robot: for poses, joints and pictures.
    """

    def __init__(self, trial_id: str, conditions: Conditions, path: Path | None = None) -> None:
        """Begin beside the board of the start, or continue with what is kept.

        Args:
            trial_id: of the trial.
            conditions: board, settings and seed.
            path: of the file in which the state is kept; None: it is not.

        Raises:
            InvalidInput: for a kept state that cannot be used.
            OSError: if a kept state cannot be read.
        """
        self.trial_id = trial_id
        self._conditions = conditions
        self._path = path
        self._order: ArmOrder | None = None
        self._last: ArmReport | None = None
        self.robot = conditions.robot()
        if path is not None and path.exists():
            self._restore(path)

    def take(self, order: ArmOrder) -> ArmReport | None:
        """Begin an order; an order that is being carried out continues.

        Returns:
            the report, if the order was carried out before or cannot be; else None.
        """
        last, placement = self._last, order.placed.placement
        if last is not None and (last.sequence, last.ordered) == (order.sequence, placement):
            return last
        if order == self._order:
            return None
        self.stop()
        if order.sequence == 0 and last is not None:  # the trial has begun anew
            self.robot, self._last = self._conditions.robot(), None
        expected = 0 if self._last is None else self._last.sequence + 1
        if order.sequence != expected:
            return order.report(
                PlacementCode.FAILED,
                reason=f'the order refers to state {order.sequence} of the board, '
                f'but the robot has the board of state {expected}: start the trial again',
            )
        self._order = order
        self.robot.order(placement)
        return None

    def step(self) -> tuple[Progress, ArmReport | None]:
        """Simulate a tick; the report when the act is over and the board was perceived.

        Raises:
            OSError: if the state cannot be kept.
        """
        progress = self.robot.step()
        if progress.report is None or self._order is None:
            return progress, None
        order, self._order = self._order, None
        before = self.robot.seen
        report = report_of(order, progress.report, before, self.robot.perceive())
        if report.code in _OBSERVED:
            self._last = report
            self._keep()
        return progress, report

    def stop(self) -> None:
        """Cancel the order, if there is one, and let the arm come to rest."""
        self._order = None
        if self.robot.is_busy:
            self.robot.cancel()
            while self.robot.is_busy:
                self.robot.step()

    @property
    def is_busy(self) -> bool:
        """Whether an order is being carried out."""
        return self._order is not None

    def forget(self) -> None:
        """Delete the kept state."""
        if self._path is not None:
            self._path.unlink(missing_ok=True)

    def _keep(self) -> None:
        if self._path is None or self._last is None:
            return
        last = self._last
        head = {
            'sequence': last.sequence,
            'code': int(last.code),
            'reason': last.reason,
            'ordered': [*last.ordered.block, last.ordered.column],
            'landed': [list(placed) for placed in last.landed],
            'gone': [list(placed) for placed in last.gone],
        }
        part = self._path.with_suffix('.part')
        part.write_bytes(json.dumps(head).encode() + b'\n' + self.robot.state())
        part.replace(self._path)

    def _restore(self, path: Path) -> None:
        head, _, state = path.read_bytes().partition(b'\n')
        self.robot.restore(state)
        try:
            said = json.loads(head)
            width, height, column = said['ordered']
            self._last = ArmReport(
                self.trial_id,
                said['sequence'],
                Placement(Block(width, height), column),
                PlacementCode(said['code']),
                tuple(Placed(*block) for block in said['landed']),
                tuple(Placed(*block) for block in said['gone']),
                said['reason'],
            )
        except (ValueError, KeyError, TypeError) as error:
            raise InvalidInput(f'{path}: its first line is damaged ({error}): delete it') from None


def report_of(order: ArmOrder, act: Report, before: Perceived, after: Perceived) -> ArmReport:
    """What became of an order, by what was perceived before and after it.

    Args:
        order: which block was to come to rest where.
        act: what the arm did.
        before: the board before the act.
        after: the board after it.
    """
    changed = change(before, after)
    landed, gone = _from_below(changed.landed), _from_below(changed.gone)
    said = order.report(PlacementCode.PLACED, landed=landed, gone=gone, reason=act.text)
    if not after.is_possible:
        fallen = [one.text for one in after.warnings if one.kind is Misfit.IMPOSSIBLE]
        return replace(said, code=PlacementCode.COLLAPSED, reason='; '.join(fallen))
    if (landed, gone) == ((order.placed,), ()):
        return said
    if landed or gone:
        code = PlacementCode.SLIPPED if landed else PlacementCode.LOST
        reason = act.text or '; '.join(one.text for one in after.warnings)
        return replace(said, code=code, reason=reason)
    return replace(said, code=_UNCHANGED[act.reason])


def _from_below(blocks: Iterable[Placed]) -> Blocks:
    """Supports before what rests on them."""
    return tuple(sorted(blocks, key=lambda placed: (placed.row, placed.column)))
