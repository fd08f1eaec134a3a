"""Action-level search, word by word: random, bfs, astar, best_first, beam, mcts, and an
attempt of each.

The cost of a search is its number of states evaluated: every child state generated, counted as
often as it is generated.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from oracles.board import Block, Cells, Placement, cells_of, legal_placements, place
from oracles.randomness import Generator, attempt_generator

Path = tuple[Placement, ...]

DEAD_END = -1


@dataclass(frozen=True)
class Task:
    """What a search is asked: fill exactly `region` on this board with these blocks."""

    width: int
    height: int
    library: tuple[Block, ...]
    region: Cells

    def legal(self, state: Cells) -> list[Placement]:
        """The legal placements at `state`, in generation order."""
        return legal_placements(self.width, self.height, self.library, self.region, state)


@dataclass(frozen=True)
class Node:
    """One node of a search tree: the state reached and the placements that led there."""

    state: Cells
    path: Path


@dataclass(frozen=True)
class Choice:
    """What one search decided: the placements to execute now, and the states evaluated."""

    placements: Path
    cost: int


@dataclass(frozen=True)
class Attempt:
    """One attempt to fill a region: whether it did, all its placements, its cost [states]."""

    success: bool
    placements: Path
    cost: int


def children(task: Task, node: Node) -> list[Node]:
    """The nodes one legal placement further, in generation order."""
    return [
        Node(node.state | cells_of(placement), (*node.path, placement))
        for placement in task.legal(node.state)
    ]


def random_choice(task: Task, state: Cells, generator: Generator) -> Choice:
    """One legal placement, uniformly; nothing is evaluated."""
    placements = task.legal(state)
    return Choice((placements[generator.below(len(placements))],), 0)


def bfs_choice(
    task: Task, state: Cells, generator: Generator, *, depth: int, dead_ends: str = 'worst'
) -> Choice:
    """Breadth-first lookahead of `depth` levels (at least 1).

    dead_ends: 'worst' to rank a state without a legal placement last, 'ignored' to rank every
    state by the cells filled alone.
    """
    check_at_least('depth', depth, 1)
    if dead_ends not in ('worst', 'ignored'):
        raise ValueError(f"dead_ends must be 'worst' or 'ignored', got {dead_ends!r}")
    generated: list[Node] = []
    level = [Node(state, ())]
    for _ in range(depth):
        next_level: list[Node] = []
        for node in level:
            if node.state == task.region:
                return Choice(node.path, len(generated))
            new = children(task, node)
            generated.extend(new)
            next_level.extend(new)
        level = next_level
    worth = worth_with_dead_ends_last if dead_ends == 'worst' else cells_filled
    best = best_nodes(task, generated, worth)
    chosen = best[generator.below(len(best))]
    return Choice(chosen.path[:1], len(generated))


def best_nodes(
    task: Task, nodes: Sequence[Node], worth: Callable[[Task, Cells], float]
) -> list[Node]:
    """The nodes of highest worth, in the order they came."""
    worths = [worth(task, node.state) for node in nodes]
    best = max(worths)
    return [node for node, value in zip(nodes, worths, strict=True) if value == best]


def cells_filled(task: Task, state: Cells) -> float:
    """How bfs judges a state if it ignores dead ends; a complete state has all cells filled."""
    return len(state)


def worth_with_dead_ends_last(task: Task, state: Cells) -> float:
    """How bfs judges a state: complete is best, a dead end worst, else the cells filled."""
    if state == task.region:
        return math.inf
    if not task.legal(state):
        return DEAD_END
    return len(state)


def count_tree(task: Task, state: Cells, depth: int) -> int:
    """Number of tree nodes at depths 1..depth: what bfs evaluates when it stops nowhere early."""
    level = [Node(state, ())]
    count = 0
    for _ in range(depth):
        level = [child for node in level for child in children(task, node)]
        count += len(level)
    return count


class Queue:
    """Nodes in one list for each distinct f; equals are taken uniformly at random."""

    def __init__(self) -> None:
        self.lists: dict[float, list[Node]] = {}

    def add(self, f: float, node: Node) -> None:
        """Append a node to the list of its f."""
        self.lists.setdefault(f, []).append(node)

    def is_empty(self) -> bool:
        """Whether no list holds a node."""
        return not any(self.lists.values())

    def take(self, generator: Generator) -> Node:
        """Take a random node of the lowest f; the last node of its list fills its place."""
        nodes = self.lists[min(f for f, nodes in self.lists.items() if nodes)]
        index = generator.below(len(nodes))
        taken = nodes[index]
        nodes[index] = nodes[-1]
        nodes.pop()
        return taken


def f_smallest(library: Sequence[Block], g: int, left: int) -> float:
    """The f = g + left / smallest block area, a float like all f."""
    return g + left / min(width * height for width, height in library)


def f_largest(library: Sequence[Block], g: int, left: int) -> float:
    """The f = g + left / largest block area."""
    return g + left / max(width * height for width, height in library)


def f_mean(library: Sequence[Block], g: int, left: int) -> float:
    """The f = g + left / mean block area."""
    mean = sum(width * height for width, height in library) / len(library)
    return g + left / mean


def f_left_only(library: Sequence[Block], g: int, left: int) -> float:
    """Cells left, whatever the number of blocks placed."""
    return left


DIVISORS = {'smallest': f_smallest, 'mean': f_mean, 'largest': f_largest}


def astar_choice(
    task: Task,
    state: Cells,
    generator: Generator,
    *,
    iterations: int,
    divisor: str = 'smallest',
    execute: str = 'first',
) -> Choice:
    """A* of a number of iterations (at least 2); divisor: smallest, mean or largest.

    execute: 'first' for the first placement of the resulting path, 'path' for all of it.
    """
    f_of = DIVISORS[divisor]
    return take_in_order_of_f(task, state, generator, f_of, iterations, execute)


def best_first_choice(
    task: Task, state: Cells, generator: Generator, *, iterations: int, execute: str = 'first'
) -> Choice:
    """A* with the number of blocks placed left out of f."""
    return take_in_order_of_f(task, state, generator, f_left_only, iterations, execute)


def take_in_order_of_f(
    task: Task,
    state: Cells,
    generator: Generator,
    f_of: Callable[[Sequence[Block], int, int], float],
    iterations: int,
    execute: str,
) -> Choice:
    """The loop that astar and best_first share."""
    check_at_least('iterations', iterations, 2)
    if execute not in ('first', 'path'):
        raise ValueError(f"execute must be 'first' or 'path', got {execute!r}")

    def f(node: Node) -> float:
        return f_of(task.library, len(node.path), len(task.region - node.state))

    queue = Queue()
    taken = Node(state, ())
    queue.add(f(taken), taken)
    cost = 0
    for _ in range(iterations):
        if queue.is_empty():
            break
        taken = queue.take(generator)
        if taken.state == task.region:
            return Choice(taken.path, cost)
        for child in children(task, taken):
            queue.add(f(child), child)
            cost += 1
    return Choice(taken.path[:1] if execute == 'first' else taken.path, cost)


def check_at_least(name: str, value: int, least: int) -> None:
    """Raise ValueError when a setting is too small."""
    if value < least:
        raise ValueError(f'{name} must be at least {least}, got {value}')


def beam_choice(task: Task, state: Cells, generator: Generator, *, width: int) -> Choice:
    """Beam search; the path to the best state seen.

    Of states with equally many cells at the edge of the beam, each in turn is kept if a number
    below those that are left is below the places that are left; no number is drawn once no place
    is left, or if there is a place for each.
    """
    check_at_least('width', width, 1)
    level = [Node(state, ())]
    kept = list(level)
    cost = 0
    while not any(node.state == task.region for node in level):
        generated = [child for node in level for child in children(task, node)]
        if not generated:
            break
        cost += len(generated)
        level = keep_best(generated, width, generator)
        kept.extend(level)
    best = best_nodes(task, kept, cells_filled)
    return Choice(best[generator.below(len(best))].path, cost)


def keep_best(nodes: Sequence[Node], width: int, generator: Generator) -> list[Node]:
    """The `width` nodes with most cells, in the order they came; ties uniformly."""
    sizes = sorted((len(node.state) for node in nodes), reverse=True)
    edge = sizes[:width][-1]
    places = width - sum(size > edge for size in sizes)
    left = sum(size == edge for size in sizes)
    everyone = left <= places
    kept = []
    for node in nodes:
        if len(node.state) == edge:
            lucky = everyone or (places > 0 and generator.below(left) < places)
            left -= 1
            if not lucky:
                continue
            places -= 1
        if len(node.state) >= edge:
            kept.append(node)
    return kept


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


SEARCHES: dict[str, Callable[..., Choice]] = {
    'random': random_choice,
    'bfs': bfs_choice,
    'astar': astar_choice,
    'best_first': best_first_choice,
    'beam': beam_choice,
    'mcts': mcts_choice,
}


def run_attempt(
    task: Task, state: Cells, generator: Generator, search: str, **settings: Any
) -> Attempt:
    """Search and execute until the region is filled or nothing legal is left."""
    choose = SEARCHES[search]
    placements: list[Placement] = []
    cost = 0
    while state != task.region and task.legal(state):
        choice = choose(task, state, generator, **settings)
        state = place(state, choice.placements)
        placements.extend(choice.placements)
        cost += choice.cost
    return Attempt(state == task.region, tuple(placements), cost)


def attempt(
    width: int,
    height: int,
    library: Sequence[Block],
    region: Cells,
    built: Cells,
    seed: int,
    number: int,
    /,
    *,
    search: str,
    **settings: Any,
) -> Attempt:
    """Attempt `number` to fill `region` from `built`, with the generator that belongs to it."""
    task = Task(width, height, tuple(library), region)
    generator = attempt_generator(seed, built, region, height, number)
    return run_attempt(task, built, generator, search, **settings)
