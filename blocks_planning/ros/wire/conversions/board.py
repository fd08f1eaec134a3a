"""The board: states, actions and what became of them."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros

from blocks_planning.board.blocks import Placement
from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import (
    block_from_ros,
    grid_to_ros,
    mask_on,
    placed_from_ros,
    placed_to_ros,
    way_from_ros,
)
from blocks_planning.ros.wire.conversions.fields import refuse, word
from blocks_planning.trials.messages import PlaceBlock, PlacementOutcome, WorldState
from blocks_planning.trials.status import TrialStatus

_STATE_REASONS = {
    TrialStatus.BUILDING: 'some legal placement is left',
    TrialStatus.SUCCESS: 'the filled cells are the silhouette',
    TrialStatus.STUCK: 'no legal placement is left',
}


def state_to_ros(board: Board, message: WorldState) -> ros.WorldState:
    """See :class:`WorldState`."""
    return ros.WorldState(
        trial_id=message.trial_id,
        sequence=message.sequence,
        built=grid_to_ros(board, message.built),
        placements=[placed_to_ros(placed) for placed in message.placements],
        status=message.status.value,
        reason=_STATE_REASONS[message.status],
    )


def state_from_ros(board: Board, message: ros.WorldState) -> WorldState:
    """See :class:`WorldState`."""
    placements, built = way_from_ros(board, 0, message.placements, 'placements')
    if message.sequence != len(placements):
        raise refuse('sequence', message.sequence, f'the number of placements, {len(placements)}')
    if mask_on(board, message.built, 'built') != built:
        raise refuse('built', 'other cells', 'the cells that the placements fill')
    status = word(TrialStatus, message.status, 'status', [s.value for s in _STATE_REASONS])
    return WorldState(message.trial_id, message.sequence, built, placements, status)


def action_to_ros(board: Board, message: PlaceBlock) -> ros.PlaceBlock:
    """See :class:`PlaceBlock`."""
    (width, height), column = message.placement
    return ros.PlaceBlock(
        trial_id=message.trial_id,
        sequence=message.sequence,
        block=ros.Block(width=width, height=height),
        column=column,
    )


def action_from_ros(board: Board, message: ros.PlaceBlock) -> PlaceBlock:
    """See :class:`PlaceBlock`. Whether the placement is possible is for the world to say."""
    block = block_from_ros(message.block, 'block')
    return PlaceBlock(message.trial_id, message.sequence, Placement(block, message.column))


def placement_outcome_to_ros(board: Board, message: PlacementOutcome) -> ros.PlacementOutcome:
    """See :class:`PlacementOutcome`."""
    kind, placed = ros.PlacementOutcome, message.placed
    refused = kind.STATUS_FAILED if message.failed else kind.STATUS_IMPOSSIBLE
    return kind(
        trial_id=message.trial_id,
        sequence=message.sequence,
        status=refused if placed is None else kind.STATUS_PLACED,
        reason=message.reason or 'the block rests where it fell',
        placed=ros.Placement() if placed is None else placed_to_ros(placed),
    )


def placement_outcome_from_ros(board: Board, message: ros.PlacementOutcome) -> PlacementOutcome:
    """See :class:`PlacementOutcome`."""
    kind = ros.PlacementOutcome
    statuses = (kind.STATUS_PLACED, kind.STATUS_IMPOSSIBLE, kind.STATUS_FAILED)
    status = word(str, message.status, 'status', statuses)
    if status != kind.STATUS_PLACED:
        failed = status == kind.STATUS_FAILED
        return PlacementOutcome(message.trial_id, message.sequence, None, message.reason, failed)
    placed = placed_from_ros(board, message.placed, 'placed')
    return PlacementOutcome(message.trial_id, message.sequence, placed)
