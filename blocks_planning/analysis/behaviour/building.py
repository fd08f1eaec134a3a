"""The order of building: every measure for people and for each planner, with intervals."""

from __future__ import annotations

import random
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from blocks_planning.analysis.behaviour.shares import Tally, estimate_gain, estimate_share
from blocks_planning.people.data import Build, tasks
from blocks_planning.people.families import family_names, find_family
from blocks_planning.people.orders import MEASURES, Count, Describer, perfect, shuffled

SEED = 20211001
PEOPLE = 'people'

LABELS = {
    'upwards': 'at or above the previous one',
    'lowest_row': 'on the lowest unfinished row',
    'rightwards': 'to the right, of steps on a level',
    'inside': 'wholly inside the silhouette',
    'perfect': 'perfect builds',
}
"""Descriptions of the measures of :data:`.orders.MEASURES`, all shares."""


def compare_building(
    groups: Mapping[str, Sequence[Build]],
    families: Iterable[str] = family_names(),
    seed: int = SEED,
) -> list[dict[str, Any]]:
    """Every measure for every group of builders.

    Args:
        groups: builds by the name of the builders: 'people', or a planner.
        families: names of the region families to describe orders with.
        seed: of the bootstrap and of the orders drawn by chance.

    Returns:
        One dict per group: ``who``, ``builders``, ``builds``, ``complete`` (builds without a
        fault), ``measures`` (an estimate by name) and ``families``: for each the share of
        placements of complete builds that it describes, that by chance, and the gain; see
        :func:`.shares.estimate_gain`. Only complete builds count there, because a block outside
        the silhouette breaks any run.
    """
    describers = {name: Describer(find_family(name)) for name in families}
    return [
        _group(who, builds, describers, np.random.default_rng([seed, number]))
        for number, (who, builds) in enumerate(groups.items())
    ]


def _group(
    who: str,
    builds: Sequence[Build],
    describers: Mapping[str, Describer],
    rng: np.random.Generator,
) -> dict[str, Any]:
    complete = [build for build in builds if perfect(tasks()[build.tower], build.placements).hits]
    return {
        'who': who,
        'builders': len({build.builder for build in builds}),
        'builds': len(builds),
        'complete': len(complete),
        'measures': {
            name: estimate_share(_tally(builds, measure), rng).to_json()
            for name, measure in MEASURES.items()
        },
        'families': {
            name: _description(complete, describer, rng) for name, describer in describers.items()
        },
    }


def _tally(builds: Sequence[Build], measure: Any) -> Tally:
    return Tally((one.builder, measure(tasks()[one.tower], one.placements)) for one in builds)


def _description(
    builds: Sequence[Build], describer: Describer, rng: np.random.Generator
) -> dict[str, Any]:
    source = random.Random(SEED)

    def by_chance(task: Any, placements: Any) -> Count:
        return describer.described(task, shuffled(placements, source))

    own, chance = _tally(builds, describer.described), _tally(builds, by_chance)
    return {
        'described': estimate_share(own, rng).to_json(),
        'by_chance': estimate_share(chance, rng).to_json(),
        'gain': estimate_gain(own, chance, rng).to_json(),
    }
