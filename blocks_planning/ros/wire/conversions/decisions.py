"""Decisions: what was considered and chosen."""

from __future__ import annotations

import math

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.ros.wire.conversions.cells import (
    grid_to_ros,
    mask_on,
    placed_to_ros,
    way_from_ros,
)
from blocks_planning.ros.wire.conversions.fields import cost, refuse, word
from blocks_planning.ros.wire.conversions.search import SOLVE_STATUSES
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.messages import ProposalMade, SubgoalChosen
from blocks_planning.trials.record import DecisionRecord

MOST_PROPOSALS = 1000
"""In one state; nobody thinks of so many, and memory stays bounded."""


def subgoal_to_ros(board: Board, message: SubgoalChosen) -> ros.Subgoal:
    """See :class:`SubgoalChosen`."""
    kind = ros.Subgoal
    if message.subgoal is None:
        status, reason = kind.STATUS_NONE_SOLVABLE, 'no candidate could be solved'
        if message.proposals:
            reason = 'the person gave up'
    else:
        status, reason = kind.STATUS_CHOSEN, 'the candidate of highest value'
        if message.proposals:
            reason = 'the person proposed it, and it could be solved'
    return kind(
        trial_id=message.trial_id,
        sequence=message.sequence,
        status=status,
        reason=reason,
        decisions=[_decision_to_ros(board, entry) for entry in message.decisions],
        proposals=[
            proposal_to_ros(board, ProposalMade(message.trial_id, proposal))
            for proposal in message.proposals
        ],
    )


def subgoal_from_ros(board: Board, message: ros.Subgoal) -> SubgoalChosen:
    """See :class:`SubgoalChosen`."""
    decisions = tuple(
        _decision_from_ros(board, entry, f'decisions[{index}]')
        for index, entry in enumerate(message.decisions)
    )
    if not 1 <= len(decisions) <= board.size + 1:
        raise refuse('decisions', len(decisions), f'1 to {board.size + 1} decisions')
    kind = ros.Subgoal
    proposals = tuple(
        _proposal_from_ros(board, proposal, f'proposals[{index}].')
        for index, proposal in enumerate(message.proposals)
    )
    chosen = SubgoalChosen(message.trial_id, message.sequence, decisions, proposals)
    status = kind.STATUS_NONE_SOLVABLE if chosen.subgoal is None else kind.STATUS_CHOSEN
    word(str, message.status, 'status', (status,))
    return chosen


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
    return ProposalMade(message.trial_id, _proposal_from_ros(board, message, ''))


def _proposal_from_ros(board: Board, message: ros.Proposal, prefix: str) -> Proposal:
    if message.sequence > board.size:
        raise refuse(f'{prefix}sequence', message.sequence, f'0 to {board.size} placements')
    if message.number >= MOST_PROPOSALS:
        raise refuse(f'{prefix}number', message.number, f'0 to {MOST_PROPOSALS - 1}')
    if not 0 <= message.thinking_s < math.inf:
        raise refuse(f'{prefix}thinking_s', message.thinking_s, 'a finite number of 0 or more')
    kinds = [kind.value for kind in ProposalKind]
    return Proposal(
        sequence=message.sequence,
        number=message.number,
        kind=word(ProposalKind, message.kind, f'{prefix}kind', kinds),
        region=mask_on(board, message.region, f'{prefix}region'),
        thinking_s=message.thinking_s,
    )


def _decision_to_ros(board: Board, entry: DecisionRecord) -> ros.Decision:
    decision = entry.decision
    return ros.Decision(
        placed=entry.placed,
        built=grid_to_ros(board, decision.built),
        candidates=[_candidate_to_ros(candidate) for candidate in decision.candidates],
        chosen=-1 if decision.chosen is None else decision.chosen,
        subgoals=[_planned_to_ros(board, subgoal) for subgoal in decision.subgoals],
        subgoal_planning_cost=decision.subgoal_planning_cost,
        executed=entry.executed,
    )


def _decision_from_ros(board: Board, message: ros.Decision, field: str) -> DecisionRecord:
    built = mask_on(board, message.built, f'{field}.built')
    candidates = tuple(
        _candidate_from_ros(board, candidate, f'{field}.candidates[{index}]')
        for index, candidate in enumerate(message.candidates)
    )
    subgoals = []
    state = built
    for index, planned in enumerate(message.subgoals):
        subgoals.append(_planned_from_ros(board, state, planned, f'{field}.subgoals[{index}]'))
        state = subgoals[-1].region
    if not -1 <= message.chosen < len(candidates) or (message.chosen < 0) != (not subgoals):
        raise refuse(
            f'{field}.chosen', message.chosen, 'a candidate, and subgoals if there is one'
        )
    if message.executed > len(subgoals) or (subgoals and message.executed == 0):
        raise refuse(f'{field}.executed', message.executed, f'1 to {len(subgoals)} subgoals')
    decision = Decision(
        built=built,
        candidates=candidates,
        chosen=None if message.chosen < 0 else message.chosen,
        subgoals=tuple(subgoals),
        subgoal_planning_cost=cost(
            message.subgoal_planning_cost, f'{field}.subgoal_planning_cost'
        ),
    )
    return DecisionRecord(message.placed, decision, message.executed)


def _candidate_to_ros(candidate: Candidate) -> ros.Candidate:
    return ros.Candidate(
        rows=candidate.heights,
        cells=candidate.cells,
        planning_cost=candidate.planning_cost,
        has_value=candidate.value is not None,
        value=0.0 if candidate.value is None else candidate.value,
        status=candidate.status.value,
    )


def _candidate_from_ros(board: Board, message: ros.Candidate, field: str) -> Candidate:
    heights = tuple(map(int, message.rows))
    if list(heights) != sorted(set(heights)) or max(heights, default=0) > board.height:
        raise refuse(f'{field}.rows', list(heights), f'rising numbers up to {board.height}')
    if not math.isfinite(message.value):
        raise refuse(f'{field}.value', message.value, 'a finite number')
    return Candidate(
        heights=heights,
        cells=message.cells,
        planning_cost=cost(message.planning_cost, f'{field}.planning_cost'),
        value=message.value if message.has_value else None,
        status=word(SolveStatus, message.status, f'{field}.status', SOLVE_STATUSES),
    )


def _planned_to_ros(board: Board, subgoal: Subgoal) -> ros.PlannedSubgoal:
    return ros.PlannedSubgoal(
        rows=subgoal.height or 0,
        region=grid_to_ros(board, subgoal.region),
        execute=subgoal.execute,
        placements=[placed_to_ros(placed) for placed in subgoal.placements],
        planning_cost=subgoal.planning_cost,
        solution_cost=subgoal.solution_cost,
        attempts=subgoal.attempts,
    )


def _planned_from_ros(
    board: Board, built: Mask, message: ros.PlannedSubgoal, field: str
) -> Subgoal:
    region = mask_on(board, message.region, f'{field}.region')
    placements, reached = way_from_ros(board, built, message.placements, f'{field}.placements')
    if reached != region or built == region:
        raise refuse(f'{field}.placements', len(placements), 'placements that fill the region')
    if not 1 <= message.execute <= len(placements):
        raise refuse(f'{field}.execute', message.execute, f'1 to {len(placements)} placements')
    if message.rows > board.height:
        raise refuse(f'{field}.rows', message.rows, f'0 to {board.height}')
    return Subgoal(
        height=message.rows or None,
        region=region,
        execute=message.execute,
        placements=placements,
        planning_cost=cost(message.planning_cost, f'{field}.planning_cost'),
        solution_cost=cost(message.solution_cost, f'{field}.solution_cost'),
        attempts=message.attempts,
    )
