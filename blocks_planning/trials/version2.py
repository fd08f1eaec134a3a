"""Reading version 2 of the record format; :mod:`.record` writes it."""

from __future__ import annotations

from typing import Any

from blocks_planning.board.blocks import Block, Placement, parse_library
from blocks_planning.board.geometry import Board
from blocks_planning.board.pictures import parse_silhouettes
from blocks_planning.board.task import Task
from blocks_planning.errors import RecordError
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.subgoals.regions import Label, Region
from blocks_planning.trials.fields import Fields
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import FAMILIES, TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Observation

MAX_LABEL_NUMBERS = 16


def read(fields: Fields) -> TrialRecord:
    """The record of a JSON object."""
    return TrialRecord(
        spec=read_spec(fields),
        status=fields.word('status', TrialStatus),
        observations=tuple(_observation(part) for part in fields.parts('observations')),
        decisions=tuple(_decision(part) for part in fields.parts('decisions')),
        proposals=tuple(read_proposal(part, 'sequence') for part in fields.parts('proposals')),
        reason=fields.get('reason', str),
    )


def read_spec(fields: Fields) -> TrialSpec:
    """The specification of the trial."""
    members: dict[str, Any] = {
        family: registry.make(fields.get(family, str), fields.get(f'{family}_settings', dict))
        for family, registry in FAMILIES.items()
    }
    return TrialSpec(
        stimulus=fields.get('stimulus', str),
        task=read_task(fields),
        seed=fields.get('seed', int),
        budget=fields.get('budget', int),
        built=fields.placements('built'),
        **members,
    )


def read_task(fields: Fields) -> Task:
    """Board, silhouette and library."""
    board = Board(fields.get('width', int), fields.get('height', int))
    rows = fields.get('silhouette', list)
    if not all(isinstance(row, str) for row in rows):
        raise fields.error('silhouette', 'must be a list of rows')
    text = '\n'.join(rows)
    pictures = list(parse_silhouettes(text, 'silhouette').values())
    if len(pictures) != 1 or pictures[0][0] != board:
        raise RecordError(
            f'{fields.place}: silhouette must have {board.height} rows of {board.width} cells'
        )
    library = parse_library(fields.get('library', str), 'library')
    return Task(board, pictures[0][1], library)


def _observation(fields: Fields) -> Observation:
    ordered = None
    if fields.get('ordered') is not None:
        width, height, column = fields.numbers('ordered', 3)
        ordered = Placement(Block(width, height), column)
    return Observation(ordered, fields.placements('landed'), fields.placements('gone'))


def _decision(fields: Fields) -> DecisionRecord:
    regions = [_region(part) for part in fields.parts('regions')]
    chosen = fields.get('chosen')
    decision = Decision(
        built=fields.mask('built'),
        candidates=tuple(_candidate(part, regions) for part in fields.parts('candidates')),
        chosen=None if chosen is None else fields.count('chosen'),
        subgoals=tuple(_subgoal(part, regions) for part in fields.parts('subgoals')),
        subgoal_planning_cost=fields.count('subgoal_planning_cost'),
        sequences=fields.count('sequences'),
    )
    return DecisionRecord(fields.count('sequence'), decision, fields.count('executed'))


def _region(fields: Fields) -> Region:
    label = fields.get('label', dict)
    if len(label) != 1:
        raise fields.error(
            'label', 'must have one key, the kind, with its numbers, such as {"rows": 4}'
        )
    ((kind, numbers),) = label.items()
    if not isinstance(numbers, list):
        numbers = [numbers]
    part = Fields({'label': numbers}, fields.place)
    if len(numbers) > MAX_LABEL_NUMBERS or not all(type(n) is int for n in numbers):
        raise part.error('label', f'must have at most {MAX_LABEL_NUMBERS} whole numbers')
    return Region(Label(kind, tuple(numbers)), fields.mask('cells'))


def _candidate(fields: Fields, regions: list[Region]) -> Candidate:
    return Candidate(
        regions=fields.items('regions', regions),
        cells=fields.count('cells'),
        planning_cost=fields.count('planning_cost'),
        value=fields.number('value'),
        status=fields.word('status', SolveStatus),
        probability=fields.number('probability'),
    )


def _subgoal(fields: Fields, regions: list[Region]) -> Subgoal:
    return Subgoal(
        region=fields.item('region', regions),
        target=fields.mask('target'),
        execute=fields.count('execute'),
        placements=fields.placements(),
        planning_cost=fields.count('planning_cost'),
        solution_cost=fields.count('solution_cost'),
        attempts=fields.count('attempts'),
    )


def read_proposal(fields: Fields, sequence: str) -> Proposal:
    """A proposal; ``sequence`` is the key of the state in which it was made."""
    return Proposal(
        sequence=fields.count(sequence),
        number=fields.count('number'),
        kind=fields.word('kind', ProposalKind),
        region=fields.mask('region'),
        thinking_s=fields.get('thinking_s', float),
    )
