"""Success, regret and costs of planners over the slip of their world, and towers that fall."""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.style import COLOURS, error_bars, new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = (
    ('success', 'perfect reconstruction\n[share of runs]'),
    ('regret', 'regret: optimum - success\n[probability]'),
    ('states', 'states evaluated\n[states per trial]'),
    ('blocks', 'blocks used\n[blocks per trial]'),
)
_DASHES = {'action': '--', 'subgoal': '-', 'replan': '-', 'blind': ':', 'none': '-'}
_MARKS = 'osv'


def uncertainty_figure(results: dict[str, Any]) -> Figure:
    """A panel for each of :data:`PANELS`: lines over the slip with 95 % intervals."""
    figure = new_figure(10, 6.6)
    with styled():
        axes = figure.subplots(2, 2, sharex=True).flat
        for letter, panel, (measure, label) in zip('ABCD', axes, PANELS, strict=True):
            _panel(panel, results, measure)
            panel.set_ylabel(label)
            panel.set_title(letter)
        axes[0].plot(
            *zip(*((row['slip'], row['mean']) for row in results['optima']), strict=True),
            color='black',
            lw=1,
            label='optimum',
        )
        axes[2].set_yscale('log')
        for panel in (axes[2], axes[3]):
            panel.set_xlabel('slip [probability]')
        figure.legend(*axes[0].get_legend_handles_labels(), loc='outside right', fontsize=7.5)
    return figure


def _panel(panel: Axes, results: dict[str, Any], measure: str) -> None:
    glued = [
        cell for cell in results['cells'] if cell['loss'] == 0 and cell['blocks_are'] == 'glued'
    ]
    planners = sorted({cell['planner'] for cell in glued})
    lambdas = sorted({name.split()[1] for name in planners if name.startswith('scoping')})
    for planner in planners:
        words = planner.split()
        cells = sorted((c for c in glued if c['planner'] == planner), key=lambda c: c['slip'])
        bars = [error_bars(cell[measure]) for cell in cells]
        mark = _MARKS[lambdas.index(words[1]) % 3] if words[0] == 'scoping' else 'o'
        panel.errorbar(
            [cell['slip'] for cell in cells],
            [mean for mean, _ in bars],
            yerr=[[bar[side][0] for _, bar in bars] for side in (0, 1)],
            color=COLOURS[words[0]],
            ls=_DASHES[words[-1]],
            marker=mark,
            ms=3,
            lw=1,
            elinewidth=0.5,
            label=planner,
        )


def loose_figure(results: dict[str, Any]) -> Figure:
    """Shares of falling towers of each planner, by tower, and of imperfect attempts of people."""
    figure = new_figure(9, 3.4)
    rows = results['loose']
    towers = sorted({row['stimulus'] for row in rows}, key=lambda name: (len(name), name))
    planners = list(dict.fromkeys(row['planner'] for row in rows))
    with styled():
        panel = figure.subplots()
        for number, planner in enumerate(planners):
            mine = {row['stimulus']: row for row in rows if row['planner'] == planner}
            shift = (number + 0.5) / len(planners) * 0.7 - 0.35
            panel.plot(
                [place + shift for place in range(len(towers))],
                [mine[tower]['falls'] for tower in towers],
                'osv^D<>ph'[number % 9],
                color=COLOURS[planner.split()[0]],
                ms=4,
                label=planner,
            )
        people = {row['stimulus']: 1 - row['people'] for row in rows}
        panel.hlines(
            [people[tower] for tower in towers],
            [place - 0.4 for place in range(len(towers))],
            [place + 0.4 for place in range(len(towers))],
            color=COLOURS['people'],
            label='people: attempts not perfect',
        )
        panel.set_xticks(range(len(towers)), [tower.split('/')[-1] for tower in towers])
        panel.set_xlabel('tower')
        panel.set_ylabel('towers that fall\n[share of trials]')
        figure.legend(loc='outside right', fontsize=7.5)
    return figure
