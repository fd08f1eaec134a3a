"""Comparison of models: fits of each session and of all, scored on the same choices."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from blocks_planning.fitting.choiceset import ChoiceSet, choice_set
from blocks_planning.fitting.estimation import Fit, fit, log_likelihood, profile_interval
from blocks_planning.fitting.models import Model
from blocks_planning.fitting.options import Ahead, OptionMaker, Solves
from blocks_planning.fitting.points import ChoicePoint

POOLED = 'all'
"""The name of all sessions together."""
Report = Callable[[int, int], None]


class Makers:
    """The option makers of models, made once for each family and horizon."""

    def __init__(self, own: Mapping[tuple[str, int], OptionMaker] | None = None) -> None:
        """Make options with shared solves.

        Args:
            own: makers by family and horizon, used before those made here.
        """
        self._made = dict(own or {})
        self._solves = Solves()

    def maker(self, model: Model) -> OptionMaker:
        """The maker of a model's options; the random model takes those of ``rows``."""
        key = model.regions or 'rows', model.horizon
        if key not in self._made:
            self._made[key] = Ahead(key[0], self._solves, key[1])
        return self._made[key]

    def choice_sets(
        self, points: Sequence[ChoicePoint], models: Sequence[Model], report: Report | None = None
    ) -> dict[str, ChoiceSet]:
        """The choices of some points as each model sees them, by the model's name."""
        found: dict[OptionMaker, ChoiceSet] = {}
        for model in models:
            maker = self.maker(model)
            if maker not in found:
                found[maker] = choice_set(points, maker, report)
        return {model.name: found[self.maker(model)] for model in models}


def cross_validate(choices: ChoiceSet, model: Model) -> float | None:
    """The log likelihood of the choices on each tower under a fit to all other towers [nats].

    None if there is only one tower.
    """
    towers = sorted(set(choices.tower))
    if len(towers) < 2:
        return None
    total = 0.0
    for tower in towers:
        left_out = choices.tower == tower
        found = fit(choices.where(~left_out), model)
        total += log_likelihood(choices.where(left_out), model, found.values)
    return total


def compare_models(
    sets: Mapping[str, ChoiceSet],
    models: Sequence[Model],
    intervals: bool = True,
    report: Report | None = None,
) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Fit every model to each session and to all of them.

    Args:
        sets: the same choices as each model sees them, by the model's name.
        models: the models to compare.
        intervals: whether to compute profile-likelihood intervals.
        report: called after each fit.

    Returns:
        Rows of two tables: of fits and of parameters; see docs/fitting.md for their columns.
    """
    sessions = sorted(set(next(iter(sets.values())).session))
    groups = [*sessions, POOLED] if len(sessions) > 1 else sessions
    fits: list[dict[str, Any]] = []
    parameters: list[dict[str, Any]] = []
    for session in groups:
        rows = []
        for model in models:
            choices = sets[model.name]
            if session != POOLED:
                choices = choices.where(choices.session == session)
            found = fit(choices, model)
            rows.append(_fit_row(session, choices, found))
            parameters += _parameter_rows(session, choices, found, intervals)
            if report:
                report(len(fits) + len(rows), len(groups) * len(models))
        fits += _with_differences(rows)
    return fits, parameters


def _fit_row(session: str, choices: ChoiceSet, found: Fit) -> dict[str, Any]:
    by_chance = -float(np.log(choices.drawable).sum())
    return {
        'session': session,
        'model': found.model.name,
        'choices': found.choices,
        'no_option': int((choices.chosen < 0).sum()),
        'parameters': len(found.model.parameters),
        'log_likelihood': found.log_likelihood,
        'pseudo_r2': 1 - found.log_likelihood / by_chance,
        'aic': found.aic,
        'bic': found.bic,
        'cv_log_likelihood': cross_validate(choices, found.model),
    }


def _with_differences(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of one session with the differences from the best model of the session."""
    for score in ('aic', 'bic'):
        least = min(row[score] for row in rows)
        for row in rows:
            row[f'delta_{score}'] = row[score] - least
    return rows


def _parameter_rows(
    session: str, choices: ChoiceSet, found: Fit, intervals: bool
) -> list[dict[str, Any]]:
    rows = []
    for name, value in found.values.items():
        low, high = profile_interval(choices, found, name) if intervals else (None, None)
        rows.append(
            {
                'session': session,
                'model': found.model.name,
                'parameter': name,
                'value': value,
                'low': low,
                'high': high,
            }
        )
    return rows
