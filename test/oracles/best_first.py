"""A* and best-first search, word by word."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from oracles.board import Block, Cells
from oracles.randomness import Generator
from oracles.tree import Choice, Node, Task, check_at_least, children


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
