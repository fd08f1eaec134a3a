"""Looking ahead over sequences of subgoals, and choosing by probability, word by word.

Every sequence is written out, and every solve is made again for every sequence that asks it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from oracles.board import Block, Cells, rows
from oracles.decisions import region_heights
from oracles.randomness import Generator, key_from_words, mask_of, words_of
from oracles.regions import rectangles
from oracles.solving import SOLVED, solve

Ways = Callable[[Cells], list[Cells]]


@dataclass(frozen=True)
class Weighed:
    """A sequence of subgoals: its regions, r [cells], c [states], V (None: unsolved), status."""

    regions: tuple[Cells, ...]
    cells: int
    cost: int
    value: float | None
    status: str


def ways_by_rows(height: int, silhouette: Cells) -> Ways:
    """The regions of a state, as rows."""
    return lambda built: [rows(silhouette, k) for k in region_heights(silhouette, height, built)]


def ways_by_rectangles(
    width: int, height: int, silhouette: Cells, min_cells: int, max_cells: int
) -> Ways:
    """The regions of a state, as rectangles."""
    return lambda built: [
        cells for _, cells in rectangles(width, height, silhouette, built, min_cells, max_cells)
    ]


def sequences(
    ways: Ways, silhouette: Cells, built: Cells, horizon: int
) -> list[tuple[Cells, ...]]:
    """Every sequence of `horizon` regions, and every shorter one that completes the silhouette."""
    grown: list[tuple[Cells, ...]] = [()]
    finished: list[tuple[Cells, ...]] = []
    order: dict[tuple[Cells, ...], tuple[int, ...]] = {(): ()}
    for length in range(1, horizon + 1):
        longer: list[tuple[Cells, ...]] = []
        for sequence in grown:
            for number, region in enumerate(ways(built.union(*sequence))):
                following = (*sequence, region)
                order[following] = (*order[sequence], number)
                is_complete = silhouette <= built.union(*following)
                (finished if is_complete or length == horizon else longer).append(following)
        grown = longer
    return sorted(finished, key=lambda sequence: order[sequence])


def sampled(
    found: list[tuple[Cells, ...]], most: int, horizon: int, seed: int, built: Cells, height: int
) -> list[tuple[Cells, ...]]:
    """At most `most` of the sequences, drawn without replacement, in their order."""
    if len(found) <= most:
        return found
    words = [seed, *words_of(mask_of(built, height)), horizon]
    generator = Generator(key_from_words(words))
    drawn: list[int] = []
    for last in range(len(found) - most, len(found)):
        number = generator.below(last + 1)
        drawn.append(number if number not in drawn else last)
    return [sequence for number, sequence in enumerate(found) if number in drawn]


def weigh(
    width: int,
    height: int,
    library: Sequence[Block],
    sequence: tuple[Cells, ...],
    built: Cells,
    seed: int,
    lam: float,
    budget: int,
    **search: Any,
) -> Weighed:
    """Solve along a sequence up to its first unsolved subgoal."""
    state, cost, status = built, 0, SOLVED
    for region in sequence:
        target = state | region
        solution = solve(width, height, library, target, state, seed, budget=budget, **search)
        cost += solution.planning_cost
        status = solution.status
        if status != SOLVED:
            break
        state = target
    cells = len(built.union(*sequence)) - len(built)
    return Weighed(sequence, cells, cost, cells - lam * cost if status == SOLVED else None, status)


def chances(candidates: list[Weighed], temperature: float, aggregate: str) -> list[float]:
    """The probability of each candidate.

    First that of its first subgoal, from the worth G of the sequences that begin with it; then
    that of the sequence among those.
    """
    solved = [one for one in candidates if one.value is not None]
    if not solved:
        return [0.0 for _ in candidates]
    firsts = list(dict.fromkeys(one.regions[0] for one in solved))

    def values(first: Cells) -> list[float]:
        return [one.value for one in solved if one.regions[0] == first and one.value is not None]

    def worth(first: Cells) -> float:
        if aggregate == 'best':
            return max(values(first))
        highest = max(values(first))
        return highest + temperature * math.log(
            sum(math.exp((value - highest) / temperature) for value in values(first))
        )

    def within(one: Weighed) -> float:
        among = values(one.regions[0])
        if aggregate == 'best':
            return (one.value == max(among)) / among.count(max(among))
        assert one.value is not None
        return 1 / sum(math.exp((other - one.value) / temperature) for other in among)

    most = max(map(worth, firsts))
    total = sum(math.exp((worth(first) - most) / temperature) for first in firsts)
    return [
        0.0
        if one.value is None
        else math.exp((worth(one.regions[0]) - most) / temperature) / total * within(one)
        for one in candidates
    ]
