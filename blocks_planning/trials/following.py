"""A trial without messages: a planner is asked, its plan carried out, and it is asked again.

The record is the one that :func:`blocks_planning.trials.local.run_trial` gives. What is answered
once can be handed to the next trial of the same task, search, seed and budget, whatever its
strategy: a solve depends on nothing else.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from functools import lru_cache

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.decision import Decision, Query, Subgoal
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of

_status_of = lru_cache(maxsize=4096)(status_of)


def follow(spec: TrialSpec, answers: MutableMapping[Query, SolveResult]) -> TrialRecord:
    """Run a trial to its end.

    Args:
        spec: the trial.
        answers: what is known already of this task, search, seed and budget; new answers are
            added. They are counted in the record as if they had been searched for anew.

    Raises:
        ConfigurationError: for a strategy that has to ask a person.
        LimitExceeded: if the search has a limit of size and a problem is over it.
    """
    built: Mask = 0
    placements: list[Placed] = []
    decisions: list[DecisionRecord] = []
    status = _status_of(spec.task, built)
    while status is TrialStatus.BUILDING:
        placed, executed = len(placements), 0
        decision = _decide(spec, built, answers)
        if decision.chosen is None:
            status = TrialStatus.GAVE_UP
        for subgoal in decision.subgoals:
            executed += 1
            built = _carried_out(spec, built, subgoal)
            placements += subgoal.placements[: subgoal.execute]
            status = _status_of(spec.task, built)
            if status is not TrialStatus.BUILDING or built != subgoal.region:
                break
        decisions.append(DecisionRecord(placed, decision, executed))
    return TrialRecord(spec, status, tuple(placements), tuple(decisions))


def _decide(spec: TrialSpec, built: Mask, answers: MutableMapping[Query, SolveResult]) -> Decision:
    while True:
        answer = spec.strategy.decide(spec.task, built, spec.seed, answers)
        if isinstance(answer, Decision):
            return answer
        if not answer:
            raise ConfigurationError(f'strategy {spec.strategy.name} waits for a person')
        for query in answer:
            problem = Problem(spec.task, *query)
            answers[query] = solve(problem, spec.search, spec.seed, spec.budget)


def _carried_out(spec: TrialSpec, built: Mask, subgoal: Subgoal) -> Mask:
    """The state after as much of a subgoal's plan as is to be executed."""
    if subgoal.execute == len(subgoal.placements):
        return subgoal.region
    plan = subgoal.placements[: subgoal.execute]
    return rules.states_along(spec.task.board, built, plan)[-1]
