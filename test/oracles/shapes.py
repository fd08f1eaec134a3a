"""Measures of a silhouette, on plain sets of cells."""

from __future__ import annotations

from oracles.board import Cells


def measures(width: int, height: int, cells: Cells) -> dict[str, int]:
    """The measures by name."""
    empty = {(c, r) for c in range(width) for r in range(height)} - cells
    tops = [max((r + 1 for c, r in cells if c == column), default=0) for column in range(width)]
    shut_in = [group for group in groups(empty) if all(r < height - 1 for _, r in group)]
    hanging = sorted((r, c) for c, r in cells if r > 0 and (c, r - 1) not in cells)
    stretches = 0
    last = None
    for r, c in hanging:
        if last != (r, c - 1):
            stretches += 1
        last = (r, c)
    columns = [c for c, _ in cells]
    return {
        'cells': len(cells),
        'width': max(columns) - min(columns) + 1 if columns else 0,
        'height': max(tops),
        'holes': len(shut_in),
        'hole_cells': sum(len(group) for group in shut_in),
        'overhangs': stretches,
        'covered_cells': sum(
            any(c == column and r > row for c, r in cells) for column, row in empty
        ),
        'roughness': sum(abs(tops[i] - tops[i + 1]) for i in range(width - 1)),
    }


def groups(cells: set[tuple[int, int]]) -> list[set[tuple[int, int]]]:
    """Cells that share edges, together."""
    left = set(cells)
    found = []
    while left:
        waiting = [left.pop()]
        group = set(waiting)
        while waiting:
            c, r = waiting.pop()
            for near in ((c + 1, r), (c - 1, r), (c, r + 1), (c, r - 1)):
                if near in left:
                    left.remove(near)
                    group.add(near)
                    waiting.append(near)
        found.append(group)
    return found
