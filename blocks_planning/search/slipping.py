"""Success in a world where blocks slip, without sampling: of the best policy, bfs and random.

A policy orders a legal placement in every state, and the world responds according to
:func:`blocks_planning.board.slipping.landings`. V(s) is the probability that the region is
filled in the end: the largest, over legal placements a, of the sum of P(s'|s, a) V(s'); 1 where
the region is filled, and 0 where it can't be filled any more. Blocks are only added, so one pass
from the most filled state to the least is exact except for rounding (about 1e-12). A lost
order is repeated, so losses change nothing.

``random`` orders a legal placement, uniformly. ``bfs`` looks ahead in every state and orders one
first placement, as in :mod:`.policy`. When it expands a complete state it has a path: it orders
the placements of the path until a block lands elsewhere, and then looks ahead again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Mask
from blocks_planning.board.slipping import check_probability, landings
from blocks_planning.search.kernels import lookahead
from blocks_planning.search.kernels.slipping import Plans, evaluate, follow_plans, plan_ahead
from blocks_planning.search.reachable import (
    MAX_STATES,
    Reachable,
    Report,
    find_reachable,
    say_nothing,
)
from blocks_planning.search.result import CancelToken, Problem
from blocks_planning.search.searches import BreadthFirst

_ORDER_PER_STEP = 20_000
_ENTRIES_AT_FIRST = 1 << 16


@dataclass(frozen=True)
class SlipChances:
    """Success in a world where blocks slip.

    Attributes:
        slip: probability that a block lands one column off.
        optimum: probability that the best policy fills the region.
        bfs: the same for one attempt of breadth-first lookahead.
        random: the same for one attempt of random placement.
        states: number of states from which the region could still be filled.
    """

    slip: float
    optimum: float
    bfs: float
    random: float
    states: int


@dataclass(frozen=True)
class OptimalValue:
    """The success of the best policy, and the number of examined states."""

    success: float
    states: int


class OptimalPolicy:
    """The best policy for a problem and a slip, in any state that orders can lead to.

    Attributes:
        states: number of states from which the region could still be filled.
    """

    def __init__(self, reachable: Reachable, slip: float, values: np.ndarray) -> None:
        """Use the probabilities of success by number of state, float64 (n,)."""
        self._reachable = reachable
        self._slip = slip
        self.states = reachable.count - 1
        self._values = values

    def success(self, built: Mask) -> float:
        """The probability to fill the region from a state; 0 for one that is not alive."""
        return float(self._values[self._reachable.number(built)])

    def order(self, built: Mask) -> Placed | None:
        """The placement to order: the first legal one among the best; None if none can succeed.

        It is returned as it comes to rest if the block does not slip.
        """
        problem = self._reachable.problem
        best, most = None, 0.0
        for placed in rules.legal_placements(problem.task, built, problem.region):
            chance = self._after(built, placed)
            if chance > most:
                best, most = placed, chance
        return best

    def _after(self, built: Mask, placed: Placed) -> float:
        board = self._reachable.problem.task.board
        chance = 0.0
        for landing in landings(board, built, placed.placement, self._slip):
            if landing.placed is not None:
                state = built | rules.cells_of(board, landing.placed)
                chance += landing.probability * self.success(state)
        return chance


def optimal_success(
    problem: Problem,
    slip: float,
    limit: int = MAX_STATES,
    cancel: CancelToken | None = None,
    report: Report = say_nothing,
) -> OptimalValue | None:
    """The highest probability of filling the region that any policy can reach.

    Returns:
        The value; None if cancelled.

    Raises:
        ConfigurationError: if the slip is not from 0 to 1.
        LimitExceeded: if there are more states than ``limit``.
    """
    policy = optimal_policy(problem, slip, limit, cancel, report)
    if policy is None:
        return None
    return OptimalValue(policy.success(problem.built), policy.states)


def optimal_policy(
    problem: Problem,
    slip: float,
    limit: int = MAX_STATES,
    cancel: CancelToken | None = None,
    report: Report = say_nothing,
) -> OptimalPolicy | None:
    """The policy that reaches :func:`optimal_success`; None if cancelled."""
    check_probability('slip', slip)
    cancel = cancel or CancelToken()
    reachable = find_reachable(problem, limit, cancel, report)
    if reachable is None:
        return None
    chances = _best_and_random(reachable, np.array([slip], float), cancel, report)
    return None if chances is None else OptimalPolicy(reachable, slip, chances[0][:, 0])


def analyse_slips(
    problem: Problem,
    slips: Sequence[float],
    search: BreadthFirst | None = None,
    limit: int = MAX_STATES,
    cancel: CancelToken | None = None,
    report: Report = say_nothing,
) -> list[SlipChances] | None:
    """Success of the best policy, bfs and random at several slips; None if cancelled.

    The states are found once for all slips.

    Args:
        problem: state and region.
        slips: probabilities that a block lands one column off, at least one.
        search: bfs with its depth; by default bfs with its default depth.
        limit: largest number of states.
        cancel: ends it from another thread.
        report: called with the progress.

    Raises:
        ConfigurationError: if a slip is not from 0 to 1.
        LimitExceeded: if there are more states than ``limit``.
    """
    for slip in slips:
        check_probability('slip', slip)
    cancel = cancel or CancelToken()
    array = np.array(slips, float)
    reachable = find_reachable(problem, limit, cancel, report)
    if reachable is None:
        return None
    chances = _best_and_random(reachable, array, cancel, report)
    if chances is None:
        return None
    looking = _breadth_first(reachable, search or BreadthFirst(), array, cancel, report)
    if looking is None:
        return None
    start = reachable.number(problem.built)
    best, mean = chances
    return [
        SlipChances(
            slip=slip,
            optimum=float(best[start, k]),
            bfs=float(looking[start, k]),
            random=float(mean[start, k]),
            states=reachable.count - 1,
        )
        for k, slip in enumerate(slips)
    ]


def _best_and_random(
    reachable: Reachable, slips: np.ndarray, cancel: CancelToken, report: Report
) -> tuple[np.ndarray, np.ndarray] | None:
    """The chances of the best policy and of random by state, float64 (n, slips) each."""
    best, mean = (_only_complete(reachable, slips) for _ in range(2))

    def step(order: np.ndarray, start: int) -> int:
        return int(evaluate(reachable.space, order, start, slips, best, mean, cancel.flag))

    finished = _in_steps('optimum', reachable.falling, step, cancel, report)
    return (best, mean) if finished else None


def _breadth_first(
    reachable: Reachable,
    search: BreadthFirst,
    slips: np.ndarray,
    cancel: CancelToken,
    report: Report,
) -> np.ndarray | None:
    """The chances of bfs by state, float64 (n, slips); 0 for states that it cannot reach."""
    plans = _plan(reachable, search, bool(slips.any()), cancel, report)
    if plans is None:
        return None
    values, reaching = _only_complete(reachable, slips), np.zeros(len(slips))

    def step(order: np.ndarray, start: int) -> int:
        space = reachable.space
        done = follow_plans(space, order, start, slips, plans, values, reaching, cancel.flag)
        return int(done)

    finished = _in_steps('bfs', reachable.falling, step, cancel, report)
    return values if finished else None


def _plan(
    reachable: Reachable, search: BreadthFirst, slipping: bool, cancel: CancelToken, report: Report
) -> Plans | None:
    """The choices of bfs in every state that it can reach; None if cancelled."""
    count, tables = reachable.count, reachable.space.tables
    most = len(tables.area) * (len(reachable.space.child) - 2) + search.depth
    plans = Plans(
        wanted=np.zeros(count, np.uint8),
        is_path=np.zeros(count, np.uint8),
        begin=np.zeros(count, np.int64),
        end=np.zeros(count, np.int64),
        moves=np.zeros(max(_ENTRIES_AT_FIRST, 2 * most), np.int64),
        weights=np.zeros(max(_ENTRIES_AT_FIRST, 2 * most), np.int64),
        state=np.zeros_like(tables.legal[:1]),
        move=np.zeros(most, np.int64),
        weight=np.zeros(most, np.int64),
    )
    plans.wanted[reachable.number(reachable.problem.built)] = 1
    rising = np.ascontiguousarray(reachable.falling[::-1])
    memory = lookahead.make_search(tables, search.depth, search.dead_ends_last)
    done = written = 0
    while done < len(rising):
        report('plans', done, len(rising))
        end = rising[: done + _ORDER_PER_STEP]
        before = done
        done, written = plan_ahead(
            memory, reachable.space, end, before, slipping, plans, written, cancel.flag
        )
        if cancel.cancelled:
            return None
        if done < len(end):
            plans = plans._replace(
                moves=np.concatenate([plans.moves, np.zeros_like(plans.moves)]),
                weights=np.concatenate([plans.weights, np.zeros_like(plans.weights)]),
            )
    return plans


def _only_complete(reachable: Reachable, slips: np.ndarray) -> np.ndarray:
    """Initial chances by state, float64 (n, slips): 1 for the complete state, 0 for all others."""
    values = np.zeros((reachable.count, len(slips)))
    if reachable.complete:
        values[reachable.complete] = 1.0
    return values


def _in_steps(
    stage: str,
    order: np.ndarray,
    step: Callable[[np.ndarray, int], int],
    cancel: CancelToken,
    report: Report,
) -> bool:
    """Process an order in parts; False if cancelled."""
    done = 0
    while done < len(order):
        report(stage, done, len(order))
        done = step(order[: done + _ORDER_PER_STEP], done)
        if cancel.cancelled:
            return False
    return True
