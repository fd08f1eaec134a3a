"""Breadth-first search, word by word, and the size of its tree."""

from __future__ import annotations

from oracles.board import Cells
from oracles.randomness import Generator
from oracles.tree import (
    Choice,
    Node,
    Task,
    best_nodes,
    cells_filled,
    check_at_least,
    children,
    worth_with_dead_ends_last,
)


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


def count_tree(task: Task, state: Cells, depth: int) -> int:
    """Number of tree nodes at depths 1..depth: what bfs evaluates when it stops nowhere early."""
    level = [Node(state, ())]
    count = 0
    for _ in range(depth):
        level = [child for node in level for child in children(task, node)]
        count += len(level)
    return count
