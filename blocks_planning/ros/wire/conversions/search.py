"""Search: requests, results and plans."""

from __future__ import annotations

from blocks_planning_msgs import msg as ros

from blocks_planning.board.geometry import Board
from blocks_planning.ros.wire.conversions.cells import (
    blocks_from_ros,
    blocks_to_ros,
    grid_to_ros,
    mask_on,
    way_from_ros,
)
from blocks_planning.ros.wire.conversions.fields import MOST_QUERIES, bounded, cost, refuse, word
from blocks_planning.search.result import SolveResult, SolveStatus
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.messages import PlanMade, SearchAnswer, SearchRequest
from blocks_planning.worlds.observation import mask_of

_SOLVE_REASONS = {
    SolveStatus.SOLVED: 'the placements fill the target',
    SolveStatus.UNSOLVABLE_PROVEN: 'there is no way to fill the target',
    SolveStatus.BUDGET_EXHAUSTED: 'no attempt within the budget filled the target',
    SolveStatus.LIMIT_EXCEEDED: 'the search would have exceeded its memory',
}
SOLVE_STATUSES = [status.value for status in _SOLVE_REASONS]


def query_to_ros(board: Board, query: Query) -> ros.Query:
    """See :class:`Query`."""
    return ros.Query(
        built=grid_to_ros(board, query.built),
        target=grid_to_ros(board, query.target),
        blocks=blocks_to_ros(query.blocks),
    )


def query_from_ros(board: Board, message: ros.Query, field: str) -> Query:
    """See :class:`Query`."""
    built = mask_on(board, message.built, f'{field}.built')
    target = mask_on(board, message.target, f'{field}.target')
    if built & ~target:
        raise refuse(f'{field}.target', 'less', 'a target that contains what is built')
    blocks = blocks_from_ros(board, message.blocks, f'{field}.blocks')
    if blocks and mask_of(board, blocks) != built:
        raise refuse(f'{field}.blocks', len(blocks), 'blocks that fill what is built, or none')
    return Query(built, target, blocks)


def request_to_ros(board: Board, message: SearchRequest) -> ros.SearchRequest:
    """See :class:`SearchRequest`."""
    queries = [query_to_ros(board, query) for query in message.queries]
    return ros.SearchRequest(trial_id=message.trial_id, queries=queries)


def request_from_ros(board: Board, message: ros.SearchRequest) -> SearchRequest:
    """See :class:`SearchRequest`."""
    bounded(message.queries, 'queries', 1, MOST_QUERIES)
    queries = tuple(
        query_from_ros(board, query, f'queries[{index}]')
        for index, query in enumerate(message.queries)
    )
    return SearchRequest(message.trial_id, queries)


def answer_to_ros(board: Board, message: SearchAnswer) -> ros.SearchResult:
    """See :class:`SearchAnswer`."""
    result = message.result
    return ros.SearchResult(
        trial_id=message.trial_id,
        query=query_to_ros(board, message.query),
        status=result.status.value,
        reason=_SOLVE_REASONS[result.status],
        placements=blocks_to_ros(result.plan),
        solution_cost=result.solution_cost,
        planning_cost=result.planning_cost,
        attempts=result.attempts,
    )


def answer_from_ros(board: Board, message: ros.SearchResult) -> SearchAnswer:
    """See :class:`SearchAnswer`."""
    query = query_from_ros(board, message.query, 'query')
    status = word(SolveStatus, message.status, 'status', SOLVE_STATUSES)
    placements, reached = way_from_ros(board, query.built, message.placements, 'placements')
    solved = status is SolveStatus.SOLVED
    if (reached != query.target) if solved else (reached & ~query.target):
        raise refuse('placements', len(placements), f'placements that fit status {status.value}')
    result = SolveResult(
        status,
        placements if solved else (),
        cost(message.solution_cost, 'solution_cost'),
        cost(message.planning_cost, 'planning_cost'),
        message.attempts,
        () if solved else placements,
    )
    return SearchAnswer(message.trial_id, query, result)


def plan_to_ros(board: Board, message: PlanMade) -> ros.Plan:
    """See :class:`PlanMade`."""
    return ros.Plan(
        trial_id=message.trial_id,
        sequence=message.sequence,
        target=grid_to_ros(board, message.target),
        execute=message.execute,
        placements=blocks_to_ros(message.placements),
    )


def plan_from_ros(board: Board, message: ros.Plan) -> PlanMade:
    """See :class:`PlanMade`."""
    placements = blocks_from_ros(board, message.placements, 'placements')
    target = mask_on(board, message.target, 'target')
    return PlanMade(message.trial_id, message.sequence, target, message.execute, placements)
