"""The figure of a fit: BIC of each model, and parameters, session by session."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from blocks_planning.analysis.style import new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.figure import Figure

_COLOURS = ('#0072B2', '#D55E00', '#009E73', '#CC79A7', '#E69F00', '#56B4E9', '#000000')
_LABELS = {
    'lambda': 'lambda\n[cells / state]',
    'temperature': 'temperature\n[cells]',
    'lapse': 'lapse\n[probability]',
}


def fit_figure(fits: Sequence[dict[str, Any]], parameters: Sequence[dict[str, Any]]) -> Figure:
    """BIC above the best model of each session (A), and the best model's parameters (B).

    Args:
        fits: rows of :func:`.comparison.compare_models`.
        parameters: likewise.
    """
    sessions = list(dict.fromkeys(row['session'] for row in fits))
    models = list(dict.fromkeys(row['model'] for row in fits))
    figure = new_figure(9.5, 1.8 + 0.3 * len(sessions))
    with styled():
        axes = figure.subplots(1, 1 + len(_LABELS), sharey=True, width_ratios=[2, 1, 1, 1])
        for place, session in enumerate(sessions):
            own = [row for row in fits if row['session'] == session]
            for row in own:
                colour = _COLOURS[models.index(row['model']) % len(_COLOURS)]
                label = row['model'] if place == 0 else None
                axes[0].plot(row['delta_bic'], place, 'o', color=colour, alpha=0.8, label=label)
            best = min(own, key=lambda row: row['bic'])['model']
            colour = _COLOURS[models.index(best) % len(_COLOURS)]
            for ax, name in zip(axes[1:], _LABELS, strict=True):
                _parameter(ax, place, colour, session, best, name, parameters)
        axes[0].set_yticks(range(len(sessions)), sessions)
        axes[0].set_ylim(len(sessions) - 0.5, -0.5)
        axes[0].set_xscale('symlog', linthresh=10)
        axes[0].set_xlabel('BIC above that of the best model\n(below 10: linear)')
        for ax, (name, label) in zip(axes[1:], _LABELS.items(), strict=True):
            ax.set_xlabel(label)
            if name != 'lapse':
                ax.set_xscale('log')
        axes[2].set_xlim(1e-2, 1e3)
        axes[3].set_xlim(-0.03, 1.03)
        axes[0].set_title('A')
        axes[1].set_title('B')
        figure.legend(loc='outside lower center', ncols=4, fontsize=8)
    return figure


def _parameter(
    ax: Any,
    place: int,
    colour: str,
    session: str,
    model: str,
    name: str,
    parameters: Sequence[dict[str, Any]],
) -> None:
    for row in parameters:
        if (row['session'], row['model'], row['parameter']) == (session, model, name):
            ax.plot(row['value'], place, 'o', color=colour)
            low, high = row['low'] or row['value'], row['high'] or row['value']
            ax.plot([low, high], [place, place], color=colour, lw=1)
