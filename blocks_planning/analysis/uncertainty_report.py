"""The report of the experiment in uncertain worlds: a self-contained page, results and figures."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

from blocks_planning.analysis.style import save_figure
from blocks_planning.analysis.uncertainty import read_uncertain, summarise
from blocks_planning.analysis.uncertainty_answers import answers
from blocks_planning.analysis.uncertainty_figure import loose_figure, uncertainty_figure
from blocks_planning.extras import extra

with extra('figures'):
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape


def write_uncertainty(
    sweep: Path, folder: Path, optima: list[dict[str, Any]], notes: list[str]
) -> dict[str, Any]:
    """Write ``report.html``, ``results.json`` and ``figures/`` of a finished sweep.

    Args:
        sweep: folder of the sweep.
        folder: where to write.
        optima: of :func:`.optima.optimum_table`.
        notes: sentences for the head of the report.

    Returns:
        The content of ``results.json``.

    Raises:
        InvalidInput: if the sweep has no tables.
    """
    results = summarise(read_uncertain(sweep), optima)
    results['answers'] = answers(results)
    figures = {'uncertainty': uncertainty_figure(results), 'loose': loose_figure(results)}
    paths = {name: save_figure(one, folder / 'figures', name) for name, one in figures.items()}
    text = json.dumps(results, indent=1, allow_nan=False)
    (folder / 'results.json').write_text(text + '\n', encoding='utf-8')
    environment = Environment(
        loader=PackageLoader('blocks_planning.analysis', 'templates'),
        autoescape=select_autoescape(['html']),
        undefined=StrictUndefined,
    )
    html = environment.get_template('uncertainty.html').render(
        results=results,
        answers=results['answers'],
        notes=notes,
        figures={name: _data_url(path) for name, path in paths.items()},
    )
    (folder / 'report.html').write_text(html, encoding='utf-8')
    return results


def _data_url(path: Path) -> str:
    return 'data:image/svg+xml;base64,' + base64.b64encode(path.read_bytes()).decode()
