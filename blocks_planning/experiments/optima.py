"""The success of the best policy on the towers of a sweep, at the slips of its worlds."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.experiments.spec import SweepSpec
from blocks_planning.extras import extra
from blocks_planning.search.result import Problem
from blocks_planning.search.slipping import analyse_slips
from blocks_planning.trials.script import Tower
from blocks_planning.worlds.world import Simulated

_MOST_AT_ONCE = 2
"""Number of towers that are analysed at the same time; each takes up to 0.5 GB."""


def optimum_table(sweep: SweepSpec, folder: Path, workers: int) -> list[dict[str, Any]]:
    """The optimum of every tower at every slip of a sweep; computed once and kept in ``folder``.

    Returns:
        A dict per tower and slip: ``stimulus``, ``slip`` and ``optimum``, a probability. It is
        None if the tower has more states than the limit.

    Raises:
        ConfigurationError: if the file of a finished table cannot be read.
    """
    path = folder / f'optimum-{sweep.sweep_id}.json'
    if path.is_file():
        try:
            kept: list[dict[str, Any]] = json.loads(path.read_text(encoding='utf-8'))
        except ValueError:
            raise ConfigurationError(
                f'{path}: is not a table of optima; delete it to compute it again'
            ) from None
        return kept
    with extra('experiments'):
        from joblib import Parallel, delayed

    slips = slips_of(sweep)
    found = Parallel(n_jobs=min(workers, _MOST_AT_ONCE))(
        delayed(_rows)(tower, slips) for tower in sweep.towers
    )
    rows = [row for of_tower in found for row in of_tower]
    part = path.with_suffix('.part')
    part.write_text(json.dumps(rows, indent=1) + '\n', encoding='utf-8')
    part.replace(path)
    return rows


def slips_of(sweep: SweepSpec) -> list[float]:
    """The slips of the simulated worlds of a sweep, in rising order."""
    return sorted(
        {
            world.slip
            for experiment in sweep.experiments
            for world in experiment.worlds
            if isinstance(world, Simulated)
        }
    )


def _rows(tower: Tower, slips: list[float]) -> list[dict[str, Any]]:
    try:
        found = analyse_slips(Problem(tower.task, 0, tower.task.silhouette), slips)
    except LimitExceeded:
        found = None
    optima = [None] * len(slips) if found is None else [chances.optimum for chances in found]
    return [
        {'stimulus': tower.name, 'slip': slip, 'optimum': optimum}
        for slip, optimum in zip(slips, optima, strict=True)
    ]
