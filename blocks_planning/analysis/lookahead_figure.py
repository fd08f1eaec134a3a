"""Success against states evaluated: one line for each family of regions and lambda."""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.style import BLACK, COLOURS, new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_FAMILIES = {'rows': COLOURS['scoping'], 'rectangles': COLOURS['people']}
_ALONE = {'none': 'X', 'full': 'D'}
_DASHES = ('-', '--', ':', '-.')


def lookahead_figure(results: dict[str, Any]) -> Figure:
    """A panel for each world: a number is the horizon, a line joins those of one lambda."""
    slips = sorted({cell['slip'] for cell in results['cells']})
    lambdas = sorted({cell['lambda'] for cell in results['cells']} - {None})
    figure = new_figure(10, 4)
    with styled():
        axes = figure.subplots(1, len(slips), sharex=True, sharey=True, squeeze=False)[0]
        for panel, slip in zip(axes, slips, strict=True):
            _panel(panel, [cell for cell in results['cells'] if cell['slip'] == slip], lambdas)
            panel.set_title(f'slip {slip:g}')
            panel.set_xlabel('states evaluated\n[states per trial]')
        axes[0].set_xscale('log')
        axes[0].set_ylabel('perfect reconstruction\n[share of runs]')
        figure.legend(*axes[0].get_legend_handles_labels(), loc='outside right', fontsize=7.5)
    return figure


def _panel(panel: Axes, cells: list[dict[str, Any]], lambdas: list[float]) -> None:
    for family, colour in _FAMILIES.items():
        for number, lam in enumerate(lambdas):
            mine = [c for c in cells if c['family'] == family and c['lambda'] == lam]
            if not mine:
                continue
            mine.sort(key=lambda cell: cell['horizon'])
            x, y = ([cell[name]['mean'] for cell in mine] for name in ('states', 'success'))
            label = f'{family}, lambda {lam:g}'
            dashes = _DASHES[number % len(_DASHES)]
            panel.plot(x, y, color=colour, ls=dashes, lw=1, marker='o', ms=3, label=label)
            for cell in mine:
                place = cell['states']['mean'], cell['success']['mean']
                panel.annotate(
                    str(cell['horizon']), place, (3, 3), textcoords='offset points', fontsize=7
                )
    for name, mark in _ALONE.items():
        for cell in cells:
            if cell['family'] == name:
                place = cell['states']['mean'], cell['success']['mean']
                panel.plot(*place, mark, color=COLOURS[name], mec=BLACK, mew=0.5, label=name)
