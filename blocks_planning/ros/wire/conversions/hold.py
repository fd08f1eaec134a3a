"""Up to which state orders may be given."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.fields import MOST_OBSERVATIONS, refuse
from blocks_planning.trials.messages import Held


def held_to_ros(board: Board, message: Held) -> ros.Hold:
    """See :class:`Held`."""
    until = message.until
    return ros.Hold(trial_id=message.trial_id, is_held=until is not None, sequence=until or 0)


def held_from_ros(board: Board, message: ros.Hold) -> Held:
    """See :class:`Held`."""
    most = MOST_OBSERVATIONS if message.is_held else 0
    if message.sequence > most:
        raise refuse('sequence', message.sequence, f'0 to {most}')
    return Held(message.trial_id, message.sequence if message.is_held else None)
