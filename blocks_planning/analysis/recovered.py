"""The figure of a recovery: parameters fitted against the true ones, and the confusion of models."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from blocks_planning.analysis.style import new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.figure import Figure

_UNITS = {'lambda': 'cells / state', 'temperature': 'cells', 'lapse': 'probability'}
_MARKS = 'o^sDv'


def recovery_figure(
    parameters: Mapping[str, Sequence[Mapping[str, Any]]],
    rates: Mapping[str, Mapping[str, float]],
) -> Figure:
    """Fitted against true parameters (A), and the share of sets in which each model wins (B).

    Args:
        parameters: rows of :func:`.recovery.recover_parameters` by model.
        rates: of :func:`.recovery.win_rates`.
    """
    figure = new_figure(11, 7.2)
    with styled():
        grid = figure.add_gridspec(2, len(_UNITS), height_ratios=[1, 1.6])
        axes = [figure.add_subplot(grid[0, column]) for column in range(len(_UNITS))]
        for ax, name in zip(axes, _UNITS, strict=True):
            _parameter(ax, name, parameters)
        axes[0].set_title('A')
        axes[0].legend(fontsize=8)
        ax = figure.add_subplot(grid[1, :])
        _confusion(ax, rates)
        ax.set_title('B')
    return figure


def _parameter(ax: Any, name: str, parameters: Mapping[str, Sequence[Mapping[str, Any]]]) -> None:
    """Dots of all models, and the line on which fitted and true values are equal."""
    for mark, (model, rows) in zip(_MARKS, parameters.items(), strict=False):
        own = [row for row in rows if row['parameter'] == name]
        true, fitted = [row['true'] for row in own], [row['fitted'] for row in own]
        ax.plot(true, fitted, mark, ms=4, alpha=0.6, label=model)
    ends = ax.get_xlim()
    ax.plot(ends, ends, color='#999999', lw=0.8, zorder=0)
    ax.set_xscale('log')
    ax.set_yscale('log')
    ax.set_xlabel(f'true {name} [{_UNITS[name]}]')
    ax.set_ylabel('fitted')


def _confusion(ax: Any, rates: Mapping[str, Mapping[str, float]]) -> None:
    names = list(rates)
    table = [[rates[true][name] for name in names] for true in names]
    ax.imshow(table, cmap='Blues', vmin=0, vmax=1, aspect='auto')
    for row, values in enumerate(table):
        for column, share in enumerate(values):
            colour = 'white' if share > 0.6 else 'black'
            text = f'{100 * share:.0f}' if share else ''
            ax.text(column, row, text, ha='center', va='center', color=colour, fontsize=8)
    ax.set_xticks(range(len(names)), names, rotation=25, ha='right')
    ax.set_yticks(range(len(names)), names)
    ax.set_xlabel('best model by BIC [percent of sets]')
    ax.set_ylabel('true model')
