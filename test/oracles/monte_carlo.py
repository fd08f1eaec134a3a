"""Monte Carlo tree search, word by word."""

from __future__ import annotations

import math

from oracles.board import Cells, place
from oracles.randomness import Generator
from oracles.tree import Choice, Task, check_at_least


class TreeNode:
    """A state in a Monte Carlo tree: its placements, those tried, its visits and rewards."""

    def __init__(self, task: Task, state: Cells) -> None:
        self.state = state
        self.legal = task.legal(state)
        self.tried: dict[int, TreeNode] = {}
        self.visits = 0
        self.cells = 0


def mcts_choice(
    task: Task, state: Cells, generator: Generator, *, iterations: int, exploration: float
) -> Choice:
    """Monte Carlo tree search; the most visited placement."""
    check_at_least('iterations', iterations, 1)
    root = TreeNode(task, state)
    cost = sum(iterate(task, root, generator, exploration) for _ in range(iterations))
    most = max(child.visits for child in root.tried.values())
    ties = [i for i in range(len(root.legal)) if i in root.tried and root.tried[i].visits == most]
    return Choice((root.legal[ties[generator.below(len(ties))]],), cost)


def iterate(task: Task, root: TreeNode, generator: Generator, exploration: float) -> int:
    """One walk through the tree, and what follows; the states evaluated."""
    way = [root]
    cost = 0
    while cost == 0 and way[-1].legal:
        node = way[-1]
        untried = [i for i in range(len(node.legal)) if i not in node.tried]
        if untried:
            index = untried[generator.below(len(untried))]
            node.tried[index] = TreeNode(task, place(node.state, [node.legal[index]]))
            cost = 1
        else:
            bounds = [
                upper_bound(task, node, node.tried[i], exploration) for i in range(len(node.legal))
            ]
            ties = [i for i, bound in enumerate(bounds) if bound == max(bounds)]
            index = ties[generator.below(len(ties))]
        way.append(node.tried[index])
    state = way[-1].state
    while placements := task.legal(state):
        state = place(state, [placements[generator.below(len(placements))]])
        cost += 1
    for node in way:
        node.visits += 1
        node.cells += len(state)
    return cost


def upper_bound(task: Task, parent: TreeNode, child: TreeNode, exploration: float) -> float:
    """The upper confidence bound of a child in the tree."""
    mean = child.cells / (child.visits * len(task.region))
    return mean + exploration * math.sqrt(natural_logarithm(parent.visits) / child.visits)


def natural_logarithm(number: int) -> float:
    """ln of m * 2**e, by the series of 2 atanh((m - 1) / (m + 1)) with 18 terms."""
    e = number.bit_length() - 1
    m = math.ldexp(number, -e)
    s = (m - 1) / (m + 1)
    series = 1 / 35
    for divisor in (33, 31, 29, 27, 25, 23, 21, 19, 17, 15, 13, 11, 9, 7, 5, 3, 1):
        series = series * (s * s) + 1 / divisor
    return e * 0.6931471805599453 + 2 * s * series
