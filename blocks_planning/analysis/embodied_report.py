"""The report of the study of noise: a self-contained page, results and a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.embodied import Row, answers, summarise
from blocks_planning.analysis.pages import write_page
from blocks_planning.analysis.style import COLOURS, error_bars, new_figure, styled
from blocks_planning.extras import extra

with extra('figures'):
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PANELS = (
    ('success', 'perfect reconstruction\n[share of runs]'),
    ('f1', 'F1 of the real board'),
    ('surprises', 'surprises\n[per trial]'),
    ('states', 'states evaluated\n[states per trial]'),
)
_MARKS = 'osv^D'


def write_embodied(rows: list[Row], folder: Path, notes: list[str]) -> dict[str, Any]:
    """Write ``report.html``, ``results.json`` and ``figures/``.

    Args:
        rows: of the trials.
        folder: where to write.
        notes: sentences for the head of the report.

    Returns:
        The content of ``results.json``.
    """
    results = summarise(rows)
    results['answers'] = answers(results)
    write_page(folder, 'embodied.html', results, {'robot': embodied_figure(results)}, notes=notes)
    return results


def embodied_figure(results: dict[str, Any]) -> Figure:
    """A panel for each of :data:`PANELS`: marks by robot with 95 % intervals."""
    figure = new_figure(10, 6.6)
    robots = list(dict.fromkeys(cell['robot'] for cell in results['cells']))
    planners = list(dict.fromkeys(cell['planner'] for cell in results['cells']))
    with styled():
        axes = figure.subplots(2, 2, sharex=True).flat
        for letter, panel, (measure, label) in zip('ABCD', axes, PANELS, strict=True):
            for number, planner in enumerate(planners):
                shift = (number + 0.5) / len(planners) * 0.6 - 0.3
                cells = [cell for cell in results['cells'] if cell['planner'] == planner]
                _draw(panel, cells, measure, shift, _MARKS[number % len(_MARKS)])
            panel.set_ylabel(label)
            panel.set_title(letter)
            panel.set_xticks(range(len(robots)), robots, rotation=30, ha='right')
        axes[3].set_yscale('log')
        figure.legend(*axes[0].get_legend_handles_labels(), loc='outside right', fontsize=7.5)
    return figure


def _draw(panel: Axes, cells: list[Row], measure: str, shift: float, mark: str) -> None:
    bars = [error_bars(cell[measure]) for cell in cells]
    panel.errorbar(
        [place + shift for place in range(len(cells))],
        [mean for mean, _ in bars],
        yerr=[[bar[side][0] for _, bar in bars] for side in (0, 1)],
        color=COLOURS[cells[0]['planner'].split()[0]],
        ls='none',
        marker=mark,
        ms=4,
        elinewidth=0.7,
        label=cells[0]['planner'],
    )
