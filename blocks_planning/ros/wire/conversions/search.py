"""Search: requests, results and plans."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import (
    grid_to_ros,
    mask_on,
    placed_from_ros,
    placed_to_ros,
    way_from_ros,
)
from blocks_planning.ros.wire.conversions.fields import cost, refuse, word
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.messages import PlanMade, SearchAnswer, SearchRequest

_SOLVE_REASONS = {
    SolveStatus.SOLVED: 'the placements fill the region',
    SolveStatus.UNSOLVABLE_PROVEN: 'there is no way to fill the region',
    SolveStatus.BUDGET_EXHAUSTED: 'no attempt within the budget filled the region',
    SolveStatus.LIMIT_EXCEEDED: 'the search would have outgrown its memory',
}
SOLVE_STATUSES = [status.value for status in _SOLVE_REASONS]


def _query_from_ros(board: Board, message: ros.SearchRequest | ros.SearchResult) -> Query:
    built = mask_on(board, message.built, 'built')
    region = mask_on(board, message.region, 'region')
    if built & ~region:
        raise refuse('region', 'less', 'a region that contains what is built')
    return Query(built, region)


def request_to_ros(board: Board, message: SearchRequest) -> ros.SearchRequest:
    """See :class:`SearchRequest`."""
    built, region = (grid_to_ros(board, mask) for mask in message.query)
    return ros.SearchRequest(trial_id=message.trial_id, built=built, region=region)


def request_from_ros(board: Board, message: ros.SearchRequest) -> SearchRequest:
    """See :class:`SearchRequest`."""
    return SearchRequest(message.trial_id, _query_from_ros(board, message))


def answer_to_ros(board: Board, message: SearchAnswer) -> ros.SearchResult:
    """See :class:`SearchAnswer`."""
    built, region = (grid_to_ros(board, mask) for mask in message.query)
    result = message.result
    return ros.SearchResult(
        trial_id=message.trial_id,
        built=built,
        region=region,
        status=result.status.value,
        reason=_SOLVE_REASONS[result.status],
        placements=[placed_to_ros(placed) for placed in result.placements],
        solution_cost=result.solution_cost,
        planning_cost=result.planning_cost,
        attempts=result.attempts,
    )


def answer_from_ros(board: Board, message: ros.SearchResult) -> SearchAnswer:
    """See :class:`SearchAnswer`."""
    query = _query_from_ros(board, message)
    status = word(SolveStatus, message.status, 'status', SOLVE_STATUSES)
    placements, reached = way_from_ros(board, query.built, message.placements, 'placements')
    wanted = query.region if status is SolveStatus.SOLVED else query.built
    if reached != wanted:
        raise refuse('placements', len(placements), f'placements that fit status {status.value}')
    result = SolveResult(
        status,
        placements,
        cost(message.solution_cost, 'solution_cost'),
        cost(message.planning_cost, 'planning_cost'),
        message.attempts,
    )
    return SearchAnswer(message.trial_id, query, result)


def plan_to_ros(board: Board, message: PlanMade) -> ros.Plan:
    """See :class:`PlanMade`."""
    return ros.Plan(
        trial_id=message.trial_id,
        sequence=message.sequence,
        region=grid_to_ros(board, message.region),
        execute=message.execute,
        placements=[placed_to_ros(placed) for placed in message.placements],
    )


def plan_from_ros(board: Board, message: ros.Plan) -> PlanMade:
    """See :class:`PlanMade`."""
    placements = tuple(
        placed_from_ros(board, placed, f'placements[{index}]')
        for index, placed in enumerate(message.placements)
    )
    region = mask_on(board, message.region, 'region')
    return PlanMade(message.trial_id, message.sequence, region, message.execute, placements)
