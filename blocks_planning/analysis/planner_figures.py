"""Figures 2, 3 and 4 of the paper, from results and tables."""

from __future__ import annotations

from typing import Any

import numpy as np

from blocks_planning.analysis.paper import claims
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
from blocks_planning.analysis.trials import planners_of
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd
with extra('figures'):
    import matplotlib as mpl
    from matplotlib.figure import Figure

_PAPER = {claim.path: claim.value for claim in claims() if claim.path[0] == 'planners'}
_WIDTH = 0.26

Results = dict[str, Any]


def figure_2(presets: dict[str, Results]) -> Figure:
    """Success (A), action planning cost (B) and subgoal planning cost (B) of every planner."""
    figure = new_figure(9.5, 3.6)
    with styled():
        axes = figure.subplots(1, 3)
        groups = _searches(presets)
        measures = ('success', 'action_planning_cost', 'subgoal_planning_cost')
        for panel, (ax, measure) in enumerate(zip(axes, measures, strict=True)):
            for place, (search, results) in enumerate(groups.values()):
                for offset, strategy in enumerate(STRATEGIES):
                    x = place + (offset - 1) * _WIDTH
                    _bar(ax, x, measure, strategy, search, results)
            ax.set_xticks(range(len(groups)), list(groups))
            ax.set_ylabel(MEASURE_LABELS[measure])
            ax.set_xlim(-0.5, len(groups) - 0.5)
            ax.set_title(('A', 'B, action level', 'B, subgoal level')[panel])
            if measure == 'success':
                ax.set_ylim(0, 1.05)
            else:
                ax.set_yscale('log')
                ax.set_ylim(50 if panel == 1 else 1e5, 2e5 if panel == 1 else 4e7)
        handles = [
            axes[0].bar([0], [0], color=COLOURS[strategy], label=strategy)
            for strategy in STRATEGIES
        ]
        [diamond] = axes[0].plot([], [], 'D', mfc='white', mec=BLACK, ms=5, label='paper')
        figure.legend(handles=[*handles, diamond], loc='outside lower center', ncols=4)
    return figure


def _bar(ax: Any, x: float, measure: str, strategy: str, search: str, results: Results) -> None:
    estimate = results['planners'][search][strategy][measure]
    if measure == 'subgoal_planning_cost' and strategy == 'none':
        ax.annotate(
            '0',
            (x, 0.015),
            xycoords=('data', 'axes fraction'),
            ha='center',
            color=COLOURS['none'],
        )
        return
    if estimate['mean'] is not None:
        mean, distances = error_bars(estimate)
        ax.bar(x, mean, _WIDTH * 0.92, color=COLOURS[strategy])
        ax.errorbar(x, mean, distances, color=BLACK, lw=1, capsize=2)
    published = _PAPER.get(('planners', search, strategy, measure))
    if published is not None:
        ax.plot(x, published, 'D', mfc='white', mec=BLACK, ms=5, zorder=5)


def figure_3(trials: pd.DataFrame, decisions: pd.DataFrame, preset_names: list[str]) -> Figure:
    """The sand plot: how many rows the subgoals of scoping add, over lambda."""
    panels = {'BFS': planners_of(trials, preset_names[0]).query("search == 'bfs'")}
    for name in preset_names:
        chosen = planners_of(trials, name)
        panels[f'A* ({name})'] = chosen[chosen['search'] == 'astar']
    figure = new_figure(9.5, 3.4)
    with styled():
        axes = figure.subplots(1, len(panels), sharey=True)
        for ax, (name, part) in zip(axes, panels.items(), strict=True):
            shares = _shares_of_sizes(part, decisions)
            colours = [_sand(index, shares.shape[1]) for index in range(shares.shape[1])]
            ax.stackplot(
                1000 * shares.index.to_numpy(float),
                shares.to_numpy().T,
                colors=colours,
                labels=[f'{size}' for size in shares.columns],
                edgecolor='white',
                linewidth=0.3,
            )
            ax.set_title(name)
            ax.set_xlabel('lambda\n[cells per 1000 states]')
            ax.set_xlim(0, 1000 * shares.index.max())
            ax.set_ylim(0, 1)
        axes[0].set_ylabel('share of executed subgoals')
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles[::-1], labels[::-1], loc='outside right center', title='rows\nadded')
    return figure


def _sand(index: int, count: int) -> Any:
    return mpl.colormaps['cividis'](index / max(1, count - 1))


def _shares_of_sizes(trials: pd.DataFrame, decisions: pd.DataFrame) -> pd.DataFrame:
    """Share of the executed subgoals by the rows they add: index lambda, columns 1 to highest."""
    scoping = trials.loc[trials['strategy'] == 'scoping', ['trial_id', 'lambda']]
    chosen = decisions.merge(scoping, on='trial_id').query('executed > 0')
    chosen = chosen.assign(top=chosen['rows'].map(lambda rows: rows[-1]).astype(int))
    chosen = chosen.sort_values(['trial_id', 'decision'])
    before = chosen.groupby('trial_id', observed=True)['top'].shift(fill_value=0)
    sizes = pd.crosstab(chosen['lambda'], chosen['top'] - before, normalize='index')
    return sizes.reindex(columns=range(1, int(sizes.columns.max()) + 1), fill_value=0.0)


_PANELS = ('action_planning_cost', 'success', 'subgoals', 'subgoal_planning_cost', 'blocks')


def figure_4(presets: dict[str, Results]) -> Figure:
    """Five measures of scoping over lambda (rows A to E) for each search (columns)."""
    groups = _searches(presets)
    figure = new_figure(9.5, 11)
    with styled():
        axes = figure.subplots(len(_PANELS), len(groups), sharey='row')
        for row, measure in zip(axes, _PANELS, strict=True):
            for ax, (search, results) in zip(row, groups.values(), strict=True):
                _curve(ax, measure, search, results)
            row[0].set_ylabel(MEASURE_LABELS[measure])
            if measure.endswith('planning_cost'):
                row[0].set_yscale('log')
        for letter, row in zip('ABCDE', axes, strict=True):
            row[0].set_title(letter, fontweight='bold')
        for ax, name in zip(axes[0], groups, strict=True):
            ax.set_title(name.replace('\n', ' '), loc='center')
        for ax in axes[-1]:
            ax.set_xlabel('lambda [cells per 1000 states]')
        handles, labels = axes[0][0].get_legend_handles_labels()
        figure.legend(handles, labels, loc='outside lower center', ncols=3)
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
    r = over['correlation'][measure]['mean']
    ax.annotate(
        'r undefined' if r is None else f'r = {r:.2f}',
        (0.98, 1.0),
        xycoords='axes fraction',
        ha='right',
        va='bottom',
        fontsize=8,
    )


def _searches(presets: dict[str, Results]) -> dict[str, tuple[str, Results]]:
    """The searches as they are shown, with their results: BFS once, A* in every preset."""
    first = next(iter(presets.values()))
    shown = {SEARCH_NAMES['bfs']: ('bfs', first)}
    for name, results in presets.items():
        shown[f'{SEARCH_NAMES["astar"]}\n({name})'] = ('astar', results)
    return shown
