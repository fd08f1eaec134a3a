"""A trial without messages: a planner is asked, its plan carried out, and it is asked again.

The record is the one that :func:`blocks_planning.trials.local.run_trial` gives. An answer can be
used again in the next trial of the same task, search, seed and budget, whatever its strategy: a
solve depends on nothing else.
"""

from __future__ import annotations

from collections.abc import MutableMapping
from functools import lru_cache

from blocks_planning.board import rules
from blocks_planning.board.geometry import Mask
from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.decision import Decision, Query, Situation, Subgoal
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import status_of
from blocks_planning.worlds.observation import Observation, mask_of, standing

_status_of = lru_cache(maxsize=4096)(status_of)


def follow(spec: TrialSpec, answers: MutableMapping[Query, SolveResult]) -> TrialRecord:
    """Run a trial to its end.

    Args:
        spec: the trial.
        answers: what is known of this task, search, seed and budget; new answers are added. The
            record counts each as if it had been searched for again.

    Raises:
        ConfigurationError: for a strategy that asks a person, or a world that is observed.
        LimitExceeded: if the search has a limit of size and a problem is over it.
    """
    if not spec.world.simulates:
        raise ConfigurationError(f'world {spec.world.name} cannot be simulated')
    observations: list[Observation] = [Observation(landed=spec.built)]
    decisions: list[DecisionRecord] = []
    status = _status_of(spec.task, mask_of(spec.task.board, spec.built))
    while status is TrialStatus.BUILDING:
        situation = _situation(spec, observations, len(decisions), answers)
        decision = _decide(spec, situation, answers)
        start, executed = len(observations) - 1, 0
        built = situation.built
        if decision.chosen is None:
            status = TrialStatus.GAVE_UP
        for subgoal in decision.subgoals:
            executed += 1
            built = _carry_out(spec, built, subgoal, observations)
            status = _status_of(spec.task, built)
            if status is not TrialStatus.BUILDING or built != subgoal.target:
                break
        decisions.append(DecisionRecord(start, decision, executed))
    return TrialRecord(spec, status, tuple(observations), tuple(decisions))


def _situation(
    spec: TrialSpec,
    observations: list[Observation],
    decisions: int,
    answers: MutableMapping[Query, SolveResult],
) -> Situation:
    blocks = standing(observations)
    return Situation(
        task=spec.task,
        built=mask_of(spec.task.board, blocks),
        seed=spec.seed,
        known=answers,
        blocks=blocks,
        decisions=decisions,
    )


def _decide(
    spec: TrialSpec, situation: Situation, answers: MutableMapping[Query, SolveResult]
) -> Decision:
    while True:
        answer = spec.strategy.decide(situation)
        if isinstance(answer, Decision):
            return answer
        if not answer:
            raise ConfigurationError(f'strategy {spec.strategy.name} waits for a person')
        for query in answer:
            problem = Problem(spec.task, *query)
            answers[query] = solve(problem, spec.search, spec.seed, spec.budget)


def _carry_out(
    spec: TrialSpec, built: Mask, subgoal: Subgoal, observations: list[Observation]
) -> Mask:
    """Carry out what is to be executed of a plan, up to a surprise; return the state after it."""
    way = rules.states_along(spec.task.board, built, subgoal.placements[: subgoal.execute])
    for placed, expected in zip(subgoal.placements, way[1:], strict=False):
        if spec.world.obeys:
            observations.append(Observation(placed.placement, (placed,)))
            continue
        before = built
        while built == before:  # a lost block changes nothing, and is ordered again
            seen = spec.world.carry_out(
                spec.task, built, placed.placement, spec.seed, len(observations)
            )
            observations.append(seen)
            built |= mask_of(spec.task.board, seen.landed)
        if built != expected:
            return built
    return way[-1]
