"""The tree that every search explores, word by word: tasks, nodes, and how a state is judged."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from oracles.board import Block, Cells, Placement, cells_of, legal_placements

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


def children(task: Task, node: Node) -> list[Node]:
    """The nodes one legal placement further, in generation order."""
    return [
        Node(node.state | cells_of(placement), (*node.path, placement))
        for placement in task.legal(node.state)
    ]


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


def check_at_least(name: str, value: int, least: int) -> None:
    """Raise ValueError when a setting is too small."""
    if value < least:
        raise ValueError(f'{name} must be at least {least}, got {value}')
