"""The figure that compares people with planners."""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.style import COLOURS, SEARCH_NAMES, error_bars, new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.figure import Figure

_MARKS = {
    'bfs.none': ('s', COLOURS['none'], 'BFS, none'),
    'bfs.scoping': ('o', COLOURS['scoping'], 'BFS, scoping'),
    'bfs.full': ('^', COLOURS['full'], 'BFS, full'),
    'astar.none': ('x', '#56B4E9', 'A*, none'),
}
_EASE = {'success': 'success', 'action_planning_cost': 'low action cost'}


def people_figure(compared: dict[str, Any]) -> Figure:
    """Success (A) and blocks (B) by silhouette, easy ones first, and agreement in order (C)."""
    figure = new_figure(9.5, 4.4)
    with styled():
        success, blocks, agreement = figure.subplots(1, 3)
        ranking = compared['ranking']
        places = range(len(ranking), 0, -1)
        _dots(success, ranking, places, 'success', 'perfect')
        _dots(blocks, ranking, places, 'blocks', 'blocks_perfect')
        names = [row['stimulus'].rpartition('/')[2] for row in ranking]
        success.set_yticks(list(places), names)
        success.set_ylabel("silhouette, people's easiest on top")
        blocks.set_yticks(list(places), names)
        success.set_xlim(-0.05, 1.05)
        success.set_xlabel('perfect reconstruction\n[share of attempts or runs]')
        blocks.set_xlabel('blocks in perfect\nreconstructions [blocks]')
        _forest(agreement, compared['models'])
        for letter, ax in zip('ABC', (success, blocks, agreement), strict=True):
            ax.set_title(letter)
        handles, labels = success.get_legend_handles_labels()
        figure.legend(handles, labels, loc='outside lower center', ncols=5)
    return figure


def _dots(ax: Any, ranking: list[dict[str, Any]], places: Any, measure: str, people: str) -> None:
    for place in places:
        ax.axhline(place, color='#dddddd', lw=0.6, zorder=0)
    for number, (key, (marker, colour, label)) in enumerate(_MARKS.items()):
        shift = 0.12 * (number - 1.5)  # so that equal values don't hide each other
        values = [row.get(key, {}).get(measure) for row in ranking]
        shown = [
            (value, place + shift)
            for value, place in zip(values, places, strict=True)
            if value is not None
        ]
        if shown:
            ax.plot(*zip(*shown, strict=True), marker, color=colour, ms=6, alpha=0.85, label=label)
    ax.plot(
        [row[people] for row in ranking],
        list(places),
        'D',
        color=COLOURS['people'],
        ms=6,
        label='people',
    )


def _forest(ax: Any, models: list[dict[str, Any]]) -> None:
    shown = [model for model in models if model['mean'] is not None]
    labels = []
    for place, model in zip(range(len(shown), 0, -1), shown, strict=True):
        mean, distances = error_bars(model)
        colour = COLOURS[model['strategy']]
        ax.errorbar(mean, place, xerr=distances, fmt='o', color=colour, capsize=2)
        labels.append(
            f'{SEARCH_NAMES[model["search"]]}, {model["strategy"]}:\n{_EASE[model["measure"]]}'
        )
    ax.axvline(0, color='black', lw=0.8)
    ax.set_yticks(range(len(shown), 0, -1), labels, fontsize=7.5)
    ax.set_xlim(-1.05, 1.05)
    ax.set_xlabel("Spearman's rho with\npeople's success, 95 % interval")
