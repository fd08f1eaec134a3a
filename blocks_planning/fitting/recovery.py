"""Recovery of parameters and models from simulated choices.

A session says where a simulated participant chooses: in the states of some records, with
``partial(choose_again, points)``, or on towers that it rebuilds, with ``partial(roll_out, name,
towers, asking)``; see :mod:`.simulation`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from blocks_planning.fitting.comparison import Makers
from blocks_planning.fitting.estimation import fit
from blocks_planning.fitting.models import Model
from blocks_planning.fitting.points import ChoicePoint
from blocks_planning.fitting.simulation import Chooser

RANGES = {'lambda': (5e-4, 5e-3), 'temperature': (0.5, 2.0), 'lapse': (0.01, 0.1)}
"""Ranges of the parameters of simulated participants, drawn uniformly in their logarithm."""
Session: TypeAlias = Callable[[Chooser], list[ChoicePoint]]
"""The choices that a simulated participant makes."""
Report = Callable[[int, int], None]


def draw_values(model: Model, rng: np.random.Generator) -> dict[str, float]:
    """Parameters of a simulated participant."""
    found = {}
    for name in model.parameters:
        low, high = np.log(RANGES[name])
        found[name] = float(np.exp(rng.uniform(low, high)))
    return found


def recover_parameters(
    sessions: Sequence[Session],
    model: Model,
    makers: Makers,
    seed: int,
    report: Report | None = None,
) -> list[dict[str, Any]]:
    """Draw parameters for each session, simulate its choices, and fit these.

    Args:
        sessions: of each simulated participant.
        model: that chooses and is fitted.
        makers: of options.
        seed: of all draws.
        report: called after each session.

    Returns:
        A row for each session and parameter: ``session``, ``choices``, ``parameter``, ``true``,
        ``fitted`` and ``relative_error``, which is abs(fitted - true) / true.
    """
    rows = []
    for number, session in enumerate(sessions):
        rng = np.random.default_rng([seed, number])
        true = draw_values(model, rng)
        chosen = session(Chooser(model, true, makers.maker(model), rng))
        found = fit(makers.choice_sets(chosen, [model])[model.name], model)
        rows += [
            {
                'session': number,
                'choices': len(chosen),
                'parameter': name,
                'true': true[name],
                'fitted': found.values[name],
                'relative_error': abs(found.values[name] - true[name]) / true[name],
            }
            for name in model.parameters
        ]
        if report:
            report(number + 1, len(sessions))
    return rows


def recover_models(
    sessions: Sequence[Session],
    models: Sequence[Model],
    makers: Makers,
    seed: int,
    report: Report | None = None,
) -> list[dict[str, Any]]:
    """Simulate the choices of each model in each session, and find the best model (BIC).

    Arguments as for :func:`recover_parameters`.

    Returns:
        A row for each true model and session: ``model``, ``session``, ``choices``, ``winner``.
    """
    rows = []
    for place, true in enumerate(models):
        for number, session in enumerate(sessions):
            rng = np.random.default_rng([seed, place, number])
            chosen = session(Chooser(true, draw_values(true, rng), makers.maker(true), rng))
            sets = makers.choice_sets(chosen, models)
            scores = {model.name: fit(sets[model.name], model).bic for model in models}
            rows.append(
                {
                    'model': true.name,
                    'session': number,
                    'choices': len(chosen),
                    'winner': min(scores, key=lambda name: scores[name]),
                }
            )
            if report:
                report(len(rows), len(models) * len(sessions))
    return rows


def median_errors(rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The median relative error of each parameter of :func:`recover_parameters`."""
    names = dict.fromkeys(row['parameter'] for row in rows)
    return {
        name: float(np.median([row['relative_error'] for row in rows if row['parameter'] == name]))
        for name in names
    }


def win_rates(rows: Sequence[Mapping[str, Any]]) -> dict[str, dict[str, float]]:
    """How often each model fits best for each true model, from :func:`recover_models`."""
    names = list(dict.fromkeys(row['model'] for row in rows))
    found = {}
    for true in names:
        winners = [row['winner'] for row in rows if row['model'] == true]
        found[true] = {name: winners.count(name) / len(winners) for name in names}
    return found
