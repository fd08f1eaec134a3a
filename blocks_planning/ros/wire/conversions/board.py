"""The board: states, orders and their outcomes."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

from blocks_planning_msgs import msg as ros

from blocks_planning.board.blocks import Placement
from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import (
    block_from_ros,
    block_to_ros,
    blocks_from_ros,
    blocks_to_ros,
    grid_to_ros,
    mask_on,
    placed_from_ros,
    placed_to_ros,
)
from blocks_planning.ros.wire.conversions.fields import (
    MOST_OBSERVATIONS,
    MessageError,
    bounded,
    refuse,
    word,
)
from blocks_planning.trials.messages import (
    PLACEMENT_REASONS,
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    WorldState,
)
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import (
    Blocks,
    Observation,
    Observations,
    blocks_after,
    mask_of,
    wrong_change,
)

_OF_THE_TRIAL = ('gave_up', 'cancelled')
_STATE_STATUSES = [status.value for status in TrialStatus if status.value not in _OF_THE_TRIAL]
STATE_REASONS = {
    'building': 'some legal placement is left',
    'success': 'the filled cells are the silhouette',
    'stuck': 'no legal placement is left',
    'collapsed': 'the tower fell',
}
_LANDS = (PlacementCode.PLACED, PlacementCode.SLIPPED)
_MAY_LAND = (*_LANDS, PlacementCode.COLLAPSED)


def state_to_ros(board: Board, message: WorldState) -> ros.WorldState:
    """See :class:`WorldState`."""
    return ros.WorldState(
        trial_id=message.trial_id,
        sequence=message.sequence,
        built=grid_to_ros(board, message.built),
        placements=blocks_to_ros(message.placements),
        observations=[observation_to_ros(seen) for seen in message.observations],
        status=message.status.value,
        reason=STATE_REASONS.get(message.status.value, message.status.value),
    )


def state_from_ros(board: Board, message: ros.WorldState) -> WorldState:
    """See :class:`WorldState`."""
    observations, blocks = _history_from_ros(board, message.observations)
    if message.sequence != len(observations) - 1:
        expected = f'the number of observations less one, {len(observations) - 1}'
        raise refuse('sequence', message.sequence, expected)
    if blocks_from_ros(board, message.placements, 'placements') != blocks:
        raise refuse('placements', 'others', 'the blocks that stand after all observations')
    status = word(TrialStatus, message.status, 'status', _STATE_STATUSES)
    built = mask_of(board, blocks)
    if mask_on(board, message.built, 'built') != built:
        raise refuse('built', 'other cells', 'the cells that the placements fill')
    return WorldState(message.trial_id, observations, blocks, built, status)


def _history_from_ros(
    board: Board, messages: Sequence[ros.Observation]
) -> tuple[Observations, Blocks]:
    """The observations of a trial, and the blocks that stand after them."""
    bounded(messages, 'observations', 1, MOST_OBSERVATIONS)
    blocks: Blocks = ()
    observations = []
    for index, message in enumerate(messages):
        seen = observation_from_ros(board, message, f'observations[{index}]')
        wrong = wrong_change(blocks, seen)
        if wrong:
            raise MessageError(f'observations[{index}].gone: {wrong}')
        blocks = blocks_after(blocks, seen)
        observations.append(seen)
    return tuple(observations), blocks


@lru_cache(maxsize=4096)  # every later state has it too
def observation_to_ros(seen: Observation) -> ros.Observation:
    """See :class:`Observation`; the message is kept, and must not be changed."""
    message = ros.Observation(
        landed=blocks_to_ros(seen.landed),
        gone=blocks_to_ros(seen.gone),
    )
    if seen.ordered is not None:
        message.has_order = True
        message.ordered_block = block_to_ros(seen.ordered.block)
        message.ordered_column = seen.ordered.column
    return message


def observation_from_ros(board: Board, message: ros.Observation, field: str) -> Observation:
    """See :class:`Observation`."""
    ordered = None
    if message.has_order:
        block = block_from_ros(message.ordered_block, f'{field}.ordered_block')
        ordered = Placement(block, message.ordered_column)
    return Observation(
        ordered,
        blocks_from_ros(board, message.landed, f'{field}.landed'),
        blocks_from_ros(board, message.gone, f'{field}.gone'),
    )


def action_to_ros(board: Board, message: PlaceBlock) -> ros.PlaceBlock:
    """See :class:`PlaceBlock`."""
    block, column = message.placement
    return ros.PlaceBlock(
        trial_id=message.trial_id,
        sequence=message.sequence,
        block=block_to_ros(block),
        column=column,
    )


def action_from_ros(board: Board, message: ros.PlaceBlock) -> PlaceBlock:
    """See :class:`PlaceBlock`. The world decides whether the placement is possible."""
    block = block_from_ros(message.block, 'block')
    return PlaceBlock(message.trial_id, message.sequence, Placement(block, message.column))


def placement_outcome_to_ros(board: Board, message: PlacementOutcome) -> ros.PlacementOutcome:
    """See :class:`PlacementOutcome`."""
    placed = message.placed
    return ros.PlacementOutcome(
        trial_id=message.trial_id,
        sequence=message.sequence,
        code=message.code.value,
        reason=message.sentence,
        progress=message.progress,
        placed=ros.Placement() if placed is None else placed_to_ros(placed),
    )


def placement_outcome_from_ros(board: Board, message: ros.PlacementOutcome) -> PlacementOutcome:
    """See :class:`PlacementOutcome`."""
    if message.code not in list(PlacementCode):
        codes = f'a code from 1 to {max(PlacementCode).value}'
        raise refuse('code', message.code, codes)
    code = PlacementCode(message.code)
    if not 0 <= message.progress <= 1:
        raise refuse('progress', message.progress, 'a number from 0 to 1')
    has_landed = code in _LANDS or (code in _MAY_LAND and message.placed != ros.Placement())
    usual = message.reason == PLACEMENT_REASONS[code]
    return PlacementOutcome(
        message.trial_id,
        message.sequence,
        placed_from_ros(board, message.placed, 'placed') if has_landed else None,
        '' if usual else message.reason,
        code,
        message.progress,
    )
