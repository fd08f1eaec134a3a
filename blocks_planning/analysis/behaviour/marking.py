"""The parts that people mark in a silhouette, and how many of them are regions of a family."""

from __future__ import annotations

import random
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from blocks_planning.analysis.behaviour.shares import Tally, estimate_share
from blocks_planning.board.geometry import Mask, area
from blocks_planning.board.task import Task
from blocks_planning.people.data import Marking, tasks
from blocks_planning.people.families import Family, family_names, find_family
from blocks_planning.people.orders import Count
from blocks_planning.people.parts import grown_part, is_region, pieces

SEED = 20211002


def compare_parts(
    markings: Sequence[Marking], families: Iterable[str] = family_names(), seed: int = SEED
) -> dict[str, Any]:
    """The share of marked parts that is a region of each family.

    A part is a connected piece of what was marked alike. By chance: a connected part of the same
    size, grown from a random cell of the same silhouette.

    Returns:
        ``markers``, ``markings``, ``parts``, and ``families``: for each the share of ``all``
        parts, of those of each pilot (``pilots``), of those of each tower (``towers``), the share
        ``by_chance``, and ``regions``, the mean number of regions that the family has before
        anything is built.
    """
    parts = [
        (marking, piece)
        for marking in markings
        for part in marking.parts
        for piece in pieces(tasks()[marking.tower].board, part)
    ]
    return {
        'markers': len({marking.marker for marking in markings}),
        'markings': len(markings),
        'parts': len(parts),
        'families': {
            name: _family(parts, find_family(name), np.random.default_rng([seed, number]))
            for number, name in enumerate(families)
        },
    }


def _family(
    parts: Sequence[tuple[Marking, Mask]], family: Family, rng: np.random.Generator
) -> dict[str, Any]:
    source = random.Random(SEED)
    found = [(marking, _count(tasks()[marking.tower], part, family)) for marking, part in parts]
    grown = []
    for marking, part in parts:
        task = tasks()[marking.tower]
        grown.append((marking, _count(task, grown_part(task, area(part), source), family)))
    towers = sorted({marking.tower for marking, _ in parts}, key=int)
    return {
        'all': _share(found, rng),
        'by_chance': _share(grown, rng),
        'pilots': {
            pilot: _share([item for item in found if item[0].pilot == pilot], rng)
            for pilot in sorted({marking.pilot for marking, _ in parts})
        },
        'towers': {
            tower: _share([item for item in found if item[0].tower == tower], rng)
            for tower in towers
        },
        'regions': float(np.mean([len(family(tasks()[tower], 0)) for tower in towers])),
    }


def _count(task: Task, part: Mask, family: Family) -> Count:
    return Count(int(is_region(task, part, family)), 1)


def _share(counts: Sequence[tuple[Marking, Count]], rng: np.random.Generator) -> Any:
    return estimate_share(Tally((one.marker, count) for one, count in counts), rng).to_json()
