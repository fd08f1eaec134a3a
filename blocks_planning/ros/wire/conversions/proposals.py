"""Proposals of a person."""

from __future__ import annotations

import math

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import grid_to_ros, mask_on
from blocks_planning.ros.wire.conversions.fields import MOST_OBSERVATIONS, refuse, word
from blocks_planning.subgoals.proposals import MOST_PROPOSALS, Proposal, ProposalKind
from blocks_planning.trials.messages import ProposalMade

_KINDS = [kind.value for kind in ProposalKind]


def proposal_to_ros(board: Board, message: ProposalMade) -> ros.Proposal:
    """See :class:`ProposalMade`."""
    proposal = message.proposal
    return ros.Proposal(
        trial_id=message.trial_id,
        sequence=proposal.sequence,
        number=proposal.number,
        kind=proposal.kind.value,
        region=grid_to_ros(board, proposal.region),
        thinking_s=proposal.thinking_s,
    )


def proposal_from_ros(board: Board, message: ros.Proposal) -> ProposalMade:
    """See :class:`ProposalMade`."""
    return ProposalMade(message.trial_id, read_proposal(board, message, ''))


def read_proposal(board: Board, message: ros.Proposal, prefix: str) -> Proposal:
    """A proposal, whose fields have names that begin with ``prefix`` in errors."""
    if message.sequence >= MOST_OBSERVATIONS:
        expected = f'0 to {MOST_OBSERVATIONS - 1}'
        raise refuse(f'{prefix}sequence', message.sequence, expected)
    if message.number >= MOST_PROPOSALS:
        raise refuse(f'{prefix}number', message.number, f'0 to {MOST_PROPOSALS - 1}')
    if not 0 <= message.thinking_s < math.inf:
        raise refuse(f'{prefix}thinking_s', message.thinking_s, 'a finite number of 0 or more')
    return Proposal(
        sequence=message.sequence,
        number=message.number,
        kind=word(ProposalKind, message.kind, f'{prefix}kind', _KINDS),
        region=mask_on(board, message.region, f'{prefix}region'),
        thinking_s=message.thinking_s,
    )
