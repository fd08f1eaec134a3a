"""A trial without messages: the planner decides, its plan is executed, and so on.

The record is the one that :func:`blocks_planning.trials.local.run_trial` gives. Answers can be
reused in later trials with the same task, search, seed and budget and any strategy: a
solve depends on nothing else.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Iterable
from dataclasses import dataclass, field

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placement
from blocks_planning.errors import ConfigurationError
from blocks_planning.external import refuse_external
from blocks_planning.search.many import solve_many
from blocks_planning.search.result import Problem, SolveResult
from blocks_planning.subgoals.decision import Decision, Query, Situation, Subgoal, Weighed
from blocks_planning.trials.record import DecisionRecord, TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.world import TOO_MANY, status_of
from blocks_planning.worlds.observation import MAX_OBSERVATIONS, Blocks, Observation, mask_of


@dataclass(frozen=True)
class Shared:
    """What trials of one task, search, seed and budget share.

    Attributes:
        answers: to queries.
        weighed: chains whose queries are all answered.
    """

    answers: dict[Query, SolveResult] = field(default_factory=dict)
    weighed: dict[Hashable, Weighed] = field(default_factory=dict)


def follow(spec: TrialSpec, shared: Shared | None = None, workers: int = 1) -> TrialRecord:
    """Run a trial to its end.

    Args:
        spec: the trial.
        shared: of trials of this task, search, seed and budget; what is new is added. The record
            counts the cost of a known answer as if it had been computed again.
        workers: threads that solve the queries of a decision; 1 where processes run side by side.

    Raises:
        ConfigurationError: for a strategy that asks a person, another program, or a world that is observed.
        LimitExceeded: if a problem exceeds a size limit of the search.
    """
    if not spec.world.simulates:
        raise ConfigurationError(f'world {spec.world.name} cannot be simulated')
    board, shared = _Board(spec), shared or Shared()
    decisions: list[DecisionRecord] = []
    status, reason = board.status(), ''
    while status is TrialStatus.BUILDING:
        decision = _decide(spec, board.situation(len(decisions), shared), shared, workers)
        start, executed = len(board.observations) - 1, 0
        if decision.chosen is None:
            status = TrialStatus.GAVE_UP
        for subgoal in decision.subgoals:
            executed += 1
            status, goes_on = board.carry_out(subgoal)
            if status is not TrialStatus.BUILDING or not goes_on:
                break
        decisions.append(DecisionRecord(start, decision, executed))
    if status is TrialStatus.CANCELLED:
        reason = TOO_MANY
    observations = tuple(board.observations)
    return TrialRecord(spec, status, observations, tuple(decisions), reason=reason)


def run_trials(specs: Iterable[TrialSpec], workers: int = 1) -> list[TrialRecord]:
    """Run trials one after the other. Trials of one task, search, seed and budget share solves.

    Args:
        specs: the trials.
        workers: threads that solve the queries of a decision.

    Raises:
        ConfigurationError: for a strategy that asks a person, another program, or a world that is observed.
        LimitExceeded: if a problem exceeds a size limit of the search.
    """
    shared: defaultdict[object, Shared] = defaultdict(Shared)
    return [
        follow(spec, shared[spec.task, spec.search, spec.seed, spec.budget], workers)
        for spec in specs
    ]


def decide(spec: TrialSpec, workers: int = 1) -> Decision:
    """The first decision of a trial, on the board on which it begins: all candidates, the choice.

    Raises:
        ConfigurationError: for a strategy that asks a person, or another program.
        LimitExceeded: if a problem exceeds a size limit of the search.
    """
    shared = Shared()
    return _decide(spec, _Board(spec).situation(0, shared), shared, workers)


class _Board:
    """The board of a trial, as observed in its world."""

    def __init__(self, spec: TrialSpec) -> None:
        self._spec = spec
        self.observations = [Observation(landed=spec.built)]
        self._blocks = spec.built
        self._built = mask_of(spec.task.board, spec.built)

    def status(self) -> TrialStatus:
        """The status of the board."""
        return status_of(self._spec, self._blocks, self._built)

    def situation(self, decisions: int, shared: Shared) -> Situation:
        """The situation for the next decision."""
        return Situation(
            task=self._spec.task,
            built=self._built,
            seed=self._spec.seed,
            known=shared.answers,
            blocks=self._blocks,
            decisions=decisions,
            plans_on_blocks=self._spec.plans_on_blocks,
            weighed=shared.weighed,
        )

    def carry_out(self, subgoal: Subgoal) -> tuple[TrialStatus, bool]:
        """Execute a subgoal; return the status, and whether the next subgoal may follow."""
        spec = self._spec
        plan = subgoal.placements[: subgoal.execute]
        if spec.world.obeys:
            self._see([Observation(placed.placement, (placed,)) for placed in plan], plan)
            return self.status(), self._built == subgoal.target
        for placed in plan:
            if rules.drop(spec.task.board, self._built, placed.placement) is None:
                return self.status(), False  # only with a blind plan
            before = self._built
            status = TrialStatus.BUILDING
            while self._built == before and status is TrialStatus.BUILDING:
                status = self._order(placed.placement)
            if status is not TrialStatus.BUILDING:
                return status, False
            expected = before | rules.cells_of(spec.task.board, placed)
            if self._built != expected and not spec.strategy.is_blind:
                return status, False
        return self.status(), self._built == subgoal.target or spec.strategy.is_blind

    def _order(self, placement: Placement) -> TrialStatus:
        """Give one order, or cancel the trial if the limit of observations is reached."""
        spec = self._spec
        if len(self.observations) >= MAX_OBSERVATIONS:
            return TrialStatus.CANCELLED
        seen = spec.world.carry_out(
            spec.task, self._built, placement, spec.seed, len(self.observations)
        )
        self._see([seen], seen.landed)
        return self.status()

    def _see(self, observations: list[Observation], landed: Blocks) -> None:
        self.observations += observations
        self._blocks += landed
        self._built |= mask_of(self._spec.task.board, landed)


def _decide(spec: TrialSpec, situation: Situation, shared: Shared, workers: int) -> Decision:
    refuse_external(strategy=spec.strategy, search=spec.search)
    while True:
        answer = spec.strategy.decide(situation)
        if isinstance(answer, Decision):
            return answer
        if not answer:
            raise ConfigurationError(f'strategy {spec.strategy.name} needs a person')
        problems = [Problem(spec.task, *query) for query in answer]
        results = solve_many(problems, spec.search, spec.seed, spec.budget, workers=workers)
        shared.answers.update(zip(answer, results, strict=True))
