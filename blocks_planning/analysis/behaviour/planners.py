"""The builds of planners, in the same form as those of people."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from pathlib import Path

from blocks_planning.analysis.trials import planners_of, read_trials
from blocks_planning.board.blocks import Placed
from blocks_planning.extras import extra
from blocks_planning.people.data import SET, Build
from blocks_planning.trials.record import TrialRecord

with extra('experiments'):
    import pandas as pd

NAMED_BY = ('search', 'strategy')
AND_BY = ('regions', 'horizon')
"""Columns of the table of trials that tell planners apart; the latter if they have several values."""


def builds_of_records(records: Iterable[TrialRecord]) -> list[Build]:
    """The builds of some trials; trials of one seed have one builder."""
    return [
        Build(
            str(record.spec.seed),
            record.spec.stimulus.rpartition('/')[2],
            tuple(record.placements),
        )
        for record in records
    ]


def builds_of_sweep(
    folder: Path, towers: Collection[str], preset: str = 'published'
) -> dict[str, list[Build]]:
    """The builds of every subgoal planner of a finished sweep, by the planner's name.

    Of a planner that was run at many values of lambda, those at the middle one are taken.

    Args:
        folder: of the sweep.
        towers: names of the silhouettes to take, as in :data:`.data.SET`.
        preset: of A*; see :data:`.trials.PRESETS`.

    Raises:
        InvalidInput: if the folder has no finished sweep.
    """
    trials = planners_of(read_trials(folder), preset)
    trials = trials[trials['stimulus'].isin([f'{SET}/{tower}' for tower in towers])]
    named_by = [*NAMED_BY, *(name for name in AND_BY if _differs(trials, name))]
    groups = {
        ' '.join(_word(value) for value in key if not pd.isna(value)): _at_middle_lambda(part)
        for key, part in trials.groupby(named_by, observed=True, dropna=False, sort=False)
    }
    wanted = pd.concat([part['trial_id'] for part in groups.values()]) if groups else []
    placements = _placements(folder, set(wanted))
    return {
        name: [
            Build(str(trial.seed), str(trial.stimulus).rpartition('/')[2], placed)
            for trial in part.itertuples()
            for placed in [placements.get(trial.trial_id, ())]
        ]
        for name, part in groups.items()
    }


def _word(value: object) -> str:
    return f'{value:g}' if isinstance(value, float) else str(value)


def _differs(trials: pd.DataFrame, name: str) -> bool:
    return name in trials and trials[name].nunique() > 1


def _at_middle_lambda(trials: pd.DataFrame) -> pd.DataFrame:
    values = sorted(trials['lambda'].dropna().unique())
    if not values:
        return trials
    return trials[trials['lambda'] == values[len(values) // 2]]


def _placements(folder: Path, wanted: set[str]) -> dict[str, tuple[Placed, ...]]:
    """The placements of some trials, in order, by the trial's id."""
    table = pd.read_parquet(folder / 'placements.parquet')
    table = table[table['trial_id'].isin(wanted)].sort_values('placement', kind='stable')
    rows = zip(
        table['trial_id'].astype(str),
        *(table[name].astype(int) for name in Placed._fields),
        strict=True,
    )
    found: dict[str, list[Placed]] = {}
    for trial_id, *numbers in rows:
        found.setdefault(trial_id, []).append(Placed(*numbers))
    return {trial_id: tuple(placed) for trial_id, placed in found.items()}
