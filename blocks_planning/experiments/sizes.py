"""Sizes of the towers of a sweep, for a report: states, and sequences of placements."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from blocks_planning.errors import LimitExceeded
from blocks_planning.extras import extra
from blocks_planning.search.counting import count_task
from blocks_planning.trials.script import Tower


def size_table(towers: Sequence[Tower], workers: int) -> list[dict[str, Any]]:
    """The sizes of towers; see :class:`.counting.TaskSize`.

    Returns:
        A dict per tower: ``tower``, ``cells``, ``states``, ``complete_sequences`` and
        ``sequences``. The numbers are None if the tower exceeds a limit.
    """
    with extra('experiments'):
        from joblib import Parallel, delayed

    rows: list[dict[str, Any]] = Parallel(n_jobs=workers)(delayed(_row)(tower) for tower in towers)
    return rows


def _row(tower: Tower) -> dict[str, Any]:
    try:
        found = count_task(tower.task)
    except LimitExceeded:
        found = None
    keys = ('states', 'complete_sequences', 'sequences')
    return {
        'tower': tower.name,
        'cells': tower.task.silhouette.bit_count(),
        **{key: None if found is None else getattr(found, key) for key in keys},
    }
