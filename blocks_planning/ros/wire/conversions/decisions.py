"""Decisions: the candidates and the choice."""

from __future__ import annotations

import math
from collections.abc import Sequence

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.ros.wire.conversions.cells import (
    blocks_to_ros,
    grid_to_ros,
    mask_on,
    way_from_ros,
)
from blocks_planning.ros.wire.conversions.fields import (
    MOST_CANDIDATES,
    MOST_OBSERVATIONS,
    MOST_REGIONS,
    bounded,
    cost,
    index,
    refuse,
    word,
)
from blocks_planning.ros.wire.conversions.proposals import proposal_to_ros, read_proposal
from blocks_planning.ros.wire.conversions.search import SOLVE_STATUSES
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import MOST_PROPOSALS
from blocks_planning.subgoals.regions import Label, Region
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import DecisionFailed, ProposalMade
from blocks_planning.trials.record import DecisionRecord, regions_of
from blocks_planning.trials.version2 import MAX_LABEL_NUMBERS

_MAX_KIND = 64
_STATUS = ros.Subgoal


def subgoal_to_ros(board: Board, message: SubgoalChosen) -> ros.Subgoal:
    """See :class:`SubgoalChosen`."""
    status, reason = _STATUS.STATUS_CHOSEN, 'the strategy chose this candidate'
    if message.subgoal is None:
        status, reason = _STATUS.STATUS_NONE_SOLVABLE, 'the strategy chose no candidate'
    return ros.Subgoal(
        trial_id=message.trial_id,
        sequence=message.sequence,
        status=status,
        reason=reason,
        decisions=[decision_to_ros(board, entry) for entry in message.decisions],
        proposals=[
            proposal_to_ros(board, ProposalMade(message.trial_id, proposal))
            for proposal in message.proposals
        ],
    )


def failed_to_ros(message: DecisionFailed) -> ros.Subgoal:
    """See :class:`DecisionFailed`."""
    status = _STATUS.STATUS_LIMIT_EXCEEDED
    return ros.Subgoal(trial_id=message.trial_id, status=status, reason=message.reason)


def subgoal_from_ros(board: Board, message: ros.Subgoal) -> SubgoalChosen | DecisionFailed:
    """See :class:`SubgoalChosen` and :class:`DecisionFailed`."""
    if message.status == _STATUS.STATUS_LIMIT_EXCEEDED:
        if not message.reason:
            raise refuse('reason', '', 'a sentence that says which limit would be exceeded')
        return DecisionFailed(message.trial_id, message.reason)
    bounded(message.decisions, 'decisions', 1, MOST_OBSERVATIONS)
    bounded(message.proposals, 'proposals', 0, MOST_PROPOSALS * len(message.decisions))
    chosen = SubgoalChosen(
        message.trial_id,
        message.sequence,
        tuple(
            _decision_from_ros(board, entry, f'decisions[{number}]')
            for number, entry in enumerate(message.decisions)
        ),
        tuple(
            read_proposal(board, proposal, f'proposals[{number}].')
            for number, proposal in enumerate(message.proposals)
        ),
    )
    is_none = chosen.subgoal is None
    status = _STATUS.STATUS_NONE_SOLVABLE if is_none else _STATUS.STATUS_CHOSEN
    word(str, message.status, 'status', (status,))
    return chosen


def decision_to_ros(board: Board, entry: DecisionRecord) -> ros.Decision:
    """See :class:`DecisionRecord`."""
    decision = entry.decision
    regions = {region: number for number, region in enumerate(regions_of(decision))}
    return ros.Decision(
        sequence=entry.sequence,
        built=grid_to_ros(board, decision.built),
        regions=[region_to_ros(board, region) for region in regions],
        candidates=[_candidate_to_ros(candidate, regions) for candidate in decision.candidates],
        sequences=decision.sequences,
        chosen=-1 if decision.chosen is None else decision.chosen,
        subgoals=[_planned_to_ros(board, subgoal, regions) for subgoal in decision.subgoals],
        subgoal_planning_cost=decision.subgoal_planning_cost,
        executed=entry.executed,
    )


def _decision_from_ros(board: Board, message: ros.Decision, field: str) -> DecisionRecord:
    built = mask_on(board, message.built, f'{field}.built')
    bounded(message.regions, f'{field}.regions', 0, MOST_REGIONS)
    bounded(message.candidates, f'{field}.candidates', 0, MOST_CANDIDATES)
    bounded(message.subgoals, f'{field}.subgoals', 0, board.size)
    regions = [
        region_from_ros(board, region, f'{field}.regions[{number}]')
        for number, region in enumerate(message.regions)
    ]
    candidates = tuple(
        _candidate_from_ros(candidate, regions, f'{field}.candidates[{number}]')
        for number, candidate in enumerate(message.candidates)
    )
    subgoals: list[Subgoal] = []
    is_chosen = 0 <= message.chosen < len(candidates)
    is_solved = not is_chosen or candidates[message.chosen].is_solved
    for number, planned in enumerate(message.subgoals):
        state = subgoals[-1].target if subgoals else built
        place = f'{field}.subgoals[{number}]'
        subgoals.append(_planned_from_ros(board, state, planned, regions, place, is_solved))
    if not -1 <= message.chosen < len(candidates) or (message.chosen < 0) != (not subgoals):
        expected = 'a candidate, and subgoals if there is one'
        raise refuse(f'{field}.chosen', message.chosen, expected)
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
        sequences=cost(message.sequences, f'{field}.sequences'),
    )
    return DecisionRecord(message.sequence, decision, message.executed)


def region_to_ros(board: Board, region: Region) -> ros.Region:
    """See :class:`Region`."""
    return ros.Region(
        label_kind=region.label.kind,
        label_numbers=region.label.numbers,
        cells=grid_to_ros(board, region.cells),
    )


def region_from_ros(board: Board, message: ros.Region, field: str) -> Region:
    """See :class:`Region`."""
    kind = message.label_kind
    if not 1 <= len(kind) <= _MAX_KIND or not kind.isprintable():
        raise refuse(f'{field}.label_kind', kind, f'a word of up to {_MAX_KIND} characters')
    bounded(message.label_numbers, f'{field}.label_numbers', 0, MAX_LABEL_NUMBERS)
    label = Label(kind, tuple(map(int, message.label_numbers)))
    return Region(label, mask_on(board, message.cells, f'{field}.cells'))


def _candidate_to_ros(candidate: Candidate, regions: dict[Region, int]) -> ros.Candidate:
    value, probability = candidate.value, candidate.probability
    return ros.Candidate(
        regions=[regions[region] for region in candidate.regions],
        cells=candidate.cells,
        planning_cost=candidate.planning_cost,
        has_value=value is not None,
        value=value or 0.0,
        has_probability=probability is not None,
        probability=probability or 0.0,
        status=candidate.status.value,
    )


def _candidate_from_ros(
    message: ros.Candidate, regions: Sequence[Region], field: str
) -> Candidate:
    bounded(message.regions, f'{field}.regions', 1, MOST_REGIONS)
    if not math.isfinite(message.value):
        raise refuse(f'{field}.value', message.value, 'a finite number')
    if not 0 <= message.probability <= 1:
        raise refuse(f'{field}.probability', message.probability, 'a number from 0 to 1')
    return Candidate(
        regions=tuple(
            index(int(number), regions, f'{field}.regions') for number in message.regions
        ),
        cells=message.cells,
        planning_cost=cost(message.planning_cost, f'{field}.planning_cost'),
        value=message.value if message.has_value else None,
        status=word(SolveStatus, message.status, f'{field}.status', SOLVE_STATUSES),
        probability=message.probability if message.has_probability else None,
    )


def _planned_to_ros(
    board: Board, subgoal: Subgoal, regions: dict[Region, int]
) -> ros.PlannedSubgoal:
    return ros.PlannedSubgoal(
        region=regions[subgoal.region],
        target=grid_to_ros(board, subgoal.target),
        execute=subgoal.execute,
        placements=blocks_to_ros(subgoal.placements),
        planning_cost=subgoal.planning_cost,
        solution_cost=subgoal.solution_cost,
        attempts=subgoal.attempts,
    )


def _planned_from_ros(
    board: Board,
    built: Mask,
    message: ros.PlannedSubgoal,
    regions: Sequence[Region],
    field: str,
    is_solved: bool,
) -> Subgoal:
    target = mask_on(board, message.target, f'{field}.target')
    placements, reached = way_from_ros(board, built, message.placements, f'{field}.placements')
    fits = reached == target if is_solved else not reached & ~target
    if not fits or built == target:
        raise refuse(f'{field}.placements', len(placements), 'placements that fit the target')
    if not 1 <= message.execute <= len(placements):
        raise refuse(f'{field}.execute', message.execute, f'1 to {len(placements)} placements')
    return Subgoal(
        region=index(message.region, regions, f'{field}.region'),
        target=target,
        execute=message.execute,
        placements=placements,
        planning_cost=cost(message.planning_cost, f'{field}.planning_cost'),
        solution_cost=cost(message.solution_cost, f'{field}.solution_cost'),
        attempts=message.attempts,
    )
