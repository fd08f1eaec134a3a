"""The report of the experiment with regions and horizons: a page, results and a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.lookahead import answers, read_lookahead, summarise
from blocks_planning.analysis.lookahead_figure import lookahead_figure
from blocks_planning.analysis.pages import write_page


def write_lookahead(sweeps: list[Path], folder: Path, notes: list[str]) -> dict[str, Any]:
    """Write ``report.html``, ``results.json`` and ``figures/`` of finished sweeps.

    Args:
        sweeps: folders of the sweeps.
        folder: where to write.
        notes: sentences for the head of the report.

    Returns:
        The content of ``results.json``.

    Raises:
        InvalidInput: if a sweep has no tables.
    """
    results = summarise(read_lookahead(sweeps))
    results['answers'] = answers(results)
    write_page(
        folder, 'lookahead.html', results, {'lookahead': lookahead_figure(results)}, notes=notes
    )
    return results
