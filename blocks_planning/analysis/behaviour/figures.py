"""Figures that compare people and planners."""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.behaviour.building import LABELS, PEOPLE
from blocks_planning.analysis.style import (
    COLOURS,
    SEARCH_NAMES,
    error_bars,
    new_figure,
    styled,
)
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.figure import Figure

FAMILY_COLOURS = ('#0072B2', '#E69F00', '#CC79A7', '#56B4E9')
_SHOWN = ('upwards', 'lowest_row', 'rightwards')
_CHANCE = '#999999'


def building_figure(rows: list[dict[str, Any]]) -> Figure:
    """Order of building (A), and how far each region family describes it (B), by builder."""
    figure = new_figure(9.5, 1.6 + 0.42 * len(rows))
    with styled():
        axes = figure.subplots(1, len(_SHOWN) + 1, sharey=True, width_ratios=[1, 1, 1, 1.4])
        places = list(range(len(rows), 0, -1))
        for ax, measure in zip(axes, _SHOWN, strict=False):
            for place, row in zip(places, rows, strict=True):
                _point(ax, row['measures'][measure], place, _colour(row['who']))
            ax.set_xlim(0, 1.03)
            ax.set_xlabel(f'{LABELS[measure].replace(", ", ",%n")}\n[share]'.replace('%n', '\n'))
        axes[-2].axvline(0.5, color=_CHANCE, lw=0.8)
        _gains(axes[-1], rows, places)
        axes[0].set_yticks(places, [name_of(row['who']) for row in rows])
        axes[0].set_title('A')
        axes[-1].set_title('B')
    return figure


def _gains(ax: Any, rows: list[dict[str, Any]], places: list[int]) -> None:
    names = list(rows[0]['families'])
    for number, name in enumerate(names):
        shift = 0.16 * ((len(names) - 1) / 2 - number)
        for place, row in zip(places, rows, strict=True):
            label = name if place == places[0] else None
            estimate = row['families'][name]['gain']
            _point(ax, estimate, place + shift, FAMILY_COLOURS[number % 4], label)
    ax.axvline(0, color=_CHANCE, lw=0.8)
    ax.set_xlim(-0.6, 1.03)
    ax.set_xlabel('described by regions,\nbeyond chance [share]')
    ax.legend(loc='lower left', fontsize=7.5)


def marking_figure(parts: dict[str, Any]) -> Figure:
    """Share of marked parts that is a region of each family, by tower, all, and by chance."""
    families = parts['families']
    towers = list(next(iter(families.values()))['towers'])
    figure = new_figure(9.5, 3.2)
    with styled():
        ax = figure.subplots()
        for number, (name, found) in enumerate(families.items()):
            colour = FAMILY_COLOURS[number % 4]
            values = [*(found['towers'][tower] for tower in towers), found['all']]
            for place, estimate in enumerate(values):
                mean, distances = error_bars(estimate)
                label = name if place == 0 else None
                ax.errorbar(place, mean, distances, fmt='o', color=colour, capsize=2, label=label)
            ax.plot(
                len(towers), found['by_chance']['mean'], 'D', mfc='none', color=colour, ms=6,
                label=f'{name}, grown at random',
            )  # fmt: skip
        ax.axvline(len(towers) - 0.5, color=_CHANCE, lw=0.8)
        ax.set_xticks(range(len(towers) + 1), [*towers, 'all'])
        ax.set_ylim(-0.03, 1.03)
        ax.set_xlabel('silhouette')
        ax.set_ylabel('marked parts that are regions\n[share]')
        figure.legend(loc='outside lower center', ncols=4, fontsize=8)
    return figure


def difficulty_figure(found: dict[str, Any]) -> Figure:
    """Rank correlation of people's success with each planner's, by tower."""
    known = {name: value for name, value in found['rho'].items() if value['mean'] is not None}
    figure = new_figure(7, 1.2 + 0.36 * (len(known) + 1))
    with styled():
        ax = figure.subplots()
        shown = {'one half of the people': found['among_people'], **known}
        places = range(len(shown), 0, -1)
        for place, (name, estimate) in zip(places, shown.items(), strict=True):
            _point(ax, estimate, place, _colour(name))
        ax.set_yticks(list(places), [name_of(name) for name in shown])
        ax.axvline(0, color=_CHANCE, lw=0.8)
        ax.set_xlim(-1.05, 1.05)
        ax.set_xlabel("Spearman's rho with people's success by tower")
    return figure


def name_of(who: str) -> str:
    """A builder's name for people: 'BFS, scoping' for 'bfs scoping'."""
    search, _, rest = who.partition(' ')
    return f'{SEARCH_NAMES[search]}, {rest}' if search in SEARCH_NAMES and rest else who


def _colour(who: str) -> str:
    words = who.split()
    fitting = [colour for name, colour in COLOURS.items() if name in words]
    return fitting[0] if fitting else COLOURS[PEOPLE] if PEOPLE in who else '#000000'


def _point(
    ax: Any, estimate: dict[str, Any], place: float, colour: str, label: Any = None
) -> None:
    if estimate['mean'] is not None:
        mean, distances = error_bars(estimate)
        ax.errorbar(mean, place, xerr=distances, fmt='o', color=colour, capsize=2, label=label)
