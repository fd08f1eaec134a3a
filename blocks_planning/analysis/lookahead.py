"""Regions and horizons: success and costs of planners between scoping and full planning.

Every number is a mean over towers of the means over seeds, with the bootstrap of
:class:`.uncertainty.Resampling`. Costs are over all trials, successful or not. A planner is *worth its
cost* if no other one rebuilds as many towers with fewer states, or more towers with as many.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

from blocks_planning.analysis.trials import read_measured
from blocks_planning.analysis.uncertainty import Resampling, table_of
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd

MEASURES = ('success', 'states', 'blocks', 'decisions')
_ALONE = 'none', 'full'


def read_lookahead(folders: Iterable[Path]) -> pd.DataFrame:
    """The trials of finished sweeps as :func:`.trials.read_measured`, with a column ``planner``.

    Raises:
        InvalidInput: if a folder has no finished sweep.
    """
    trials = pd.concat(map(read_measured, folders), ignore_index=True)
    return trials.assign(planner=[_planner(row) for row in trials.to_dict('records')])


def _planner(row: dict[str, Any]) -> str:
    if row['strategy'] in _ALONE:
        return str(row['strategy'])
    return f'{row["regions"]} {row["horizon"]:.0f} lambda {row["lambda"]:g}'


def summarise(trials: pd.DataFrame) -> dict[str, Any]:
    """The content of the report, as data.

    Returns:
        ``seeds``: by slip; ``cells``: each planner in each world, with an estimate of each measure,
        the states for each tower that was rebuilt (``per_success``; None if none was), the status of
        its trials and whether it is ``worth`` its cost.
    """
    worlds = list(trials.groupby('slip', observed=True))
    cells = [cell for _, part in worlds for cell in _cells(part)]
    for cell in cells:
        others = [one for one in cells if one['slip'] == cell['slip']]
        cell['worth'] = not any(_beats(one, cell) for one in others)
    seeds = {f'{slip:g}': sorted(map(int, part['seed'].unique())) for slip, part in worlds}
    return {'trials': len(trials), 'seeds': seeds, 'cells': cells}


def _cells(trials: pd.DataFrame) -> Iterator[dict[str, Any]]:
    """The planners in one world."""
    resampling = Resampling.of(trials['stimulus'].nunique(), trials['seed'].nunique())
    for (slip, planner), part in trials.groupby(['slip', 'planner'], observed=True):
        first = part.iloc[0]
        found = {
            name: resampling.over_towers(resampling.by_tower(table_of(part, name))).to_json()
            for name in MEASURES
        }
        success, states = (found[name]['mean'] for name in ('success', 'states'))
        alone = first['strategy'] in _ALONE
        yield {
            'planner': planner,
            'family': str(first['strategy'] if alone else first['regions']),
            'horizon': None if alone else int(first['horizon']),
            'lambda': None if alone else float(first['lambda']),
            'slip': float(slip),
            **found,
            'per_success': states / success if success else None,
            'statuses': {str(k): int(v) for k, v in part['status'].value_counts().items() if v},
        }


def _beats(one: dict[str, Any], other: dict[str, Any]) -> bool:
    """Whether a planner is at least as good in success and states, and better in one of them."""
    ours, theirs = ((-cell['success']['mean'], cell['states']['mean']) for cell in (one, other))
    return ours != theirs and all(a <= b for a, b in zip(ours, theirs, strict=True))


def answers(results: dict[str, Any]) -> list[str]:
    """Where the sweet spot is, in words that follow the numbers."""
    slips = sorted({cell['slip'] for cell in results['cells']})
    return [_answer([c for c in results['cells'] if c['slip'] == slip], slip) for slip in slips]


def _answer(cells: list[dict[str, Any]], slip: float) -> str:
    worth = sorted((c for c in cells if c['worth']), key=lambda cell: cell['states']['mean'])
    shown = '; '.join(
        f'{c["planner"]} rebuilds {c["success"]["mean"]:.2f} at {c["states"]["mean"]:,.0f} states'
        for c in worth
    )
    rebuilding = [c for c in cells if c['family'] != 'none' and c['per_success'] is not None]
    if not rebuilding:
        return f'Slip {slip:g}: {shown}. No planner with subgoals rebuilds a tower.'
    best = min(rebuilding, key=lambda cell: float(cell['per_success']))
    return (
        f'Slip {slip:g}: planners that no other one beats: {shown}. Of those with subgoals, '
        f'{best["planner"]} needs the fewest states for each tower that it rebuilds '
        f'({best["per_success"]:,.0f}).'
    )
