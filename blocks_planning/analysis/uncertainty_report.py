"""The report of the experiment in uncertain worlds: a self-contained page, results and figures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.pages import write_page
from blocks_planning.analysis.stable import in_words, stable_planners
from blocks_planning.analysis.uncertainty import read_uncertain, summarise
from blocks_planning.analysis.uncertainty_answers import answers
from blocks_planning.analysis.uncertainty_figure import loose_figure, uncertainty_figure


def write_uncertainty(
    sweep: Path, stable: Path, folder: Path, optima: list[dict[str, Any]], notes: list[str]
) -> dict[str, Any]:
    """Write ``report.html``, ``results.json`` and ``figures/`` of two finished sweeps.

    Args:
        sweep: folder of the sweep of uncertain worlds.
        stable: folder of the sweep of searches that know that towers fall.
        folder: where to write.
        optima: of :func:`.optima.optimum_table`.
        notes: sentences for the head of the report.

    Returns:
        The content of ``results.json``.

    Raises:
        InvalidInput: if a sweep has no tables.
    """
    results = summarise(read_uncertain(sweep), optima)
    results['stable'] = stable_planners(stable)
    results['answers'] = [*answers(results), *in_words(results['stable'])]
    figures = {'uncertainty': uncertainty_figure(results), 'loose': loose_figure(results)}
    write_page(folder, 'uncertainty.html', results, figures, notes=notes)
    return results
