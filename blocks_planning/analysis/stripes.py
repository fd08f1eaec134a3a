"""Figure 3 in the paper's own form: a stripe for each attempt, tower by tower."""

from __future__ import annotations

from typing import Any

import numpy as np

from blocks_planning.analysis.style import SEARCH_NAMES, new_figure, styled
from blocks_planning.analysis.trials import planners_of
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd
with extra('figures'):
    import matplotlib as mpl
    from matplotlib.figure import Figure

_ACROSS = 8
"""Towers in a row of the figure."""
_WIDTHS = {'scoping': 128, 'full': 24}
"""Stripes of a panel; each shows one attempt."""
_GAP = 4
_BLANK = -1
_NOT_BUILT = 0.93


def figure_3(trials: pd.DataFrame, decisions: pd.DataFrame, preset: str) -> Figure:
    """Which subgoal each row of a tower belonged to, in attempts sorted by lambda; full last.

    A panel is a tower, a stripe in it an attempt, from the ground upwards. Of more attempts than a
    panel is wide, evenly spaced ones are shown.
    """
    planners = planners_of(trials, preset)
    towers = list(trials['stimulus'].cat.categories)
    towers.sort(key=lambda name: (len(name), name))
    rows_each = -(-len(towers) // _ACROSS)
    figure = new_figure(9.5, 1.25 * rows_each * len(SEARCH_NAMES) + 1)
    highest = max(map(max, (rows for rows in decisions['tops'] if len(rows))))
    with styled():
        axes = figure.subplots(
            rows_each * len(SEARCH_NAMES), _ACROSS, squeeze=False, sharex=True, sharey=True
        )
        for ax in axes.flat:
            ax.set_axis_off()
        for block, (search, name) in enumerate(SEARCH_NAMES.items()):
            stripes = _stripes(planners[planners['search'] == search], decisions, highest)
            for place, tower in enumerate(towers):
                ax = axes[block * rows_each + place // _ACROSS][place % _ACROSS]
                _panel(ax, stripes, tower, highest)
                if place % _ACROSS == 0:
                    ax.set_ylabel(f'{name}\nrows', fontsize=8)
        _colour_bar(figure, axes, highest)
        figure.supxlabel('attempts, by rising lambda; right of the gap: full', fontsize=9)
    return figure


def _stripes(
    trials: pd.DataFrame, decisions: pd.DataFrame, highest: int
) -> dict[tuple[str, str], np.ndarray]:
    """By tower and strategy: the number of the subgoal of each row, (stripes, rows), 0 for none."""
    shown = {
        (stimulus, strategy): _spread(part['trial_id'], _WIDTHS[strategy])
        for (stimulus, strategy), part in trials[trials['strategy'].isin(list(_WIDTHS))]
        .sort_values(['lambda', 'seed'])
        .groupby(['stimulus', 'strategy'], observed=True)
    }
    wanted = {name for names in shown.values() for name in names}
    made = decisions[(decisions['executed'] > 0) & decisions['trial_id'].isin(wanted)]
    heights: dict[str, list[int]] = {}
    for name, rows in zip(
        *(made.sort_values('decision')[key] for key in ('trial_id', 'tops')), strict=True
    ):
        heights.setdefault(name, []).extend(rows)
    return {
        key: np.array([subgoal_of_rows(heights.get(name, []), highest) for name in names])
        for key, names in shown.items()
    }


def _spread(names: pd.Series, count: int) -> list[str]:
    """Evenly spaced elements of some names; repeated if there are too few."""
    places = np.linspace(0, len(names) - 1, count).round().astype(int)
    return [str(name) for name in names.to_numpy()[places]]


def subgoal_of_rows(heights: list[int], highest: int) -> list[int]:
    """The number of the subgoal, from 1, that first contained each row; 0 for rows of none.

    Args:
        heights: of the regions that were chosen, one after another [rows].
        highest: number of rows [rows].
    """
    numbers = [0] * highest
    reached = number = 0
    for height in heights:
        if height > reached:
            number += 1
            numbers[reached:height] = [number] * (height - reached)
            reached = height
    return numbers


def _panel(ax: Any, stripes: dict[tuple[str, str], np.ndarray], tower: str, highest: int) -> None:
    none = np.zeros((1, highest), int)
    parts = [
        stripes.get((tower, strategy), np.repeat(none, width, axis=0))
        for strategy, width in _WIDTHS.items()
    ]
    gap = np.full((_GAP, highest), _BLANK)
    picture = _colours(np.concatenate([parts[0], gap, parts[1]]), highest)
    ax.set_axis_on()
    ax.imshow(picture.swapaxes(0, 1), origin='lower', aspect='auto', interpolation='nearest')
    ax.set_xticks([])
    ax.set_yticks([-0.5, highest - 0.5], ['0', f'{highest}'], fontsize=7)
    ax.set_title(tower.rpartition('/')[2], fontsize=8, pad=2)


def _colours(numbers: np.ndarray, highest: int) -> np.ndarray:
    """A colour for each number of subgoal: grey for 0, white for -1."""
    table = np.concatenate(
        [
            [[_NOT_BUILT] * 3],
            mpl.colormaps['viridis'](np.linspace(0, 1, highest))[:, :3],
            [[1] * 3],
        ]
    )
    return np.asarray(table[numbers])


def _colour_bar(figure: Figure, axes: Any, highest: int) -> None:
    colours = mpl.colormaps['viridis'](np.linspace(0, 1, highest))
    scale = mpl.cm.ScalarMappable(
        mpl.colors.BoundaryNorm(np.arange(0.5, highest + 1), highest),
        mpl.colors.ListedColormap(colours),
    )
    bar = figure.colorbar(scale, ax=axes, ticks=range(1, highest + 1), shrink=0.5, aspect=25)
    bar.set_label('number of the subgoal', fontsize=8)
