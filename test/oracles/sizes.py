"""Slow twin of the counts of states and sequences, on sets of cells: visits everything."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

Cells = frozenset[tuple[int, int]]


def children(
    built: Cells, target: Cells, blocks: list[tuple[int, int]], size: tuple[int, int]
) -> Iterator[Cells]:
    """Every state after one legal placement; one that is reached in two ways is there twice."""
    width, height = size
    for block_width, block_height in blocks:
        for left in range(width - block_width + 1):
            columns = range(left, left + block_width)
            row = max((r + 1 for c, r in built if c in columns), default=0)
            if row + block_height > height:
                continue
            block = {(c, r) for c in columns for r in range(row, row + block_height)}
            if block <= target:
                yield built | block


def sizes(
    target: Cells, blocks: list[tuple[int, int]], size: tuple[int, int]
) -> tuple[int, int, int]:
    """(states, sequences that end complete, sequences that end where nothing legal is left)."""
    layer: Counter[Cells] = Counter({frozenset(): 1})
    states: set[Cells] = set()
    complete = ended = 0
    while layer:
        states |= set(layer)
        complete += layer[target]
        following: Counter[Cells] = Counter()
        for built, ways in layer.items():
            after = list(children(built, target, blocks, size))
            ended += ways * (not after)
            for child in after:
                following[child] += ways
        layer = following
    return len(states), complete, ended
