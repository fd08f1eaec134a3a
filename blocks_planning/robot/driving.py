"""Building a whole tower in one process: orders, each followed by a perception."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, Placement
from blocks_planning.board.geometry import Mask, area
from blocks_planning.robot.fitting import Change, Perceived, change
from blocks_planning.robot.phases import Progress, Report
from blocks_planning.robot.robot import Robot


@dataclass(frozen=True)
class Act:
    """An order, its report, and the perception after it.

    Attributes:
        report: of the arm.
        seen: the perceived state of the board.
        change: from the previous state to this one.
        expected: where the block should have come to rest in the previous state; None:
            nowhere.
    """

    report: Report
    seen: Perceived
    change: Change
    expected: Placed | None

    @property
    def is_surprise(self) -> bool:
        """Whether the result differs from the order."""
        wanted = () if self.expected is None else (self.expected,)
        return self.change != Change(wanted, ())


@dataclass(frozen=True)
class Score:
    """Agreement of the filled cells with a silhouette, each number 0 to 1."""

    recall: float
    precision: float
    f1: float
    is_perfect: bool


def carry_out(
    robot: Robot, placement: Placement, watch: Callable[[Progress], None] | None = None
) -> Act:
    """Carry out one order and perceive the board.

    Args:
        robot: must not be busy.
        placement: the order.
        watch: called with the progress after every step.
    """
    before = robot.seen
    expected = rules.drop(robot.board, before.built(robot.board), placement)
    robot.order(placement)
    while True:
        progress = robot.step()
        if watch is not None:
            watch(progress)
        if progress.report is not None:
            seen = robot.perceive()
            return Act(progress.report, seen, change(before, seen), expected)


def carry_out_all(
    robot: Robot,
    placements: Iterable[Placement],
    watch: Callable[[Progress], None] | None = None,
) -> list[Act]:
    """Carry out orders one after the other, regardless of failures."""
    return [carry_out(robot, placement, watch) for placement in placements]


def score(silhouette: Mask, built: Mask) -> Score:
    """Compare filled cells with target cells."""
    both = area(silhouette & built)
    recall = both / area(silhouette) if silhouette else 1.0
    precision = both / area(built) if built else 1.0
    total = area(silhouette) + area(built)
    return Score(recall, precision, 2 * both / total if total else 1.0, built == silhouette)
