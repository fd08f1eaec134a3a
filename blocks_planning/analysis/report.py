"""The report of a reproduction: ``report.html`` in one piece, ``results.json``, and figures."""

from __future__ import annotations

import base64
import json
from collections import Counter
from pathlib import Path
from typing import Any

from blocks_planning.analysis.paper import claims, table_1_settings
from blocks_planning.analysis.people import compare_people
from blocks_planning.analysis.people_figure import people_figure
from blocks_planning.analysis.planner_figures import figure_2, figure_3, figure_4
from blocks_planning.analysis.results import summarise
from blocks_planning.analysis.style import SEARCH_NAMES, save_figure
from blocks_planning.analysis.trials import (
    PRESET_TEXT,
    PRESETS,
    SEARCH_SETTINGS,
    read_decisions,
    read_trials,
)
from blocks_planning.analysis.verdicts import FAILS, SAME, WITHIN, compare
from blocks_planning.extras import extra

with extra('figures'):
    from jinja2 import Environment, PackageLoader, StrictUndefined, select_autoescape

VERDICTS = (WITHIN, SAME, FAILS)


def write_report(
    sweep: Path, folder: Path, exact: list[dict[str, Any]], notes: list[str]
) -> dict[str, Any]:
    """Write ``results.json``, ``report.html`` and ``figures/`` of a finished sweep.

    Args:
        sweep: folder of the sweep.
        folder: where to write.
        exact: rows of exact values of single attempts; see :func:`add_exact`.
        notes: sentences for the head of the report.

    Returns:
        What is in ``results.json``.

    Raises:
        InvalidInput: if the sweep has no tables.
    """
    trials = read_trials(sweep)
    presets = {name: summarise(trials, name) for name in PRESETS}
    for name, results in presets.items():
        add_exact(results['table1'], exact)
        results['claims'] = compare(results, name)
        results['people'] = compare_people(trials, name)
    figures = {
        'figure-2': figure_2(presets),
        'figure-3': figure_3(trials, read_decisions(sweep), list(presets)),
        'figure-4': figure_4(presets),
        'people': people_figure(presets['text']['people']),
    }
    paths = {name: save_figure(fig, folder / 'figures', name) for name, fig in figures.items()}
    written = {**presets['text'], 'preset': 'text', 'presets': presets, 'exact': exact}
    text = json.dumps(written, indent=1, allow_nan=False)
    (folder / 'results.json').write_text(text + '\n', encoding='utf-8')
    html = _render(
        presets=presets,
        preset_text=PRESET_TEXT,
        figures={name: _data_url(path) for name, path in paths.items()},
        notes=notes,
        verdicts=VERDICTS,
        counts={name: _count(results) for name, results in presets.items()},
        table1=_table_1_rows(presets),
        sample=_sample(trials),
        exact_budget=exact[0]['budget'] if exact else 0,
    )
    (folder / 'report.html').write_text(html, encoding='utf-8')
    return written


def add_exact(table1: list[dict[str, Any]], exact: list[dict[str, Any]]) -> None:
    """Put exact values beside the sampled ones of the same search, as ``exact``; else None."""
    for row in table1:
        wanted = {key: row[key] for key in ('search', *SEARCH_SETTINGS) if key in row}
        found = [item for item in exact if wanted.items() <= item.items()]
        row['exact'] = (
            {key: found[0][key] for key in ('success', 'states_evaluated', 'within_budget')}
            if found
            else None
        )


def _count(results: dict[str, Any]) -> dict[str, int]:
    counted = Counter(claim['verdict'] for claim in results['claims'])
    return {verdict: counted[verdict] for verdict in VERDICTS}


def _sample(trials: Any) -> dict[str, int]:
    scoping = trials[(trials['strategy'] == 'scoping') & (trials['search'] == 'bfs')]
    return {
        'trials': len(trials),
        'silhouettes': trials['stimulus'].nunique(),
        'seeds': trials['seed'].nunique(),
        'lambdas': scoping['lambda'].nunique(),
    }


def _table_1_rows(presets: dict[str, Any]) -> list[dict[str, Any]]:
    """The rows of Table 1 with their names and the paper's numbers: BFS once, A* per preset."""
    paper = {
        str(claim.path): {'mean': claim.value, 'ci': claim.interval}
        for claim in claims()
        if claim.path[0] == 'table1'
    }
    rows = []
    for preset, results in presets.items():
        for row in results['table1']:
            if preset != 'text' and row['search'] != 'astar':
                continue
            amount = row.get('depth') or row.get('iterations')
            place = ('table1', table_1_settings(row['search'], amount))
            name = SEARCH_NAMES.get(row['search'], row['search'])
            rows.append(
                {
                    **row,
                    'name': f'{name} ({preset})' if row['search'] == 'astar' else name,
                    'amount': _amount(row),
                    'paper_success': paper.get(str((*place, 'success'))),
                    'paper_cost': paper.get(str((*place, 'states_evaluated'))),
                }
            )
    return rows


def _amount(row: dict[str, Any]) -> str:
    if 'depth' in row:
        return f'depth {row["depth"]}'
    return f'{row["iterations"]:,} iterations' if 'iterations' in row else '-'


def _data_url(path: Path) -> str:
    return 'data:image/svg+xml;base64,' + base64.b64encode(path.read_bytes()).decode()


def format_number(value: float | None) -> str:
    """A number for people: four significant digits, thousands separated, '–' for none."""
    if value is None:
        return '–'
    if abs(value) >= 1e6:
        return f'{value / 1e6:,.2f} M'
    if abs(value) >= 100:
        return f'{value:,.0f}'
    return f'{value:.3g}' if value == 0 or abs(value) >= 1e-3 else f'{value:.1e}'


def format_interval(estimate: dict[str, Any]) -> str:
    """The interval of an estimate as text; empty if it has none."""
    bounds = estimate.get('ci')
    if not bounds or bounds[0] is None:
        return ''
    low, high = map(format_number, bounds)
    return f'[{low}, {high}]'


def _render(**content: Any) -> str:
    environment = Environment(
        loader=PackageLoader('blocks_planning.analysis', 'templates'),
        autoescape=select_autoescape(['html']),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(number=format_number, interval=format_interval)
    return environment.get_template('report.html').render(**content)
