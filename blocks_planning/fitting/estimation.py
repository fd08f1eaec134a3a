"""Maximum likelihood: the parameters of a model, their intervals, and scores for comparison."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from blocks_planning.extras import extra
from blocks_planning.fitting.choiceset import ChoiceSet
from blocks_planning.fitting.models import BOUNDS, Model, log_likelihoods

with extra('experiments'):
    from scipy.optimize import brentq, minimize

_STARTS = {'lambda': (1e-4, 1e-3, 1e-2), 'temperature': (0.5, 4.0), 'lapse': (0.05,)}
_STARTS_FOLLOWED = 2
_CHI_SQUARED = 3.841458820694124
"""95th percentile with one degree of freedom."""
_WORST = 1e9


@dataclass(frozen=True)
class Fit:
    """A fitted model.

    Attributes:
        model: the model.
        values: the parameters of highest likelihood.
        log_likelihood: of all choices [nats].
        choices: number of choices.
    """

    model: Model
    values: dict[str, float]
    log_likelihood: float
    choices: int

    @property
    def aic(self) -> float:
        """Akaike's criterion: lower is better."""
        return 2 * len(self.model.parameters) - 2 * self.log_likelihood

    @property
    def bic(self) -> float:
        """Bayes's criterion: lower is better."""
        penalty = len(self.model.parameters) * math.log(max(1, self.choices))
        return penalty - 2 * self.log_likelihood


def fit(choices: ChoiceSet, model: Model) -> Fit:
    """The parameters of maximum likelihood of some choices.

    Parameters are optimised within :data:`.models.BOUNDS`, from several starts; the result
    depends only on the arguments.
    """
    values = _maximise(choices, model, {})
    return Fit(model, values, log_likelihood(choices, model, values), len(choices))


def log_likelihood(choices: ChoiceSet, model: Model, values: Mapping[str, float]) -> float:
    """The log likelihood of all choices [nats]."""
    return float(log_likelihoods(choices, model, values).sum())


def profile_interval(
    choices: ChoiceSet, found: Fit, parameter: str
) -> tuple[float | None, float | None]:
    """The 95 % profile-likelihood interval of a parameter; None for an end without a bound.

    For each value of the parameter the others are fitted again. The interval contains all values
    whose log likelihood is less than 1.92 below the highest.
    """
    low, high = (_scaled(parameter, bound) for bound in BOUNDS[parameter])
    best = _scaled(parameter, found.values[parameter])

    def excess(place: float) -> float:
        fixed = {parameter: _unscaled(parameter, place)}
        values = _maximise(choices, found.model, fixed, found.values)
        there = log_likelihood(choices, found.model, values)
        return 2 * (found.log_likelihood - there) - _CHI_SQUARED

    return _crossing(excess, parameter, best, low), _crossing(excess, parameter, best, high)


def _crossing(
    excess: Callable[[float], float], parameter: str, best: float, bound: float
) -> float | None:
    """Where the likelihood falls below the threshold between the best value and a bound."""
    step, inside = math.copysign(0.5, bound - best), best
    while inside != bound:
        outside = bound if abs(bound - inside) <= abs(step) else inside + step
        if excess(outside) > 0:
            return _unscaled(parameter, float(brentq(excess, inside, outside, xtol=1e-3)))
        inside, step = outside, 2 * step
    return None


def _maximise(
    choices: ChoiceSet,
    model: Model,
    fixed: Mapping[str, float],
    near: Mapping[str, float] | None = None,
) -> dict[str, float]:
    """Values of all parameters, some of them fixed, the others of highest likelihood."""
    free = [name for name in model.parameters if name not in fixed]

    def values_at(place: np.ndarray) -> dict[str, float]:
        found = {name: _unscaled(name, at) for name, at in zip(free, place, strict=True)}
        return {name: fixed.get(name, found.get(name, 0.0)) for name in model.parameters}

    def badness(place: np.ndarray) -> float:
        found = -log_likelihood(choices, model, values_at(place))
        return found if math.isfinite(found) else _WORST

    if not free or not len(choices):
        return values_at(np.array([_scaled(name, _STARTS[name][0]) for name in free]))
    bounds = [tuple(_scaled(name, bound) for bound in BOUNDS[name]) for name in free]
    starts = [
        np.array([_scaled(name, at) for name, at in zip(free, start, strict=True)])
        for start in ([[near[name] for name in free]] if near else _grid(free))
    ]
    starts = sorted(starts, key=badness)[:_STARTS_FOLLOWED]
    ends = [_descend(badness, start, bounds) for start in starts]
    return values_at(min(ends, key=lambda end: end.fun).x)


def _descend(badness: Callable[[np.ndarray], float], start: np.ndarray, bounds: Any) -> Any:
    """The local minimum near a start, without gradients: there are only few parameters."""
    tolerance = {'xatol': 1e-4, 'fatol': 1e-6, 'maxiter': 1000, 'adaptive': False}
    return minimize(badness, start, method='Nelder-Mead', bounds=bounds, options=tolerance)


def _grid(names: list[str]) -> list[tuple[float, ...]]:
    return list(product(*(_STARTS[name] for name in names)))


def _scaled(name: str, value: float) -> float:
    """A parameter on an unbounded scale: its logarithm, or the log odds of a probability."""
    return math.log(value / (1 - value)) if name == 'lapse' else math.log(value)


def _unscaled(name: str, place: float) -> float:
    return 1 / (1 + math.exp(-place)) if name == 'lapse' else math.exp(place)
