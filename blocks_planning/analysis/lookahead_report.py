"""The report of the experiment with regions and horizons: a page, results and a figure."""

from __future__ import annotations

import base64
import json
from pathlib import Path
from typing import Any

from blocks_planning.analysis.lookahead import answers, read_lookahead, summarise
from blocks_planning.analysis.lookahead_figure import lookahead_figure
from blocks_planning.analysis.style import save_figure
from blocks_planning.extras import extra

with extra('figures'):
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape


def write_lookahead(sweep: Path, folder: Path, notes: list[str]) -> dict[str, Any]:
    """Write ``report.html``, ``results.json`` and ``figures/`` of a finished sweep.

    Args:
        sweep: folder of the sweep.
        folder: where to write.
        notes: sentences for the head of the report.

    Returns:
        The content of ``results.json``.

    Raises:
        InvalidInput: if the sweep has no tables.
    """
    results = summarise(read_lookahead(sweep))
    results['answers'] = answers(results)
    path = save_figure(lookahead_figure(results), folder / 'figures', 'lookahead')
    text = json.dumps(results, indent=1, allow_nan=False)
    (folder / 'results.json').write_text(text + '\n', encoding='utf-8')
    environment = Environment(
        loader=PackageLoader('blocks_planning.analysis', 'templates'),
        autoescape=select_autoescape(['html']),
        undefined=StrictUndefined,
    )
    figure = 'data:image/svg+xml;base64,' + base64.b64encode(path.read_bytes()).decode()
    page = environment.get_template('lookahead.html')
    html = page.render(results=results, notes=notes, figure=figure)
    (folder / 'report.html').write_text(html, encoding='utf-8')
    return results
