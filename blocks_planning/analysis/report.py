"""The report of a reproduction: a self-contained ``report.html``, ``results.json``, and figures."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.behaviour.section import (
    behaviour_figures,
    compare_behaviour,
    section_content,
)
from blocks_planning.analysis.beyond import beyond_rows
from blocks_planning.analysis.comparing import compare, count_verdicts
from blocks_planning.analysis.pages import write_page
from blocks_planning.analysis.paper_file import the_paper
from blocks_planning.analysis.people import compare_people
from blocks_planning.analysis.people_figure import people_figure
from blocks_planning.analysis.planner_figures import figure_2, figure_4
from blocks_planning.analysis.report_tables import switch_rows, table_1_rows
from blocks_planning.analysis.results import summarise
from blocks_planning.analysis.stripes import figure_3
from blocks_planning.analysis.trials import (
    COMPARED,
    PRESETS,
    SEARCH_SETTINGS,
    read_decisions,
    read_trials,
)
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd
    from joblib import Parallel, delayed
with extra('figures'):
    from matplotlib.figure import Figure

MAIN = PRESETS[0]
"""The preset whose numbers are at the top of ``results.json``."""


def write_report(
    sweep: Path,
    beyond: Path,
    folder: Path,
    exact: list[dict[str, Any]],
    sizes: list[dict[str, Any]],
    notes: list[str],
    workers: int = 1,
) -> dict[str, Any]:
    """Write ``results.json``, ``report.html`` and ``figures/`` of a finished sweep.

    Args:
        sweep: folder of the sweep.
        beyond: folder of the sweep of searches beyond the paper; see :func:`beyond_rows`.
        folder: where to write.
        exact: rows of exact values of single attempts; see :func:`add_exact`.
        sizes: a row for each tower; see :func:`.sizes.size_table`.
        notes: sentences for the head of the report.
        workers: number of processes that compute and draw.

    Returns:
        The content of ``results.json``.

    Raises:
        InvalidInput: if a sweep has no tables.
    """
    trials = read_trials(sweep)
    presets, behaviour = Parallel(workers)(
        [delayed(_presets)(trials, exact), delayed(compare_behaviour)(sweep, MAIN)]
    )
    switched, other_searches = switch_rows(trials), beyond_rows(beyond)
    written = {
        **presets[MAIN],
        'preset': MAIN,
        'presets': presets,
        'exact': exact,
        'sizes': sizes,
        'switches': switched,
        'behaviour': behaviour,
        'beyond': other_searches,
    }
    write_page(
        folder,
        'report.html',
        written,
        _figures(presets, trials, read_decisions(sweep)) | behaviour_figures(behaviour),
        workers,
        paper=the_paper(),
        presets=presets,
        main=MAIN,
        notes=notes,
        counts={name: count_verdicts(results['claims']) for name, results in presets.items()},
        table1=table_1_rows(presets),
        switched=switched,
        sizes=sizes,
        sample=_sample(trials),
        behaviour=section_content(behaviour),
        beyond=other_searches,
        exact_budget=exact[0]['budget'] if exact else 0,
    )
    return written


def _presets(trials: pd.DataFrame, exact: list[dict[str, Any]]) -> dict[str, Any]:
    """The numbers of each preset, compared with the paper's claims and with people."""
    trials = trials[list(COMPARED)]  # a row with all settings is several times as wide
    presets = {name: summarise(trials, name) for name in PRESETS}
    compared = compare(presets, trials)
    for name, results in presets.items():
        add_exact(results['table1'], exact)
        results['claims'] = compared[name]
        results['people'] = compare_people(trials, name)
    return presets


def _figures(
    presets: dict[str, Any], trials: pd.DataFrame, decisions: pd.DataFrame
) -> dict[str, Figure]:
    figures = {'figure-2': figure_2(presets)}
    for name, results in presets.items():
        figures[f'figure-3-{name}'] = figure_3(trials, decisions, name)
        figures[f'figure-4-{name}'] = figure_4(results)
    figures['people'] = people_figure(presets[MAIN]['people'])
    return figures


def add_exact(table1: list[dict[str, Any]], exact: list[dict[str, Any]]) -> None:
    """Add the exact values of each search to the sampled ones, as ``exact``; None without any."""
    for row in table1:
        wanted = {key: row[key] for key in ('search', *SEARCH_SETTINGS) if key in row}
        found = [item for item in exact if wanted.items() <= item.items()]
        row['exact'] = (
            {key: found[0][key] for key in ('success', 'states_evaluated', 'within_budget')}
            if found
            else None
        )


def _sample(trials: pd.DataFrame) -> dict[str, int]:
    scoping = trials[(trials['strategy'] == 'scoping') & (trials['search'] == 'bfs')]
    return {
        'trials': len(trials),
        'silhouettes': trials['stimulus'].nunique(),
        'seeds': trials['seed'].nunique(),
        'lambdas': scoping.groupby('experiment', observed=True)['lambda'].nunique().max(),
    }
