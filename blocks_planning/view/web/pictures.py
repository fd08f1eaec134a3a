"""Scenes and records as JSON for the page. Masks are pictures, top row first.

Where a trial hides its costs from the person, no cost, no value and no candidate gets in here.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.settings import settings_of
from blocks_planning.subgoals.decision import Decision
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions, palette
from blocks_planning.view.scene import Scene, scenes_of
from blocks_planning.view.web.session import MOST_CANDIDATES, Past

Json = dict[str, Any]
MOST_PLANNED = 64


def hides_costs(spec: TrialSpec) -> bool:
    """Whether the person of a trial must not see what was evaluated."""
    return isinstance(spec.strategy, Human) and spec.strategy.costs == 'hidden'


def rows_of(board: Board, mask: Mask) -> list[str]:
    """A mask as a picture."""
    return board.draw(mask).split('\n')


def trial_json(spec: TrialSpec, trial_id: str) -> Json:
    """What does not change while a trial runs."""
    board = spec.task.board
    strategy = spec.strategy
    return {
        'id': trial_id,
        'stimulus': spec.stimulus,
        'width': board.width,
        'height': board.height,
        'silhouette': rows_of(board, spec.task.silhouette),
        'library': [list(block) for block in spec.task.library],
        'strategy': captions.strategy_of(spec),
        'search': captions.search_of(spec),
        'lambda': settings_of(strategy).get('lambda'),
        'seed': str(spec.seed),
        'budget': spec.budget,
        'person': isinstance(strategy, Human),
        'participant': strategy.participant if isinstance(strategy, Human) else '',
        'costs_hidden': hides_costs(spec),
    }


def blocks_json(scene: Scene) -> list[Json]:
    """What stands, each block with its subgoal and its colours."""
    fills = palette.fills_of(scene.blocks)
    return [
        {
            'width': block.placed.width,
            'height': block.placed.height,
            'column': block.placed.column,
            'row': block.placed.row,
            'subgoal': block.subgoal,
            'fill': fill,
            'ink': palette.ink_on(fill),
        }
        for block, fill in zip(scene.blocks, fills, strict=True)
    ]


def decision_json(decision: Decision, hidden: bool) -> Json | None:
    """What was weighed, the best of it if it is much; None if that is hidden."""
    if hidden:
        return None
    shown = captions.shortlist(decision, MOST_CANDIDATES)
    return {
        'total': len(decision.candidates),
        'cost': decision.subgoal_planning_cost,
        'candidates': [
            {
                'rows': list(candidate.heights),
                'cells': candidate.cells,
                'cost': candidate.planning_cost,
                'value': candidate.value,
                'status': captions.SOLVE_WORDS[candidate.status],
                'chosen': index == decision.chosen,
            }
            for index in shown
            for candidate in (decision.candidates[index],)
        ],
    }


def step_json(scene: Scene, hidden: bool) -> Json:
    """What changes while a trial runs."""
    record, board = scene.record, scene.task.board
    step: Json = {
        'blocks': len(scene.placements),
        'entry': len(record.decisions) - 1,
        'subgoals': record.subgoals,
        'status': scene.status.value,
        'word': captions.STATUS_WORDS[scene.status],
        'region': None,
        'planned': [],
        'height': None,
        'colour': palette.colour_of(max(record.subgoals - 1, 0)),
    }
    if scene.subgoal is not None and scene.chosen is not None:
        done = len(scene.placements) - scene.chosen.sequence
        planned = scene.subgoal.placements[: scene.subgoal.execute]
        step['region'] = rows_of(board, scene.region) if scene.region else None
        step['planned'] = [list(placed) for placed in planned[max(done, 0) :][:MOST_PLANNED]]
        step['height'] = scene.subgoal.height if scene.region else None
    if not hidden:
        step['action_cost'] = record.action_planning_cost
        step['subgoal_cost'] = record.subgoal_planning_cost
    return step


def curve_json(record: TrialRecord, hidden: bool) -> list[list[int]]:
    """Blocks placed, action and subgoal planning cost so far, after each decision."""
    if hidden:
        return []
    action = accumulate(
        sum(subgoal.planning_cost for subgoal in entry.decision.subgoals[: entry.executed])
        for entry in record.decisions
    )
    subgoal = accumulate(entry.decision.subgoal_planning_cost for entry in record.decisions)
    placed = (entry.placed for entry in record.decisions)
    return [list(point) for point in zip(placed, action, subgoal, strict=True)]


def proposal_json(board: Board, proposal: Proposal) -> Json:
    """A person's word, without what became of it."""
    return {
        'sequence': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': rows_of(board, proposal.region),
        'thinking': round(proposal.thinking_s, 3),
    }


def summary_json(past: Past, hidden: bool) -> Json:
    """A trial that ran, as a line of a table."""
    record = past.scene.record
    hidden = hidden or hides_costs(record.spec)
    return {
        'number': past.number,
        'stimulus': record.spec.stimulus,
        'strategy': captions.strategy_of(record.spec),
        'search': captions.search_of(record.spec),
        'status': record.status.value,
        'word': 'not finished'
        if record.status is TrialStatus.BUILDING
        else captions.STATUS_WORDS[record.status],
        'blocks': record.blocks,
        'subgoals': record.subgoals,
        'action_cost': None if hidden else record.action_planning_cost,
        'subgoal_cost': None if hidden else record.subgoal_planning_cost,
    }


def replay_json(past: Past, hidden: bool) -> Json:
    """A trial that ran, step by step."""
    scene = past.scene
    record = scene.record
    hidden = hidden or hides_costs(record.spec)
    decisions = [decision_json(entry.decision, hidden) for entry in record.decisions]
    return {
        **summary_json(past, hidden),
        'trial': trial_json(record.spec, scene.trial.trial_id),
        'all_blocks': blocks_json(scene),
        'decisions': [decision for decision in decisions if decision is not None],
        'curve': curve_json(record, hidden),
        'proposals': [proposal_json(scene.task.board, p) for p in record.proposals],
        'steps': [step_json(one, hidden) for one in scenes_of(record)],
    }
