"""Success where blocks slip, in exact fractions, by following every outcome of every order.

A state with a filled cell outside the region is over, as blocks are only added; all others are
followed to their ends.
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from functools import cache

from oracles.board import Cells, Placement, cells_of, drop, is_possible
from oracles.tree import Node, Path, Task, best_nodes, children, worth_with_dead_ends_last

Outcomes = dict[Placement | None, Fraction]


def outcomes(
    task: Task, state: Cells, order: Placement, slip: Fraction, loss: Fraction = Fraction(0)
) -> Outcomes:
    """Where the block of an order ends, with probabilities; None: nowhere, it is lost."""
    found: Counter[Placement | None] = Counter()
    found[None] += loss  # type: ignore[assignment]
    for shift, chance in ((0, 1 - slip), (-1, slip / 2), (1, slip / 2)):
        block = (order.width, order.height)
        column = order.column + shift
        landed = drop(state, block, column)
        if not is_possible(task.width, task.height, landed) or column < 0:
            landed = drop(state, block, order.column)
        found[landed] += (1 - loss) * chance  # type: ignore[assignment]
    return {place: Fraction(chance) for place, chance in found.items() if chance}


def optimum(task: Task, start: Cells, slip: Fraction) -> Fraction:
    """The highest probability of completing the region that orders can reach."""

    @cache
    def value(state: Cells) -> Fraction:
        if state == task.region or not state <= task.region:
            return Fraction(state == task.region)
        return max((after(order, state) for order in task.legal(state)), default=Fraction(0))

    def after(order: Placement, state: Cells) -> Fraction:
        found = outcomes(task, state, order, slip)
        return sum(
            (
                chance * value(state | cells_of(landed))
                for landed, chance in found.items()
                if landed
            ),
            Fraction(0),
        )

    return value(start)


def random_success(task: Task, start: Cells, slip: Fraction) -> Fraction:
    """The probability that legal orders, drawn uniformly, complete the region."""

    @cache
    def value(state: Cells) -> Fraction:
        if state == task.region or not state <= task.region:
            return Fraction(state == task.region)
        orders = task.legal(state)
        total = Fraction(0)
        for order in orders:
            for landed, chance in outcomes(task, state, order, slip).items():
                if landed is not None:
                    total += chance * value(state | cells_of(landed)) / len(orders)
        return total

    return value(start)


def bfs_success(task: Task, start: Cells, slip: Fraction, depth: int) -> Fraction:
    """The probability that breadth-first lookahead completes the region.

    The agent remembers the rest of a complete path and orders it until a block lands elsewhere.
    """

    @cache
    def value(state: Cells, rest: Path) -> Fraction:
        if state == task.region or not state <= task.region:
            return Fraction(state == task.region)
        total = Fraction(0)
        for order, later, weight in orders(state, rest):
            for landed, chance in outcomes(task, state, order, slip).items():
                if landed is not None:
                    kept = later if landed == order else ()
                    total += weight * chance * value(state | cells_of(landed), kept)
        return total

    def orders(state: Cells, rest: Path) -> list[tuple[Placement, Path, Fraction]]:
        if rest:
            return [(rest[0], rest[1:], Fraction(1))]
        return look_ahead(task, state, depth)

    return value(start, ())


def look_ahead(task: Task, state: Cells, depth: int) -> list[tuple[Placement, Path, Fraction]]:
    """What bfs may do: the order, the rest of a complete path, and its probability."""
    generated: list[Node] = []
    level = [Node(state, ())]
    for _ in range(depth):
        complete = [node for node in level if node.state == task.region]
        if complete:
            path = complete[0].path
            return [(path[0], path[1:], Fraction(1))]
        level = [child for node in level for child in children(task, node)]
        generated.extend(level)
    if not generated:
        return []
    votes = Counter(
        node.path[0] for node in best_nodes(task, generated, worth_with_dead_ends_last)
    )
    total = sum(votes.values())
    return [(order, (), Fraction(votes[order], total)) for order in votes]
