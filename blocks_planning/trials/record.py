"""The record of a trial: complete, as JSON, and independent of the clock.

Format ``blocks_planning/trial-record``, version 2: the keys of :meth:`TrialSpec.to_json`, then
those of :meth:`TrialRecord.to_json`. Costs are states evaluated. Masks are hexadecimal, with bit
``column * height + row`` for each cell. The regions of a decision are listed once; candidates
and subgoals name them by their index in that list.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from blocks_planning.board.geometry import Mask
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.subgoals.regions import Label, Region
from blocks_planning.trials.measures import Measures
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import (
    Blocks,
    Observation,
    Observations,
    mask_of,
    standing,
)

FORMAT = 'blocks_planning/trial-record'
VERSION = 2
SUMMARY_KEYS = (
    *('blocks', 'orders', 'surprises', 'subgoals'),
    *('action_planning_cost', 'subgoal_planning_cost', 'solution_cost'),
    *Measures._fields,
)
"""The keys of :meth:`TrialRecord.summary`."""


@dataclass(frozen=True)
class DecisionRecord:
    """A decision, the state in which it was made, and how far it was executed.

    Attributes:
        sequence: of the observation in whose state it was made.
        decision: what was considered and chosen.
        executed: number of its subgoals that were begun.
    """

    sequence: int
    decision: Decision
    executed: int


@dataclass(frozen=True)
class TrialRecord:
    """What happened in a trial.

    Attributes:
        spec: specification of the trial.
        status: how it ended.
        observations: of the board, the first one before any order; empty if there were none.
        decisions: of the planner, in order.
        proposals: of a person, those that led to the decisions.
        reason: why the trial was cancelled; '' if it was not, or a user asked for it.
    """

    spec: TrialSpec
    status: TrialStatus
    observations: Observations
    decisions: tuple[DecisionRecord, ...]
    proposals: tuple[Proposal, ...] = ()
    reason: str = ''

    @cached_property
    def placements(self) -> Blocks:
        """The blocks that stand at the end, in the order in which they landed."""
        return standing(self.observations)

    @cached_property
    def built(self) -> Mask:
        """The cells that are filled at the end."""
        return mask_of(self.spec.task.board, self.placements)

    @property
    def measures(self) -> Measures:
        """How well the final board matches the silhouette."""
        return Measures.of(self.built, self.spec.task.silhouette)

    def executed_subgoals(self) -> Iterator[Subgoal]:
        """Every subgoal that was begun, in order."""
        for entry in self.decisions:
            yield from entry.decision.subgoals[: entry.executed]

    @property
    def blocks(self) -> int:
        """Number of blocks that stand at the end."""
        return len(self.placements)

    @property
    def orders(self) -> int:
        """Number of placements that were ordered."""
        return sum(observation.ordered is not None for observation in self.observations)

    @property
    def surprises(self) -> int:
        """Number of observations, after the first, that differ from the order."""
        return sum(not observation.is_as_ordered for observation in self.observations[1:])

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
        """The record as JSON types, with keys in a fixed order."""
        return {
            'format': FORMAT,
            'version': VERSION,
            'trial_id': self.spec.trial_id,
            **self.spec.to_json(),
            'status': self.status.value,
            'reason': self.reason,
            **self.summary(),
            'placements': _blocks_to_json(self.placements),
            'observations': [_observation_to_json(seen) for seen in self.observations],
            'decisions': [_decision_to_json(entry) for entry in self.decisions],
            'proposals': [proposal_to_json(proposal) for proposal in self.proposals],
        }

    def summary(self) -> dict[str, Any]:
        """The counts, costs and measures of the trial, by name."""
        return {
            'blocks': self.blocks,
            'orders': self.orders,
            'surprises': self.surprises,
            'subgoals': self.subgoals,
            'action_planning_cost': self.action_planning_cost,
            'subgoal_planning_cost': self.subgoal_planning_cost,
            'solution_cost': self.solution_cost,
            **self.measures._asdict(),
        }

    def to_line(self) -> str:
        """The record as one line of text."""
        return json.dumps(self.to_json(), separators=(',', ':'), allow_nan=False)


def _blocks_to_json(blocks: Blocks) -> list[list[int]]:
    return [list(placed) for placed in blocks]


def _observation_to_json(seen: Observation) -> dict[str, Any]:
    return {
        'ordered': None if seen.ordered is None else [*seen.ordered.block, seen.ordered.column],
        'landed': _blocks_to_json(seen.landed),
        'gone': _blocks_to_json(seen.gone),
    }


def _decision_to_json(entry: DecisionRecord) -> dict[str, Any]:
    decision = entry.decision
    regions = {region: number for number, region in enumerate(regions_of(decision))}
    return {
        'sequence': entry.sequence,
        'built': hex(decision.built),
        'regions': [_region_to_json(region) for region in regions],
        'sequences': decision.sequences,
        'candidates': [_candidate_to_json(one, regions) for one in decision.candidates],
        'chosen': decision.chosen,
        'executed': entry.executed,
        'subgoal_planning_cost': decision.subgoal_planning_cost,
        'subgoals': [_subgoal_to_json(subgoal, regions) for subgoal in decision.subgoals],
    }


def regions_of(decision: Decision) -> list[Region]:
    """Every region of a decision once, in the order in which candidates and subgoals name them."""
    considered = (region for one in decision.candidates for region in one.regions)
    executed = (subgoal.region for subgoal in decision.subgoals)
    return list(dict.fromkeys([*considered, *executed]))


def _region_to_json(region: Region) -> dict[str, Any]:
    return {'label': label_to_json(region.label), 'cells': hex(region.cells)}


def label_to_json(label: Label) -> dict[str, Any]:
    """A label as data, such as ``{'rows': 4}`` or ``{'rectangle': [0, 2, 3, 1]}``."""
    single = len(label.numbers) == 1
    return {label.kind: label.numbers[0] if single else list(label.numbers)}


def _candidate_to_json(candidate: Candidate, regions: dict[Region, int]) -> dict[str, Any]:
    return {
        'regions': [regions[region] for region in candidate.regions],
        'cells': candidate.cells,
        'planning_cost': candidate.planning_cost,
        'value': candidate.value,
        'probability': candidate.probability,
        'status': candidate.status.value,
    }


def _subgoal_to_json(subgoal: Subgoal, regions: dict[Region, int]) -> dict[str, Any]:
    return {
        'region': regions[subgoal.region],
        'target': hex(subgoal.target),
        'execute': subgoal.execute,
        'planning_cost': subgoal.planning_cost,
        'solution_cost': subgoal.solution_cost,
        'attempts': subgoal.attempts,
        'placements': _blocks_to_json(subgoal.placements),
    }


def proposal_to_json(proposal: Proposal) -> dict[str, Any]:
    """A proposal as data; its region is a hexadecimal mask."""
    return {
        'sequence': proposal.sequence,
        'number': proposal.number,
        'kind': proposal.kind.value,
        'region': hex(proposal.region),
        'thinking_s': proposal.thinking_s,
    }
