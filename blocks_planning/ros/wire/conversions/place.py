"""The action ``place``: orders for an arm, in metres, and what it reports."""

from __future__ import annotations

from blocks_planning_msgs.action import Place
from geometry_msgs.msg import Point, Pose, Vector3

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import blocks_from_ros, placed_to_ros
from blocks_planning.ros.wire.conversions.fields import refuse
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode

_ENDS = [code for code in PlacementCode if code is not PlacementCode.IN_PROGRESS]


def order_to_ros(order: ArmOrder, cell_m: float) -> Place.Goal:
    """An order as a goal.

    Args:
        order: the order.
        cell_m: the side of a cell [m].
    """
    placed = order.placed
    width, height = placed.width * cell_m, placed.height * cell_m
    left, bottom = placed.column * cell_m, placed.row * cell_m
    centre = Point(x=left + width / 2, y=cell_m / 2, z=bottom + height / 2)
    return Place.Goal(
        trial_id=order.trial_id,
        sequence=order.sequence,
        placement=placed_to_ros(placed),
        cell_size=cell_m,
        pose=Pose(position=centre),
        size=Vector3(x=width, y=cell_m, z=height),
    )


def order_from_ros(board: Board, goal: Place.Goal) -> ArmOrder:
    """An order for an arm; :func:`order_to_ros` makes goals of orders.

    Raises:
        MessageError: for a block that would not be on the board.
    """
    (placed,) = blocks_from_ros(board, [goal.placement], 'placement')
    return ArmOrder(goal.trial_id, goal.sequence, placed)


def report_to_ros(report: ArmReport) -> Place.Result:
    """What became of an order, as the result of a goal."""
    return Place.Result(
        code=int(report.code),
        reason=report.reason,
        landed=list(map(placed_to_ros, report.landed)),
        gone=list(map(placed_to_ros, report.gone)),
    )


def report_from_ros(board: Board, order: ArmOrder, result: Place.Result) -> ArmReport:
    """What became of an order.

    Raises:
        MessageError: for a result that cannot be.
    """
    if result.code not in _ENDS:
        raise refuse('code', result.code, f'a code from 1 to {max(_ENDS).value}')
    return order.report(
        PlacementCode(result.code),
        landed=blocks_from_ros(board, result.landed, 'landed'),
        gone=blocks_from_ros(board, result.gone, 'gone'),
        reason=result.reason,
    )
