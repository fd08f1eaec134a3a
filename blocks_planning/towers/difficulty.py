"""Difficulty of a tower for a planner: mean cost and success of its trials."""

from __future__ import annotations

from dataclasses import dataclass, field
from statistics import fmean

from blocks_planning.board.task import Task
from blocks_planning.search.result import DEFAULT_BUDGET, CancelToken
from blocks_planning.search.searches import BreadthFirst, Search
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class Planner:
    """A planner that measures difficulty, and its number of trials.

    Attributes:
        strategy: how subgoals are chosen.
        search: how a region is filled.
        seeds: number of trials, with seeds from 0 upwards.
        budget: b of every solve [states].
    """

    strategy: Strategy = field(default_factory=Scoping)
    search: Search = field(default_factory=BreadthFirst)
    seeds: int = 8
    budget: int = DEFAULT_BUDGET


def difficulty_of(
    task: Task, planner: Planner, cancel: CancelToken | None = None
) -> dict[str, float] | None:
    """The mean cost and success of a planner on a tower; None if cancelled.

    Returns:
        ``cost``: mean number of states that a trial evaluates in all its solves, whether it
        succeeds or not [states]; ``success``: share of the trials that rebuild the tower.
    """
    costs: list[int] = []
    successes: list[bool] = []
    for seed in range(planner.seeds):
        spec = TrialSpec(
            stimulus='made',
            task=task,
            strategy=planner.strategy,
            search=planner.search,
            seed=seed,
            budget=planner.budget,
        )
        record = run_trial(spec, cancel)
        if record.status is TrialStatus.CANCELLED:
            return None
        costs.append(
            sum(
                candidate.planning_cost
                for entry in record.decisions
                for candidate in entry.decision.candidates
            )
        )
        successes.append(record.status is TrialStatus.SUCCESS)
    return {'cost': fmean(costs), 'success': fmean(successes)}
