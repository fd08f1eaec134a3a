"""What every report writes: ``results.json`` and a self-contained ``report.html``."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from blocks_planning.analysis import formats
from blocks_planning.analysis.comparing import ratio_text
from blocks_planning.analysis.style import save_figure
from blocks_planning.extras import extra

with extra('experiments'):
    from joblib import Parallel, delayed
with extra('figures'):
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape
    from matplotlib.figure import Figure


def write_page(
    folder: Path,
    template: str,
    results: dict[str, Any],
    figures: Mapping[str, Figure],
    workers: int = 1,
    **content: Any,
) -> None:
    """Write ``results.json``, ``report.html`` and ``figures/``.

    Args:
        folder: where to write.
        template: file name of the template of the page.
        results: content of ``results.json``; numbers are finite. The template has it as ``results``.
        figures: by file name without ending. The template has their addresses as ``figures``.
        workers: number of processes that draw.
        content: what else the template shows.
    """
    drawn = Parallel(workers)(
        delayed(save_figure)(one, folder / 'figures', name) for name, one in figures.items()
    )
    paths = dict(zip(figures, drawn, strict=True))
    text = json.dumps(results, indent=1, allow_nan=False)
    (folder / 'results.json').write_text(text + '\n', encoding='utf-8')
    addresses = {name: _data_url(path) for name, path in paths.items()}
    html = (
        _environment().get_template(template).render(results=results, figures=addresses, **content)
    )
    (folder / 'report.html').write_text(html, encoding='utf-8')


def _data_url(path: Path) -> str:
    return 'data:image/svg+xml;base64,' + base64.b64encode(path.read_bytes()).decode()


def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader('blocks_planning.analysis', 'templates'),
        autoescape=select_autoescape(['html']),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        number=formats.format_number,
        interval=formats.format_interval,
        p=formats.format_p,
        own=formats.format_own,
        amount=formats.format_count,
        number_power=formats.format_power,
        ratio=ratio_text,
    )
    return environment
