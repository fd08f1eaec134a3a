"""Likelihoods of choices, held to a readable twin."""

from __future__ import annotations

import math

import numpy as np
import pytest
from made_up_options import MadeUp, points
from oracles.likelihood import probability

from blocks_planning.errors import ConfigurationError
from blocks_planning.fitting.choiceset import NONE, ChoiceSet, choice_set
from blocks_planning.fitting.models import Model, log_likelihoods, parse_model
from blocks_planning.fitting.options import drawable
from blocks_planning.fitting.points import ChoicePoint

VALUES = {'lambda': 0.002, 'temperature': 3.0, 'lapse': 0.07}
WEIGHTS = {
    'rows': (1 / 3, -0.002 / 3),
    'rows-no-cost': (1 / 3, 0.0),
    'rows-no-progress': (0.0, -1 / 3000),
}


def chosen_points(maker: MadeUp) -> list[ChoicePoint]:
    """Choices of every kind: an option, one that cannot be built, and something else."""
    found = []
    for number, point in enumerate(points('a')):
        options = maker.options(point.task, point.built, point.asking)
        cells = options[number % len(options)].cells if number % 5 else 1
        found.append(point._replace(cells=cells))
    return found


@pytest.fixture(params=[1, 3], ids=['one ahead', 'further ahead'])
def maker(request: pytest.FixtureRequest) -> MadeUp:
    return MadeUp(ahead=request.param)


@pytest.mark.parametrize('name', WEIGHTS)
def test_log_likelihoods_are_those_of_the_twin(maker: MadeUp, name: str) -> None:
    chosen = chosen_points(maker)
    choices = choice_set(chosen, maker)
    expected = []
    for point in chosen:
        options = maker.options(point.task, point.built, point.asking)
        at = next((n for n, one in enumerate(options) if one.cells == point.cells), None)
        of = [[(float(s.cells), float(s.cost)) for s in one.sequences] for one in options]
        there = drawable(point.task, point.built)
        expected.append(math.log(probability(of, at, there, VALUES['lapse'], *WEIGHTS[name])))
    found = log_likelihoods(choices, parse_model(name), VALUES)
    np.testing.assert_allclose(found, expected, rtol=1e-9)
    # Each kind of choice was among them.
    assert choices.foreign > 5
    assert choices.unbuildable > 0
    assert (choices.chosen == NONE).sum() == choices.foreign + choices.unbuildable


def test_random_model_draws_anything() -> None:
    choices = choice_set(chosen_points(MadeUp()), MadeUp())
    found = log_likelihoods(choices, Model(''), {})
    np.testing.assert_allclose(np.exp(found), 1 / choices.drawable)


def test_choice_without_any_buildable_option_is_anything_that_can_be_drawn() -> None:
    class Nothing(MadeUp):
        def _sequences(self, source: object) -> tuple[()]:
            return ()

    choices = choice_set(points('a', towers=2), Nothing())
    found = log_likelihoods(choices, parse_model('rows'), VALUES)
    np.testing.assert_allclose(np.exp(found), 1 / choices.drawable)


def test_huge_values_do_not_overflow() -> None:
    choices = choice_set(chosen_points(MadeUp()), MadeUp())
    values = {'lambda': 1.0, 'temperature': 0.01, 'lapse': 0.01}
    assert np.isfinite(log_likelihoods(choices, parse_model('rows'), values)).all()


@pytest.mark.parametrize('keep', [[0], [5, 3, 40], [], list(range(64))], ids=str)
def test_part_of_the_choices_has_their_likelihoods(maker: MadeUp, keep: list[int]) -> None:
    choices = choice_set(chosen_points(maker), maker)
    part: ChoiceSet = choices.where(np.array(keep, np.int64))
    model = parse_model('rows')
    if keep:
        np.testing.assert_allclose(
            log_likelihoods(part, model, VALUES), log_likelihoods(choices, model, VALUES)[keep]
        )
    assert list(part.tower) == [choices.tower[place] for place in keep]
    assert len(part) == len(keep)


def test_drawable_regions_are_what_rectangles_cut_out_and_one_more() -> None:
    task = points('a')[0].task
    # 36 * 36 rectangles of the full board, all different.
    assert drawable(task, 0) == 36 * 36 + 1
    assert drawable(task, task.silhouette ^ 1) == 2


@pytest.mark.parametrize(
    'name',
    ['rows', 'rectangles-2', 'rows-3-no-cost', 'rectangles-no-progress', 'random'],
)
def test_model_is_read_from_its_name(name: str) -> None:
    assert parse_model(name).name == name


@pytest.mark.parametrize(
    'text',
    ['', 'columns', 'rows-4', 'rows-1', 'rows-no-progress-no-cost', 'rows-', 'Random', 'rows-2-x'],
)
def test_other_names_are_refused(text: str) -> None:
    with pytest.raises(ConfigurationError, match='model must'):
        parse_model(text)


def test_free_parameters_are_those_that_matter() -> None:
    assert parse_model('rows').parameters == ('lambda', 'temperature', 'lapse')
    assert parse_model('rows-no-cost').parameters == ('temperature', 'lapse')
    assert parse_model('rows-no-progress').parameters == ('temperature', 'lapse')
    assert parse_model('random').parameters == ()
