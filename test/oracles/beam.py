"""Beam search, word by word."""

from __future__ import annotations

from collections.abc import Sequence

from oracles.board import Cells
from oracles.randomness import Generator
from oracles.tree import Choice, Node, Task, best_nodes, cells_filled, check_at_least, children


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
