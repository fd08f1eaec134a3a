"""The tables of the report that combine several parts of the results."""

from __future__ import annotations

from typing import Any

from blocks_planning.analysis.own_error import own_mean
from blocks_planning.analysis.paper_file import the_paper
from blocks_planning.analysis.style import SEARCH_NAMES
from blocks_planning.analysis.trials import SEARCH_SETTINGS, with_settings
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

SWITCHED = ('success', 'action_planning_cost', 'subgoal_planning_cost', 'blocks')
_COMMITS = ('subgoal', 'action')


def table_1_rows(presets: dict[str, Any]) -> list[dict[str, Any]]:
    """The rows of Table 1 with their names and the paper's numbers, in the paper's order."""
    claims = {str(claim.path): claim for claim in the_paper().claims}
    rows: list[dict[str, Any]] = []
    for preset, results in presets.items():
        for row in results['table1']:
            if row['search'] == 'random' and any(there['search'] == 'random' for there in rows):
                continue
            settings = {key: row[key] for key in ('depth', 'iterations') if key in row}
            of = {'search': row['search'], **settings}
            paper = {
                measure: claims.get(str(('table1', of, measure)))
                for measure in ('success', 'states_evaluated')
            }
            name = SEARCH_NAMES.get(row['search'], row['search'])
            rows.append(
                {
                    **row,
                    'name': name,
                    'preset': '' if row['search'] == 'random' else preset,
                    'budget': _budget(row),
                    'paper': {
                        measure: None if claim is None else claim.judged.to_json()
                        for measure, claim in paper.items()
                    },
                }
            )
    return sorted(rows, key=_table_1_order)


def _table_1_order(row: dict[str, Any]) -> tuple[int, int]:
    order = ('random', 'bfs', 'astar')
    return order.index(row['search']), row.get('depth') or row.get('iterations') or 0


def _budget(row: dict[str, Any]) -> str:
    if 'depth' in row:
        return f'depth {row["depth"]}'
    return f'{row["iterations"]:,} iterations' if 'iterations' in row else '–'


def switch_rows(trials: pd.DataFrame) -> list[dict[str, Any]]:
    """Scoping with every combination of search settings and executed part of a subgoal.

    Means are over the values of lambda and the seeds that all combinations have, so that one row
    differs from another by its settings alone.
    """
    scoping = trials[(trials['strategy'] == 'scoping') & (trials['budget'] > 0)]
    rows: list[dict[str, Any]] = []
    for search in SEARCH_NAMES:
        here = scoping[(scoping['search'] == search).to_numpy(bool)]
        parts = {
            (preset, commit): with_settings(here, {**_search_settings(preset), 'commit': commit})
            for preset in the_paper().presets
            for commit in _COMMITS
        }
        lambdas = _shared(list(parts.values()), 'lambda')
        seeds = _shared(list(parts.values()), 'seed')
        for (preset, commit), part in parts.items():
            is_shared = part['lambda'].round(9).isin(lambdas) & part['seed'].isin(seeds)
            chosen = part[is_shared]
            if chosen.empty:
                continue
            rows.append(
                {
                    'search': SEARCH_NAMES[search],
                    'settings': preset,
                    'commit': commit,
                    'lambdas': len(lambdas),
                    'seeds': len(seeds),
                    **{measure: own_mean(chosen, measure, seeds) for measure in SWITCHED},
                }
            )
    return rows


def _search_settings(preset: str) -> dict[str, str]:
    return {
        switch['setting']: switch[preset]
        for switch in the_paper().switches
        if switch['setting'] in SEARCH_SETTINGS
    }


def _shared(parts: list[pd.DataFrame], column: str) -> list[Any]:
    """The values of a column that every part with trials has, rising."""
    values = [set(part[column].round(9)) for part in parts if len(part)]
    return sorted(set.intersection(*values)) if values else []
