"""Version 1 of the record format: it is read, and written only for comparison.

It has strategies and searches with a fixed list of settings, regions that are the rows below a
height, and worlds that carry out every order. A record of version 1 is consistent if
:func:`write` returns it again for the trial that :func:`read` returned.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import Any

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import RecordError
from blocks_planning.search.result import SolveStatus
from blocks_planning.search.searches import SEARCHES
from blocks_planning.settings import setting_names, settings_of
from blocks_planning.subgoals.decision import Candidate, Decision, Situation, Subgoal
from blocks_planning.subgoals.proposals import Proposal, proposed_at
from blocks_planning.subgoals.regions import Label, Region, drawn_region, rows_label
from blocks_planning.subgoals.registry import STRATEGIES
from blocks_planning.trials.fields import Fields
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.version2 import read_proposal, read_task
from blocks_planning.worlds.observation import Observation

_FOR_ALL = ('lambda', 'commit')
"""Settings that every record contains; null if the strategy does not have them."""
_FOR_PERSONS = ('participant', 'costs')
DIFFERENT_NOW = {'failure': 'give_up'}
"""Settings whose default differs from the behaviour of version 1."""
_OF_SEARCHES = ('depth', 'iterations', 'divisor', 'execute')


def read(fields: Fields) -> TrialRecord:
    """The record of a JSON object."""
    spec = _spec(fields)
    found = Observation()
    proposals = tuple(read_proposal(part, 'placed') for part in fields.parts('proposals'))
    placements = fields.placements()
    return TrialRecord(
        spec=spec,
        status=fields.word('status', TrialStatus),
        observations=(found, *(Observation(placed.placement, (placed,)) for placed in placements)),
        decisions=tuple(_decision(part, spec, proposals) for part in fields.parts('decisions')),
        proposals=proposals,
    )


def _spec(fields: Fields) -> TrialSpec:
    name = fields.get('strategy', str)
    known = setting_names(STRATEGIES.find(name))
    keys = [key for key in _FOR_ALL if key in known or fields.get(key) is not None]
    keys += [key for key in _FOR_PERSONS if key in known]
    now = {key: value for key, value in DIFFERENT_NOW.items() if key in known}
    return TrialSpec(
        stimulus=fields.get('stimulus', str),
        task=read_task(fields),
        strategy=STRATEGIES.make(name, {**{key: fields.get(key) for key in keys}, **now}),
        search=SEARCHES.make(fields.get('search', str), fields.get('search_settings', dict)),
        seed=fields.get('seed', int),
        budget=fields.get('budget', int),
    )


def _decision(fields: Fields, spec: TrialSpec, proposals: tuple[Proposal, ...]) -> DecisionRecord:
    chosen = fields.get('chosen')
    placed, built = fields.count('placed'), fields.mask('built')
    drawn = drawn_in(spec, built, proposed_at(proposals, placed))
    candidates = tuple(
        _candidate(part, spec.task, drawn[number : number + 1])
        for number, part in enumerate(fields.parts('candidates'))
    )
    decision = Decision(
        built=built,
        candidates=candidates,
        chosen=None if chosen is None else fields.count('chosen'),
        subgoals=tuple(_subgoal(part, spec.task, built) for part in fields.parts('subgoals')),
        subgoal_planning_cost=fields.count('subgoal_planning_cost'),
        sequences=len(candidates),
    )
    return DecisionRecord(placed, decision, fields.count('executed'))


def drawn_in(spec: TrialSpec, built: Mask, proposals: tuple[Proposal, ...]) -> list[Region]:
    """The regions that a person proposed in a state; only these can be other than rows."""
    if not spec.strategy.asks_person:
        return []
    situation = Situation(spec.task, built, spec.seed, {}, proposals)
    return [region for (region,) in spec.strategy.chains(situation)]


def _candidate(fields: Fields, task: Task, drawn: list[Region]) -> Candidate:
    heights = fields.numbers('rows')
    regions = tuple(_rows(fields, task, height) for height in heights)
    return Candidate(
        regions=regions or tuple(drawn),
        cells=fields.count('cells'),
        planning_cost=fields.count('planning_cost'),
        value=fields.number('value'),
        status=fields.word('status', SolveStatus),
    )


def _subgoal(fields: Fields, task: Task, built: Mask) -> Subgoal:
    target = fields.mask('region')
    region = drawn_region(task, built, target & ~built)
    if fields.get('rows') is not None:
        region = Region(rows_label(fields.count('rows')), target)
    return Subgoal(
        region=region,
        target=target,
        execute=fields.count('execute'),
        placements=fields.placements(),
        planning_cost=fields.count('planning_cost'),
        solution_cost=fields.count('solution_cost'),
        attempts=fields.count('attempts'),
    )


def _rows(fields: Fields, task: Task, height: int) -> Region:
    if not 1 <= height <= task.board.height:
        raise RecordError(f'{fields.place}: rows must be from 1 to {task.board.height}')
    return Region(rows_label(height), task.rows(height))


def trial_id_of(spec: TrialSpec) -> str:
    """The trial id in version 1."""
    text = json.dumps(_spec_to_json(spec), sort_keys=True)
    return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()


def write(record: TrialRecord) -> dict[str, Any]:
    """A record in version 1 of the format."""
    return {
        'format': 'blocks_planning/trial-record',
        'version': 1,
        'trial_id': trial_id_of(record.spec),
        **_spec_to_json(record.spec),
        'status': record.status.value,
        'blocks': record.blocks,
        'subgoals': record.subgoals,
        'action_planning_cost': record.action_planning_cost,
        'subgoal_planning_cost': record.subgoal_planning_cost,
        'solution_cost': record.solution_cost,
        'placements': [list(placed) for placed in record.placements],
        'decisions': [_decision_to_json(entry) for entry in record.decisions],
        'proposals': [_proposal_to_json(proposal) for proposal in record.proposals],
    }


def _spec_to_json(spec: TrialSpec) -> dict[str, Any]:
    strategy = settings_of(spec.strategy)
    now = spec.to_json()
    return {
        **{key: now[key] for key in ('stimulus', 'width', 'height', 'silhouette', 'library')},
        'strategy': spec.strategy.name,
        **{key: strategy.get(key) for key in _FOR_ALL},
        **{key: strategy[key] for key in _FOR_PERSONS if key in strategy},
        'search': spec.search.name,
        'search_settings': _search_settings(spec),
        'seed': spec.seed,
        'budget': spec.budget,
    }


def _search_settings(spec: TrialSpec) -> dict[str, Any]:
    return {key: value for key, value in settings_of(spec.search).items() if key in _OF_SEARCHES}


def _decision_to_json(entry: DecisionRecord) -> dict[str, Any]:
    decision = entry.decision
    return {
        'placed': entry.sequence,
        'built': hex(decision.built),
        'chosen': decision.chosen,
        'executed': entry.executed,
        'subgoal_planning_cost': decision.subgoal_planning_cost,
        'candidates': [
            {
                'rows': _heights(one.regions),
                'cells': one.cells,
                'planning_cost': one.planning_cost,
                'value': one.value,
                'status': one.status.value,
            }
            for one in decision.candidates
        ],
        'subgoals': [_subgoal_to_json(subgoal) for subgoal in decision.subgoals],
    }


def _subgoal_to_json(subgoal: Subgoal) -> dict[str, Any]:
    heights = _heights([subgoal.region])
    return {
        'rows': heights[0] if heights else None,
        'region': hex(subgoal.target),
        'execute': subgoal.execute,
        'planning_cost': subgoal.planning_cost,
        'solution_cost': subgoal.solution_cost,
        'attempts': subgoal.attempts,
        'placements': [list(placed) for placed in subgoal.placements],
    }


def _heights(regions: Sequence[Region]) -> list[int]:
    """The heights of those regions that are rows; version 1 cannot express others."""
    return [region.label.numbers[0] for region in regions if _is_rows(region.label)]


def _is_rows(label: Label) -> bool:
    return label == rows_label(*label.numbers[:1] or (0,))


def _proposal_to_json(proposal: Proposal) -> dict[str, Any]:
    return {
        'placed': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': hex(proposal.region),
        'thinking_s': proposal.thinking_s,
    }
