"""Simulated participants: choices drawn from a model, in given states or tower by tower."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.fitting.choiceset import ChoiceSet, choice_set
from blocks_planning.fitting.models import Model, option_log_probabilities
from blocks_planning.fitting.options import Option, OptionMaker, drawn_by_rectangle
from blocks_planning.fitting.points import Asking, ChoicePoint

MOST_CHOICES = 20
"""Most choices in a simulated trial; regions that cannot be built do not change the state."""


class Chooser:
    """A simulated participant: a model with known parameters."""

    def __init__(
        self,
        model: Model,
        values: Mapping[str, float],
        maker: OptionMaker,
        rng: np.random.Generator,
    ) -> None:
        """Choose according to a model.

        Args:
            model: the model.
            values: of its parameters.
            maker: of the options that the model looks at.
            rng: generator of all draws.
        """
        self._model = model
        self._values = values
        self._maker = maker
        self._rng = rng
        self._chances: dict[tuple[Task, Mask, Asking], tuple[list[Option], np.ndarray]] = {}

    def choose(self, point: ChoicePoint) -> tuple[Mask, Option | None]:
        """Cells of a region for the state of a point, and the option if it can be built.

        A lapse is any region that a rectangle can draw.
        """
        options, chances = self._options(point)
        lapse = self._values['lapse'] if self._model.regions else 1.0
        if not options or self._rng.random() < lapse:
            drawn = drawn_by_rectangle(point.task.board, point.task.silhouette & ~point.built)
            cells = drawn[self._rng.integers(len(drawn))]
            return cells, next((one for one in options if one.cells == cells), None)
        place = np.searchsorted(np.cumsum(chances), self._rng.random(), side='right')
        option = options[min(int(place), len(options) - 1)]
        return option.cells, option

    def can_go_on(self, point: ChoicePoint) -> bool:
        """Whether any option of the state of a point can be built."""
        return bool(self._options(point)[0])

    def _options(self, point: ChoicePoint) -> tuple[list[Option], np.ndarray]:
        """The options with a value, and their probabilities without a lapse."""
        key = point.task, point.built, point.asking
        if key not in self._chances:
            made = self._maker.options(*key)
            options = [option for option in made if option.sequences]
            alone = choice_set([point], self._maker)
            self._chances[key] = options, self._likely(alone)
        return self._chances[key]

    def _likely(self, alone: ChoiceSet) -> np.ndarray:
        if not self._model.regions:
            return np.ones(len(alone.option_starts))
        chances: np.ndarray = np.exp(option_log_probabilities(alone, self._model, self._values))
        return chances


def choose_again(points: Sequence[ChoicePoint], chooser: Chooser) -> list[ChoicePoint]:
    """New choices in the same states."""
    return [point._replace(cells=chooser.choose(point)[0]) for point in points]


def roll_out(
    session: str, towers: Mapping[str, Task], asking: Asking, chooser: Chooser
) -> list[ChoicePoint]:
    """The choices of a simulated participant who rebuilds some towers, by name.

    A chosen region that can be built is built according to its plan. A trial ends when the
    silhouette is complete, no option can be built, or ``MOST_CHOICES`` were made.
    """
    points = []
    for tower, task in towers.items():
        built = 0
        for _ in range(MOST_CHOICES):
            if built == task.silhouette:
                break
            point = ChoicePoint(session, tower, task, built, 0, asking)
            cells, option = chooser.choose(point)
            points.append(point._replace(cells=cells))
            if not chooser.can_go_on(point):
                break
            built |= option.cells if option else 0
    return points
