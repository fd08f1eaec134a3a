"""The exact success and cost of an action-level search, without sampling.

One attempt of ``bfs`` or ``random`` is a random walk: in every state it evaluates a number of
states that depends only on that state, and chooses a placement with known probabilities (for bfs
the share of best tree nodes behind each first placement). A dynamic program over the states that
the walk can reach, by rising number of filled cells, therefore gives the joint distribution of cost
and success of an attempt. States with the same shadow and equally many filled cells have the same
continuations and are merged.

Probabilities are float64 sums of products: exact except for rounding, about 1e-12. Costs are
distinguished to the single state [states]; costs at or above the budget are merged, because all of
them end a solve. The number of attempts within the budget follows from a renewal sum over the costs
of failed attempts, computed with fast Fourier transforms, which adds rounding of about 1e-12.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.geometry import area
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.attempt_costs import Arrivals, Costs, expected_attempts
from blocks_planning.search.choices import (
    CHUNK,
    Chooser,
    chunks_of,
    join_layers,
    layer_of,
    spread_at_random,
)
from blocks_planning.search.gauge import Gauge
from blocks_planning.search.result import DEFAULT_BUDGET, MAX_BUDGET, CancelToken, Problem
from blocks_planning.search.searches import BreadthFirst, RandomPlacement, Search
from blocks_planning.settings import check_whole

MAX_STATES = 2_000_000
"""Default of the largest number of states that the dynamic program examines."""
MAX_COSTS = 40_000_000
"""Largest number of costs stored at a time, over all states, 16 bytes each: 640 MB."""
MAX_EXACT_BUDGET = 10_000_000
"""Largest budget for which costs are distinguished to the single state [states]."""


@dataclass(frozen=True)
class ExactPolicy:
    """Exact values of a search on a problem.

    Attributes:
        success: probability that one attempt fills the region.
        cost: expected cost of an attempt [states].
        cost_of_success: expected cost of an attempt that succeeds [states]; None if none can.
        within_budget: probability that a solve succeeds, attempt after attempt, within ``budget``.
        budget: b [states].
        states: number of states that the dynamic program examined.
    """

    success: float
    cost: float
    cost_of_success: float | None
    within_budget: float
    budget: int
    states: int


def analyse_policy(
    problem: Problem,
    search: Search,
    budget: int = DEFAULT_BUDGET,
    limit: int = MAX_STATES,
    cancel: CancelToken | None = None,
    gauge: Gauge | None = None,
) -> ExactPolicy | None:
    """The exact values of bfs or random on a problem; None if cancelled.

    Args:
        problem: state and region.
        search: bfs or random.
        budget: b [states].
        limit: largest number of states that the dynamic program examines.
        cancel: ends it from another thread.
        gauge: shows the progress; a step is a number of filled cells.

    Raises:
        ConfigurationError: for another search, or a budget out of its range.
        LimitExceeded: if more states can be reached than ``limit``, or more than ``MAX_COSTS``
            costs would have to be stored at a time.
    """
    cancel, gauge = cancel or CancelToken(), gauge or Gauge()
    gauge.total = area(problem.region) - area(problem.built)
    if isinstance(search, RandomPlacement):
        check_whole('budget', budget, 0, MAX_BUDGET)
        return _analyse_random(problem, budget, limit, cancel, gauge)
    if not isinstance(search, BreadthFirst):
        raise ConfigurationError(
            f'search must be bfs or random for exact values, got {search.name!r}'
        )
    check_whole('budget', budget, 0, MAX_EXACT_BUDGET)
    program = _Program(problem, search, budget, limit, cancel, gauge)
    if not program.run():
        return None
    won, lost = program.won, program.lost
    within = (
        min(1.0, won.probability * expected_attempts(lost, budget)) if won.probability else 0.0
    )
    return ExactPolicy(
        success=won.probability,
        cost=won.expected + lost.expected,
        cost_of_success=won.expected / won.probability if won.probability else None,
        within_budget=within,
        budget=budget,
        states=program.states,
    )


def _analyse_random(
    problem: Problem, budget: int, limit: int, cancel: CancelToken, gauge: Gauge
) -> ExactPolicy | None:
    """The success of random placement, whose cost is 0.

    Only states from which the region can still be filled are expanded, many at a time.
    """
    layers = {area(problem.built): [layer_of(problem)]}
    target = area(problem.region)
    for filled in range(area(problem.built), target):
        for chunk in chunks_of(join_layers(layers.pop(filled))) if filled in layers else ():
            if cancel.cancelled:
                return None
            gauge.states += len(chunk.chances)
            if gauge.states > limit:
                raise _too_large(problem, 'random', limit)
            for after, part in spread_at_random(problem, filled, chunk).items():
                parts = layers.setdefault(after, [])
                parts.append(part)
                if sum(len(one.chances) for one in parts) > max(limit, CHUNK):
                    parts[:] = [join_layers(parts)]
                    if after < target and gauge.states + len(parts[0].chances) > limit:
                        raise _too_large(problem, 'random', limit)
        gauge.done += 1
    success = float(sum(part.chances.sum() for part in layers.get(target, [])))
    return ExactPolicy(
        success=success,
        cost=0.0,
        cost_of_success=0.0 if success else None,
        within_budget=1 - (1 - success) ** max(1, budget),
        budget=budget,
        states=gauge.states,
    )


def _too_large(problem: Problem, name: str, limit: int) -> LimitExceeded:
    board = problem.task.board
    return LimitExceeded(
        f'exact-policy: {name} can reach more than the limit of {limit} states on this '
        f'silhouette of {board.width} x {board.height} cells'
    )


def _too_many_costs(problem: Problem, name: str) -> LimitExceeded:
    board = problem.task.board
    return LimitExceeded(
        f'exact-policy: {name} on this silhouette of {board.width} x {board.height} cells needs '
        f'to store more than the limit of {MAX_COSTS} costs; use a smaller budget'
    )


class _Program:
    """The dynamic program; ``won`` and ``lost`` are the ends of an attempt."""

    def __init__(
        self,
        problem: Problem,
        search: BreadthFirst,
        budget: int,
        limit: int,
        cancel: CancelToken,
        gauge: Gauge,
    ) -> None:
        self._problem = problem
        self._search = search
        self._budget = budget
        self._limit = limit
        self._cancel = cancel
        self._gauge = gauge
        self._kept = 1
        self.won, self.lost = Arrivals(), Arrivals()
        self.states = 0

    def run(self) -> bool:
        """Go through all states by rising number of filled cells; False if cancelled."""
        problem = self._problem
        start = Arrivals()
        start.add(1.0, 0.0, Costs(np.zeros(1, np.int64), np.ones(1)))
        shadow = rules.shadow(problem.task.board, problem.built)
        target = area(problem.region)
        layers: dict[int, dict[int, Arrivals]] = {area(problem.built): {shadow: start}}
        chooser = Chooser(problem.task, problem.region, self._search, self._cancel)
        for filled in range(area(problem.built), target):
            for state, arrivals in layers.pop(filled, {}).items():
                self.states += 1
                self._gauge.states = self.states
                if self.states > self._limit:
                    raise _too_large(problem, self._search.name, self._limit)
                if not self._leave(chooser, state, filled, arrivals, layers):
                    return False
                self._kept -= arrivals.size
                if self._kept > MAX_COSTS:
                    raise _too_many_costs(problem, self._search.name)
            self._gauge.done += 1
        for arrivals in layers.get(target, {}).values():
            self.won.add(arrivals.probability, arrivals.expected, arrivals.costs())
        return True

    def _leave(
        self,
        chooser: Chooser,
        shadow: int,
        filled: int,
        arrivals: Arrivals,
        layers: dict[int, dict[int, Arrivals]],
    ) -> bool:
        """Pass the probabilities of a state on to its successors; False if cancelled."""
        choices = chooser.choices(shadow, filled)
        if choices is None:
            return False
        probability = arrivals.probability
        expected = arrivals.expected + probability * choices.evaluated
        before = arrivals.costs()
        cost = np.minimum(before.cost + choices.evaluated, self._budget)
        after = Costs(cost, before.probability)
        if choices.complete:
            self.won.add(probability, expected, after)
        elif not choices.ways:
            self.lost.add(probability, expected, after)
        total = sum(way.weight for way in choices.ways)
        for way in choices.ways:
            share = way.weight / total
            layer = layers.setdefault(way.filled, {})
            there = layer.setdefault(way.shadow, Arrivals())
            part = Costs(after.cost, after.probability * share)
            there.add(probability * share, expected * share, part)
            self._kept += len(part.cost)
        return True
