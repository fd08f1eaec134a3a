"""Sets of towers that are similar on average."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from blocks_planning.errors import ConfigurationError
from blocks_planning.towers.making import Made

_ROUNDS = 100


def balanced_sets(
    towers: Sequence[Made], sets: int, size: int, names: Sequence[str], seed: int
) -> list[list[Made]]:
    """Choose sets of towers whose means of some measures are as equal as possible.

    Towers are shuffled. Then two towers of different sets, or of a set and the remaining towers,
    are exchanged as long as this brings the means of the sets closer; measures are divided by their
    standard deviation over all towers.

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
            raise ConfigurationError(f'measure {name!r} is missing for some towers')
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
    """Exchange towers in ``order``, one set after the other, until no exchange helps."""
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
    """Sum of squared distances of the means of equally large sets from their common mean.

    Args:
        values: float64 (sets * size, measures), set after set.
        sets: number of sets.
    """
    means = values.reshape(sets, -1, values.shape[1]).mean(axis=1)
    return float(((means - means.mean(axis=0)) ** 2).sum())
