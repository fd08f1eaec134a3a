"""Scenes and records as JSON for the page. Masks are pictures, top row first.

If a trial hides its costs from the person, the JSON has no costs, values or candidates.
"""

from __future__ import annotations

from itertools import accumulate
from typing import Any

from blocks_planning.board.geometry import Board, Mask
from blocks_planning.settings import settings_of
from blocks_planning.subgoals.decision import Decision
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions, palette
from blocks_planning.view.scene import Scene, scenes_of
from blocks_planning.view.web.session import MOST_CANDIDATES, Past

Json = dict[str, Any]
MOST_PLANNED = 64


def rows_of(board: Board, mask: Mask) -> list[str]:
    """A mask as a picture."""
    return board.draw(mask).split('\n')


def trial_json(spec: TrialSpec, trial_id: str) -> Json:
    """The constant properties of a trial."""
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
        'seed': str(spec.seed),
        'budget': spec.budget,
        'person': strategy.asks_person,
        'participant': str(settings_of(strategy).get('participant', '')),
        'costs_hidden': strategy.hides_costs,
    }


def blocks_json(scene: Scene) -> list[Json]:
    """Every block that has landed, with its subgoal and its colours."""
    fills = palette.fills_of(scene.landed)
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
        for block, fill in zip(scene.landed, fills, strict=True)
    ]


def decision_json(decision: Decision, hidden: bool) -> Json | None:
    """The candidates of a decision, the best ones if there are many; None if they are hidden."""
    if hidden:
        return None
    shown = captions.shortlist(decision, MOST_CANDIDATES)
    return {
        'total': len(decision.candidates),
        'cost': decision.subgoal_planning_cost,
        'candidates': [
            {
                'label': captions.chain_text(candidate.regions),
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
    """The properties of a trial that change while it runs."""
    record, board = scene.record, scene.task.board
    step: Json = {
        'sequence': scene.sequence,
        'standing': list(scene.standing),
        'entry': len(record.decisions) - 1,
        'subgoals': record.subgoals,
        'status': scene.status.value,
        'word': captions.STATUS_WORDS[scene.status],
        'region': None,
        'planned': [],
        'label': '',
        'top': 0,
        'colour': palette.colour_of(max(record.subgoals - 1, 0)),
    }
    if scene.subgoal is not None:
        done = 0 if scene.progress is None else scene.progress.done
        planned = scene.subgoal.placements[done : scene.subgoal.execute]
        step['region'] = rows_of(board, scene.region) if scene.region else None
        step['planned'] = [list(placed) for placed in planned[:MOST_PLANNED]]
        step['label'] = scene.label
        step['top'] = scene.top if scene.region else 0
    if not hidden:
        step['action_cost'] = record.action_planning_cost
        step['subgoal_cost'] = record.subgoal_planning_cost
    return step


def curve_json(record: TrialRecord, hidden: bool) -> list[list[int]]:
    """Sequence, action and subgoal planning cost so far, after each decision."""
    if hidden:
        return []
    action = accumulate(
        sum(subgoal.planning_cost for subgoal in entry.decision.subgoals[: entry.executed])
        for entry in record.decisions
    )
    subgoal = accumulate(entry.decision.subgoal_planning_cost for entry in record.decisions)
    sequences = (entry.sequence for entry in record.decisions)
    return [list(point) for point in zip(sequences, action, subgoal, strict=True)]


def proposal_json(board: Board, proposal: Proposal) -> Json:
    """A person's proposal, without its result."""
    return {
        'sequence': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': rows_of(board, proposal.region),
        'thinking': round(proposal.thinking_s, 3),
    }


def summary_json(past: Past, hidden: bool) -> Json:
    """A finished trial, as a line of a table."""
    record = past.scene.record
    hidden = hidden or record.spec.strategy.hides_costs
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
    """A finished trial, step by step."""
    scene = past.scene
    record = scene.record
    hidden = hidden or record.spec.strategy.hides_costs
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
