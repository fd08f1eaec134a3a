"""Tables of a fit as CSV files: one row per observation, one name per column."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from blocks_planning.board.geometry import area
from blocks_planning.fitting.points import ChoicePoint

COLUMNS = {
    'fits': (
        *('session', 'model', 'choices', 'no_option', 'parameters', 'log_likelihood'),
        *('pseudo_r2', 'aic', 'bic', 'cv_log_likelihood', 'delta_aic', 'delta_bic'),
    ),
    'parameters': ('session', 'model', 'parameter', 'value', 'low', 'high'),
    'choices': ('session', 'tower', 'built', 'cells', 'chosen'),
}
"""The columns of each table; docs/fitting.md explains them."""


def choice_rows(points: Sequence[ChoicePoint]) -> list[dict[str, Any]]:
    """The choices that models were fitted to; ``built`` and ``chosen`` are hexadecimal masks."""
    return [
        {
            'session': point.session,
            'tower': point.tower,
            'built': hex(point.built),
            'cells': area(point.cells),
            'chosen': hex(point.cells),
        }
        for point in points
    ]


def write_table(folder: Path, name: str, rows: Sequence[dict[str, Any]]) -> Path:
    """Write NAME.csv; unknown values are empty fields.

    Args:
        folder: created if it does not exist.
        name: of a table in :data:`COLUMNS`.
        rows: dicts with those columns.
    """
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f'{name}.csv'
    with path.open('w', encoding='utf-8', newline='') as file:
        writer = csv.DictWriter(file, COLUMNS[name], lineterminator='\n')
        writer.writeheader()
        writer.writerows(rows)
    return path
