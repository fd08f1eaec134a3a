"""How the states evaluated grow with the board: fits, a table and a figure."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from blocks_planning.analysis.style import COLOURS, new_figure, styled
from blocks_planning.analysis.trials import read_trials
from blocks_planning.extras import extra

with extra('experiments'):
    import pandas as pd
with extra('figures'):
    from matplotlib.figure import Figure

WAYS = {
    'height': 'height [cells], at width 8',
    'width': 'width [cells], at height 8',
    'side': 'height = width [cells]',
}
_BASE = 8
LEAST_SIDES = 3
"""Fewest different sides to which a law is fitted."""


class Fit(NamedTuple):
    """How a cost depends on a side of the board.

    Attributes:
        law: 'exponential', cost = a * base**side, or 'power', cost = a * side**base.
        factor: a [states].
        base: see ``law``.
        r2: share of the variance of log cost that the law explains.
    """

    law: str
    factor: float
    base: float
    r2: float

    def at(self, side: np.ndarray) -> np.ndarray:
        """The cost at some sides [states]."""
        grown = self.base**side if self.law == 'exponential' else side**self.base
        return self.factor * grown

    def __str__(self) -> str:
        if self.law == 'exponential':
            return f'x {self.base:.2f} per cell'
        return f'side^{self.base:.1f}'


def fit(side: np.ndarray, cost: np.ndarray) -> Fit | None:
    """The better of both laws, by least squares on log cost; costs of 0 are left out.

    Args:
        side: float64 (n,) [cells].
        cost: float64 (n,) [states].

    Returns:
        None if fewer than ``LEAST_SIDES`` different sides have a cost: both laws have two
        constants, so that any two points lie on either.
    """
    present = cost > 0
    side, cost = side[present].astype(float), np.log(cost[present])
    if len(np.unique(side)) < LEAST_SIDES:
        return None
    fits = []
    for law, x in (('exponential', side), ('power', np.log(side))):
        slope, level = np.polyfit(x, cost, 1)
        rest = cost - (slope * x + level)
        spread = ((cost - cost.mean()) ** 2).sum()
        r2 = 1 - float((rest**2).sum() / spread) if spread else 1.0
        base = float(np.exp(slope)) if law == 'exponential' else float(slope)
        fits.append(Fit(law, float(np.exp(level)), base, r2))
    return max(fits, key=lambda found: found.r2)


def read_growth(folder: Path) -> pd.DataFrame:
    """The trials of a growth sweep with ``width``, ``height`` [cells] and ``states``.

    ``states`` is all that a trial evaluated while planning, successful or not [states].

    Raises:
        InvalidInput: if the folder has no finished sweep.
    """
    trials = read_trials(folder)
    decisions = pd.read_parquet(folder / 'decisions.parquet', columns=['trial_id', 'considered'])
    states = decisions.groupby('trial_id', observed=True)['considered'].sum()
    trials['states'] = trials['trial_id'].map(states).fillna(0).to_numpy(float)
    size = trials['stimulus'].astype(str).str.extract(r'^(\d+)x(\d+)/').astype(int)
    return trials.assign(width=size[0], height=size[1])


def way_of(trials: pd.DataFrame, way: str) -> pd.DataFrame:
    """The trials on boards that grow in one way, with the growing side as ``side`` [cells]."""
    chosen = {
        'height': trials['width'] == _BASE,
        'width': trials['height'] == _BASE,
        'side': trials['width'] == trials['height'],
    }[way]
    part = trials[chosen]
    return part.assign(side=part['height'] if way != 'width' else part['width'])


def growth_table(trials: pd.DataFrame) -> list[dict[str, Any]]:
    """Mean states evaluated and success by way, side and planner, and the fits."""
    rows: list[dict[str, Any]] = []
    for way in WAYS:
        for strategy, part in way_of(trials, way).groupby('strategy', observed=True):
            means = part.groupby('side')[['states', 'success']].mean()
            found = fit(means.index.to_numpy(float), means['states'].to_numpy(float))
            rows.append(
                {
                    'way': way,
                    'strategy': strategy,
                    'sides': means.index.tolist(),
                    'states': means['states'].tolist(),
                    'success': means['success'].tolist(),
                    'fit': None if found is None else found._asdict(),
                }
            )
    return rows


def growth_figure(rows: list[dict[str, Any]], budget: int) -> Figure:
    """States evaluated over the side of the board, with fits; success below."""
    figure = new_figure(9.5, 5.8)
    with styled():
        axes = figure.subplots(
            2, len(WAYS), sharey='row', sharex='col', gridspec_kw={'height_ratios': [3, 1]}
        )
        for (above, below), (way, label) in zip(axes.T, WAYS.items(), strict=True):
            above.axhline(budget, color='black', lw=0.8, dashes=(1, 2))
            above.annotate(
                'budget b of a solve',
                (1, budget),
                xycoords=('axes fraction', 'data'),
                xytext=(0, -3),
                textcoords='offset points',
                ha='right',
                va='top',
                fontsize=7.5,
            )
            for row in (row for row in rows if row['way'] == way):
                _draw(above, below, row)
            above.set_yscale('log')
            above.legend(fontsize=7.5, loc='upper left')
            below.set_xlabel(label)
            below.set_ylim(-0.05, 1.05)
        low, high = axes[0][0].get_ylim()
        axes[0][0].set_ylim(low, high * 30)  # room for the legends
        axes[0][0].set_ylabel('states evaluated\nper trial [states]')
        axes[1][0].set_ylabel('perfect\n[share of runs]')
    return figure


def _draw(above: Any, below: Any, row: dict[str, Any]) -> None:
    sides, strategy = np.array(row['sides'], float), row['strategy']
    found = None if row['fit'] is None else Fit(**row['fit'])
    colour = COLOURS[strategy]
    label = f'{strategy}: {found or "too few sizes for a law"}'
    above.plot(sides, row['states'], 'o', color=colour, label=label)
    if found is not None:
        line = np.linspace(sides.min(), sides.max(), 50)
        above.plot(line, found.at(line), color=colour, lw=1)
    below.plot(sides, row['success'], 'o-', color=colour, ms=3, lw=1)
