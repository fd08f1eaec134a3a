"""The record of a trial: JSON in which nothing is missing and nothing depends on the clock.

Format ``blocks_planning/trial-record``, version 1: the keys of :meth:`TrialSpec.to_json`, then
those of :meth:`TrialRecord.to_json`. Costs are states evaluated; masks are hexadecimal, with bit
``column * height + row`` for each cell.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from blocks_planning.board.blocks import Placed
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

FORMAT = 'blocks_planning/trial-record'
VERSION = 1


@dataclass(frozen=True)
class DecisionRecord:
    """A decision, in which state it fell, and how far it was followed.

    Attributes:
        placed: number of placements before it.
        decision: what was considered and chosen.
        executed: how many of its subgoals were begun.
    """

    placed: int
    decision: Decision
    executed: int


@dataclass(frozen=True)
class TrialRecord:
    """What happened in a trial; ``proposals`` are those of a person that led to its decisions."""

    spec: TrialSpec
    status: TrialStatus
    placements: tuple[Placed, ...]
    decisions: tuple[DecisionRecord, ...]
    proposals: tuple[Proposal, ...] = ()

    def executed_subgoals(self) -> Iterator[Subgoal]:
        """Every subgoal that was begun, in order."""
        for entry in self.decisions:
            yield from entry.decision.subgoals[: entry.executed]

    @property
    def blocks(self) -> int:
        """Number of blocks placed."""
        return len(self.placements)

    @property
    def subgoals(self) -> int:
        """Number of subgoals executed."""
        return sum(entry.executed for entry in self.decisions)

    @property
    def action_planning_cost(self) -> int:
        """States evaluated in the solves of the executed subgoals, all attempts."""
        return sum(subgoal.planning_cost for subgoal in self.executed_subgoals())

    @property
    def solution_cost(self) -> int:
        """States evaluated in the successful attempts of the executed subgoals."""
        return sum(subgoal.solution_cost for subgoal in self.executed_subgoals())

    @property
    def subgoal_planning_cost(self) -> int:
        """States evaluated for everything that was considered."""
        return sum(entry.decision.subgoal_planning_cost for entry in self.decisions)

    def to_json(self) -> dict[str, Any]:
        """The record as it is written: keys in a fixed order, only JSON's own types."""
        return {
            'format': FORMAT,
            'version': VERSION,
            'trial_id': self.spec.trial_id,
            **self.spec.to_json(),
            'status': self.status.value,
            'blocks': self.blocks,
            'subgoals': self.subgoals,
            'action_planning_cost': self.action_planning_cost,
            'subgoal_planning_cost': self.subgoal_planning_cost,
            'solution_cost': self.solution_cost,
            'placements': [list(placed) for placed in self.placements],
            'decisions': [_decision_to_json(entry) for entry in self.decisions],
            'proposals': [_proposal_to_json(proposal) for proposal in self.proposals],
        }

    def to_line(self) -> str:
        """The record as one line of text."""
        return json.dumps(self.to_json(), separators=(',', ':'), allow_nan=False)


def _decision_to_json(entry: DecisionRecord) -> dict[str, Any]:
    decision = entry.decision
    return {
        'placed': entry.placed,
        'built': hex(decision.built),
        'chosen': decision.chosen,
        'executed': entry.executed,
        'subgoal_planning_cost': decision.subgoal_planning_cost,
        'candidates': [_candidate_to_json(candidate) for candidate in decision.candidates],
        'subgoals': [_subgoal_to_json(subgoal) for subgoal in decision.subgoals],
    }


def _proposal_to_json(proposal: Proposal) -> dict[str, Any]:
    return {
        'placed': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': hex(proposal.region),
        'thinking_s': proposal.thinking_s,
    }


def _candidate_to_json(candidate: Candidate) -> dict[str, Any]:
    return {
        'rows': list(candidate.heights),
        'cells': candidate.cells,
        'planning_cost': candidate.planning_cost,
        'value': candidate.value,
        'status': candidate.status.value,
    }


def _subgoal_to_json(subgoal: Subgoal) -> dict[str, Any]:
    return {
        'rows': subgoal.height,
        'region': hex(subgoal.region),
        'execute': subgoal.execute,
        'planning_cost': subgoal.planning_cost,
        'solution_cost': subgoal.solution_cost,
        'attempts': subgoal.attempts,
        'placements': [list(placed) for placed in subgoal.placements],
    }
