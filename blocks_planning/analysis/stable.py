"""Loose blocks: how often towers fall if the search knows that they can, and if it does not.

Numbers are means over towers of the means over seeds, with the bootstrap of
:class:`.uncertainty.Resampling`.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from blocks_planning.analysis.trials import read_measured
from blocks_planning.analysis.uncertainty import Resampling, table_of

MEASURES = ('success', 'falls', 'f1', 'states')


def stable_planners(sweep: Path) -> list[dict[str, Any]]:
    """Each strategy with each search, and an estimate of each measure.

    Args:
        sweep: folder of a finished sweep in a world of loose blocks.

    Raises:
        InvalidInput: if the folder has no finished sweep.
    """
    trials = read_measured(sweep)
    trials = trials.assign(falls=(trials['status'] == 'collapsed').to_numpy(float))
    resampling = Resampling.of(trials['stimulus'].nunique(), trials['seed'].nunique())
    return [
        {
            'strategy': str(strategy),
            'search': str(search),
            **{
                name: resampling.over_towers(resampling.by_tower(table_of(part, name))).to_json()
                for name in MEASURES
            },
        }
        for (strategy, search), part in trials.groupby(['strategy', 'search'], observed=True)
    ]


def in_words(planners: list[dict[str, Any]]) -> list[str]:
    """A sentence for each strategy, from the numbers of :func:`stable_planners`."""
    strategies = list(dict.fromkeys(planner['strategy'] for planner in planners))
    return [
        f'Loose blocks, {strategy}: '
        + '; '.join(
            f'with {planner["search"]} {planner["falls"]["mean"]:.0%} of the towers fall and '
            f'{planner["success"]["mean"]:.0%} are rebuilt'
            for planner in planners
            if planner['strategy'] == strategy
        )
        + '.'
        for strategy in strategies
    ]
