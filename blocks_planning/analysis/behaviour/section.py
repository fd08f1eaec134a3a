"""The section of the report on people: numbers, figures, and HTML to include."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.behaviour.building import LABELS, PEOPLE, compare_building
from blocks_planning.analysis.behaviour.difficulty import compare_difficulty
from blocks_planning.analysis.behaviour.figures import (
    building_figure,
    difficulty_figure,
    marking_figure,
    name_of,
)
from blocks_planning.analysis.behaviour.marking import compare_parts
from blocks_planning.analysis.behaviour.planners import builds_of_sweep
from blocks_planning.extras import extra
from blocks_planning.people.data import read_builds, read_markings

with extra('figures'):
    from matplotlib.figure import Figure

TEMPLATE = 'behaviour.html'
"""The partial, which report.html includes; it needs ``behaviour`` (:func:`section_content`) and
``figures`` (URLs by name)."""


def compare_behaviour(sweep: Path, preset: str = 'published') -> dict[str, Any]:
    """Everything about people and the planners of a sweep, for ``results.json``.

    Args:
        sweep: folder of the finished sweep.
        preset: of A*.

    Returns:
        ``building``, ``parts`` and ``difficulty``; see :func:`.building.compare_building`,
        :func:`.marking.compare_parts` and :func:`.difficulty.compare_difficulty`.

    Raises:
        InvalidInput: if the sweep has no tables, or the data of people are not installed.
    """
    people = read_builds()
    planners = builds_of_sweep(sweep, {build.tower for build in people}, preset)
    return {
        'building': compare_building({PEOPLE: people, **planners}),
        'parts': compare_parts(read_markings()),
        'difficulty': compare_difficulty(people, planners),
    }


def behaviour_figures(found: dict[str, Any]) -> dict[str, Figure]:
    """The figures of the section, by their names in the template."""
    return {
        'behaviour-building': building_figure(found['building']),
        'behaviour-parts': marking_figure(found['parts']),
        'behaviour-difficulty': difficulty_figure(found['difficulty']),
    }


def section_content(found: dict[str, Any]) -> dict[str, Any]:
    """The content of the template: numbers, labels, and names of builders."""
    return {
        **found,
        'labels': LABELS,
        'names': {row['who']: name_of(row['who']) for row in found['building']},
        'people': next(row for row in found['building'] if row['who'] == PEOPLE),
    }
