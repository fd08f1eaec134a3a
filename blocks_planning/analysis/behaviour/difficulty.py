"""Difficulty of towers for people and planners: rank correlation with intervals over people."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from blocks_planning.analysis.behaviour.shares import draw_builders, interval
from blocks_planning.analysis.bootstrap import ITERATIONS, NOTHING, Estimate, pearson
from blocks_planning.extras import extra
from blocks_planning.people.data import Build, tasks
from blocks_planning.people.orders import perfect

with extra('experiments'):
    from scipy.stats import rankdata

SEED = 20211003


def compare_difficulty(
    people: Sequence[Build], planners: Mapping[str, Sequence[Build]], seed: int = SEED
) -> dict[str, Any]:
    """Spearman's rho of the share of perfect builds per tower, people with each planner.

    Intervals are over people: the towers are fixed, and a planner's shares are treated as exact.

    Returns:
        ``towers``: for each the share of perfect builds of people and of every planner, people's
        easiest first; ``rho``: an estimate by planner, nan if the planner's shares do not vary;
        ``among_people``: rho of one random half of the people with the other, an upper
        bound for the planners.
    """
    rng = np.random.default_rng(seed)
    hits, builds, towers = tables_of(people)
    shares = {name: _shares(part, towers) for name, part in planners.items()}
    own = hits.sum(axis=0) / builds.sum(axis=0)
    return {
        'towers': [
            {
                'tower': towers[place],
                'people': float(own[place]),
                'planners': {
                    name: None if np.isnan(share[place]) else float(share[place])
                    for name, share in shares.items()
                },
            }
            for place in np.argsort(-own, kind='stable')
        ],
        'rho': {
            name: rank_correlation(hits, builds, share, rng).to_json()
            for name, share in shares.items()
        },
        'among_people': among_people(hits, builds, rng).to_json(),
    }


def tables_of(builds: Sequence[Build]) -> tuple[np.ndarray, np.ndarray, list[str]]:
    """Perfect builds and builds, float64 (builders, towers) each, and the towers' names."""
    towers = sorted({build.tower for build in builds}, key=int)
    builders = sorted({build.builder for build in builds})
    hits = np.zeros((len(builders), len(towers)))
    made = np.zeros_like(hits)
    for build in builds:
        place = builders.index(build.builder), towers.index(build.tower)
        hits[place] += perfect(tasks()[build.tower], build.placements).hits
        made[place] += 1
    return hits, made, towers


def _shares(builds: Sequence[Build], towers: list[str]) -> np.ndarray:
    """Share of perfect builds at some towers, float64 (towers,); nan where none was built."""
    hits, made, own = tables_of(builds)
    found = np.full(len(towers), np.nan)
    for place, tower in enumerate(towers):
        if tower in own:
            column = own.index(tower)
            found[place] = hits[:, column].sum() / made[:, column].sum()
    return found


def rank_correlation(
    hits: np.ndarray,
    builds: np.ndarray,
    other: np.ndarray,
    rng: np.random.Generator,
    iterations: int = ITERATIONS,
) -> Estimate:
    """Spearman's rho of people's shares with other ones, float64 (towers,), by tower.

    Args:
        hits: perfect builds, float64 (builders, towers).
        builds: all builds, likewise.
        other: nan where there is none; such towers are left out.
        rng: generator of the draws of builders.
        iterations: number of draws.
    """
    present = ~np.isnan(other)
    hits, builds, other = hits[:, present], builds[:, present], other[present]
    if len(other) < 3 or len(set(other)) < 2:
        return NOTHING
    ranks = rankdata(other)
    value = pearson(ranks, rankdata(hits.sum(axis=0) / builds.sum(axis=0))[None])[0]
    drawn = draw_builders(len(hits), rng, iterations)
    with np.errstate(invalid='ignore'):
        shares = (drawn @ hits) / (drawn @ builds)
    return interval(float(value), pearson(ranks, rankdata(shares, axis=1)))


def among_people(
    hits: np.ndarray, builds: np.ndarray, rng: np.random.Generator, iterations: int = ITERATIONS
) -> Estimate:
    """Rho between two random halves of the people: mean and percentiles over the divisions."""
    rhos = []
    for _ in range(iterations):
        order = rng.permutation(len(hits))
        halves = order[: len(hits) // 2], order[len(hits) // 2 :]
        with np.errstate(invalid='ignore'):
            first, second = (hits[half].sum(axis=0) / builds[half].sum(axis=0) for half in halves)
        if np.isfinite(first).all() and np.isfinite(second).all():
            rhos.append(pearson(rankdata(first), rankdata(second)[None])[0])
    return interval(float(np.nanmean(rhos)), np.array(rhos)) if rhos else NOTHING
