"""Models of a choice, and the likelihood of choices under them.

A choice is an option with probability proportional to exp(V / temperature), where V is the best
r - lambda * c of the sequences that begin with it; or, with probability ``lapse``, and always if
there is no option, any region that can be drawn. The lapse covers the same regions in every model, so that models with different
region families give probabilities to the same choices and can be compared.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from blocks_planning.errors import ConfigurationError, shown
from blocks_planning.fitting.choiceset import NONE, ChoiceSet
from blocks_planning.people.families import family_names

RANDOM = 'random'
BOUNDS = {'lambda': (1e-7, 1.0), 'temperature': (1e-2, 1e3), 'lapse': (1e-6, 1 - 1e-6)}
"""Search range of each parameter: lambda [cells / state], temperature [cells; without
progress: thousand states], lapse [probability]."""
_STATES = 1000.0
HORIZONS = (1, 2, 3)


@dataclass(frozen=True)
class Model:
    """A model of choice.

    Attributes:
        regions: name of the region family; '' for a uniform choice among all regions that can be
            drawn.
        horizon: number of subgoals to look ahead, 1 to 3.
        cost: whether solving costs count.
        progress: whether the cells filled count.

    Raises:
        ConfigurationError: if neither cost nor progress counts, or the horizon is out of range.
    """

    regions: str
    horizon: int = 1
    cost: bool = True
    progress: bool = True

    def __post_init__(self) -> None:
        if self.horizon not in HORIZONS:
            raise ConfigurationError(f'horizon must be 1, 2 or 3, got {self.horizon!r}')
        if self.regions and not (self.cost or self.progress):
            raise ConfigurationError('a model must weigh progress, cost or both')

    @property
    def name(self) -> str:
        """The name, such as 'rows', 'rectangles-2', 'rows-no-cost' or 'random'."""
        if not self.regions:
            return RANDOM
        ahead = '' if self.horizon == 1 else f'-{self.horizon}'
        without = '' if self.cost else '-no-cost'
        without += '' if self.progress else '-no-progress'
        return self.regions + ahead + without

    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the free parameters."""
        if not self.regions:
            return ()
        weighed = ('lambda',) if self.cost and self.progress else ()
        return (*weighed, 'temperature', 'lapse')

    def weights(self, values: Mapping[str, float]) -> tuple[float, float]:
        """The contributions of a cell and of a state to V / temperature."""
        temperature = values['temperature']
        if not self.progress:
            return 0.0, -1 / (_STATES * temperature)
        return 1 / temperature, -values['lambda'] / temperature if self.cost else 0.0


def parse_model(text: str) -> Model:
    """The model of a name; see :attr:`Model.name`.

    >>> parse_model('rectangles-2-no-cost')
    Model(regions='rectangles', horizon=2, cost=False, progress=True)

    Raises:
        ConfigurationError: if there is no such model.
    """
    if text == RANDOM:
        return Model('')
    rest = text
    cost = not rest.endswith('-no-cost')
    rest = rest.removesuffix('-no-cost')
    progress = not rest.endswith('-no-progress')
    rest = rest.removesuffix('-no-progress')
    regions, _, ahead = rest.partition('-')
    if regions in family_names() and ahead in ('', '2', '3'):
        found = Model(regions, int(ahead or 1), cost, progress)
        if found.name == text:
            return found
    raise ConfigurationError(
        f'model must be {RANDOM}, or a region family ({", ".join(family_names())}), then -2 or -3 for '
        f'the horizon, then -no-cost or -no-progress, got {shown(text)}'
    )


def log_likelihoods(choices: ChoiceSet, model: Model, values: Mapping[str, float]) -> np.ndarray:
    """The log probability of each choice under a model: float64 (choices,) [nats].

    Args:
        choices: with the options of the model's family and horizon.
        model: the model.
        values: of its parameters.
    """
    if not model.regions:
        by_chance: np.ndarray = -np.log(choices.drawable)
        return by_chance
    lapse = np.where(choices.has_options(), values['lapse'], 1.0)
    by_lapse = lapse / choices.drawable
    is_option = choices.chosen != NONE
    by_value = np.zeros(len(choices))
    log_p = option_log_probabilities(choices, model, values)
    by_value[is_option] = np.exp(log_p[choices.chosen[is_option]])
    found: np.ndarray = np.log((1 - lapse) * by_value + by_lapse)
    return found


def option_log_probabilities(
    choices: ChoiceSet, model: Model, values: Mapping[str, float]
) -> np.ndarray:
    """The log probability of every option if there is no lapse: float64 (options,) [nats]."""
    per_cell, per_state = model.weights(values)
    by_sequence = per_cell * choices.cells + per_state * choices.cost
    utility = np.maximum.reduceat(by_sequence, choices.option_starts)
    sizes = np.diff(np.append(choices.choice_starts, len(utility)))
    utility -= np.repeat(np.maximum.reduceat(utility, choices.choice_starts), sizes)
    total = np.add.reduceat(np.exp(utility), choices.choice_starts)
    found: np.ndarray = utility - np.repeat(np.log(total), sizes)
    return found
