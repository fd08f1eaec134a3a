"""Sets of towers that are alike on average."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from blocks_planning.errors import ConfigurationError
from blocks_planning.towers.making import Made

_ROUNDS = 100


def balanced_sets(
    towers: Sequence[Made], sets: int, size: int, names: Sequence[str], seed: int
) -> list[list[Made]]:
    """Choose sets of towers whose means of some measures are as equal as found.

    Towers are shuffled, and then two towers of different sets, or of a set and those left over,
    change places as long as that brings the means of the sets closer; measures are divided by
    their standard deviation over all towers.

    Args:
        towers: at least ``sets * size``; the more there are, the more equal the sets.
        sets: number of sets.
        size: number of towers in each.
        names: of the measures.
        seed: of the shuffling.

    Raises:
        ConfigurationError: if there are too few towers, or a measure is missing.
    """
    if len(towers) < sets * size:
        raise ConfigurationError(
            f'{sets} sets of {size} need at least {sets * size} towers, got {len(towers)}'
        )
    for name in names:
        if any(name not in tower.measures for tower in towers):
            raise ConfigurationError(f'measure {name!r} was not taken of every tower')
    values = np.array([[float(tower.measures[name]) for name in names] for tower in towers])
    spread = values.std(axis=0)
    values = (values - values.mean(axis=0)) / np.where(spread, spread, 1.0)
    order = np.random.default_rng(seed).permutation(len(towers))
    _improve(values, order, sets, size)
    return [
        [towers[index] for index in sorted(order[first : first + size].tolist())]
        for first in range(0, sets * size, size)
    ]


def _improve(values: np.ndarray, order: np.ndarray, sets: int, size: int) -> None:
    """Let towers change places in ``order``, the sets one after the other, until none gains."""
    best = imbalance(values[order[: sets * size]], sets)
    for _ in range(_ROUNDS):
        before = best
        for one in range(sets * size):
            for other in range(one + 1, len(order)):
                if one // size == other // size:
                    continue
                order[[one, other]] = order[[other, one]]
                found = imbalance(values[order[: sets * size]], sets)
                if found < best - 1e-12:
                    best = found
                else:
                    order[[one, other]] = order[[other, one]]
        if best == before:
            return


def imbalance(values: np.ndarray, sets: int) -> float:
    """Sum of squared distances of the means of sets of one size from their common mean.

    Args:
        values: float64 (sets * size, measures), set after set.
        sets: number of sets.
    """
    means = values.reshape(sets, -1, values.shape[1]).mean(axis=1)
    return float(((means - means.mean(axis=0)) ** 2).sum())
