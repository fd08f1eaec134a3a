"""Figures 2 and 4 in the paper's own forms, from results."""

from __future__ import annotations

from typing import Any

import numpy as np

from blocks_planning.analysis.marks import legend_handles, mark_of, style_of
from blocks_planning.analysis.paper import Kind
from blocks_planning.analysis.results import STRATEGIES
from blocks_planning.analysis.style import (
    BLACK,
    COLOURS,
    MEASURE_LABELS,
    SEARCH_NAMES,
    error_bars,
    new_figure,
    styled,
)
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.figure import Figure
    from matplotlib.patheffects import withStroke

Results = dict[str, Any]

_SHAPES = {'bfs': 'o', 'astar': 's'}
_COSTS = ('action_planning_cost', 'subgoal_planning_cost')
_UNITS = {
    'action_planning_cost': (1e3, '1000 states'),
    'subgoal_planning_cost': (1e6, 'million states'),
}

_LOWEST = {'action_planning_cost': -4, 'subgoal_planning_cost': -1}
"""Lower ends of the axes, in their units: dots at 0 and the labels below them are visible."""


def figure_2(presets: dict[str, Results]) -> Figure:
    """Cost against success, one dot a planner: action (A) and subgoal planning cost (B)."""
    figure = new_figure(9.5, 3.6 * len(presets))
    with styled():
        axes = figure.subplots(len(presets), 2, squeeze=False)
        for row, (preset, results) in zip(axes, presets.items(), strict=True):
            for letter, ax, cost in zip('AB', row, _COSTS, strict=True):
                for search in SEARCH_NAMES:
                    _dots(ax, results['planners'][search], search, cost)
                _, unit = _UNITS[cost]
                ax.set_ylabel(f'{MEASURE_LABELS[cost].splitlines()[0]}\n[{unit}]')
                ax.set_xlabel('perfect reconstruction [share of runs]')
                ax.set_xlim(0, 1.06)
                ax.set_ylim(bottom=_LOWEST[cost])
                ax.set_title(f'{letter}  {preset}')
        figure.legend(handles=_legend(axes[0][0]), loc='outside lower center', ncols=4)
    return figure


def _dots(ax: Any, planners: dict[str, Any], search: str, cost: str) -> None:
    """The planners of a search, joined by a line, and the paper's beside them."""
    scale, _ = _UNITS[cost]
    places = []
    for strategy in STRATEGIES:
        success, states = planners[strategy]['success'], planners[strategy][cost]
        if states['mean'] is None:
            continue
        x, x_error = error_bars(success)
        y, y_error = error_bars(states)
        y, bars = y / scale, [[side[0] / scale] for side in y_error]
        places.append((x, y))
        colour = COLOURS[strategy]
        ax.errorbar(x, y, bars, x_error, color=colour, lw=1, capsize=2, zorder=3)
        ax.plot(x, y, _SHAPES[search], color=colour, ms=8, zorder=4)
        _paper_dot(ax, search, strategy, cost)
    ax.plot(*zip(*places, strict=True), color='#cccccc', lw=1.5, zorder=1)


def _paper_dot(ax: Any, search: str, strategy: str, cost: str) -> None:
    success = mark_of('planners', search, strategy, 'success')
    states = mark_of('planners', search, strategy, cost)
    if success is None:
        return
    if states is None:  # strategy none has no subgoal planning cost
        if strategy != 'none' or cost != 'subgoal_planning_cost':
            return
        value, kind = 0.0, success.kind
    else:
        value = states.value / _UNITS[cost][0]
        kind = Kind.PRINTED if {success.kind, states.kind} == {Kind.PRINTED} else Kind.ANALYSIS
    ax.plot(success.value, value, zorder=5, **style_of(kind, COLOURS[strategy]))
    ax.annotate(
        SEARCH_NAMES[search],
        (success.value, value),
        xytext=(0, 6 if search == 'astar' else -6),  # so that labels do not overlap
        textcoords='offset points',
        ha='center',
        va='bottom' if search == 'astar' else 'top',
        fontsize=7,
        zorder=6,  # above the marks of other planners
        path_effects=[withStroke(linewidth=2, foreground='white')],
    )


def _legend(ax: Any) -> list[Any]:
    shapes = [
        ax.plot([], [], shape, color='#777777', label=f'ours, {SEARCH_NAMES[search]}')[0]
        for search, shape in _SHAPES.items()
    ]
    colours = [
        ax.plot([], [], '-', lw=6, color=COLOURS[strategy], label=strategy)[0]
        for strategy in STRATEGIES
    ]
    return [*shapes, *legend_handles(ax), *colours]


_PANELS = ('action_planning_cost', 'success', 'subgoals', 'subgoal_planning_cost', 'blocks')


def figure_4(results: Results) -> Figure:
    """Five measures of scoping over lambda (A to E) for each search (columns)."""
    figure = new_figure(9.5, 12)
    with styled():
        axes = figure.subplots(len(_PANELS), len(SEARCH_NAMES), sharey='row')
        for letter, row, measure in zip('ABCDE', axes, _PANELS, strict=True):
            for ax, (search, name) in zip(row, SEARCH_NAMES.items(), strict=True):
                _curve(ax, measure, search, results)
                ax.set_title(f'{letter}  {name}')
                _tell_r(ax, measure, search, results)
            row[0].set_ylabel(MEASURE_LABELS[measure])
            if measure.endswith('planning_cost'):
                row[0].set_yscale('log')
        for ax in axes[-1]:
            ax.set_xlabel('lambda [cells per 1000 states]')
        handles, labels = axes[0][0].get_legend_handles_labels()
        marks = legend_handles(axes[0][0])
        figure.legend(
            [*handles, *marks],
            [*labels, *(mark.get_label() for mark in marks)],
            loc='outside lower center',
            ncols=5,
        )
    return figure


def _curve(ax: Any, measure: str, search: str, results: Results) -> None:
    over = results['lambda'][search]
    x = 1000 * np.array(over['values'])
    values = [[e['mean'], *e['ci']] for e in over['measures'][measure]]
    mean, low, high = np.array(values, float).T
    for strategy, dashes in (('none', (4, 2)), ('full', (1, 1))):
        level = results['planners'][search][strategy][measure]['mean']
        if level:
            ax.axhline(level, color=COLOURS[strategy], lw=1.5, dashes=dashes, label=strategy)
    ax.fill_between(x, low, high, color=COLOURS['scoping'], alpha=0.25, lw=0)
    ax.plot(x, mean, color=COLOURS['scoping'], lw=1.5, label='scoping, 95 % interval')
    for strategy in STRATEGIES:
        mark = mark_of('planners', search, strategy, measure)
        if mark is not None:
            style = style_of(mark.kind, COLOURS[strategy])
            ax.plot(1.06 * x.max(), mark.value, clip_on=False, zorder=5, **style)
    ax.set_xlim(0, 1.1 * x.max())


def _tell_r(ax: Any, measure: str, search: str, results: Results) -> None:
    """Write our r, and the paper's printed one."""
    ours = results['lambda'][search]['correlation'][measure]['mean']
    paper = mark_of('lambda', search, 'correlation', measure)
    words = 'r undefined' if ours is None else f'r = {ours:.2f}'
    if paper is not None:
        words += f' (paper {paper.value:.2f})'
    ax.set_title(words, loc='right', fontsize=8, color=BLACK)
