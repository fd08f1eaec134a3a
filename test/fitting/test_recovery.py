"""Parameters and models are found again from simulated choices, within bounds."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
import pytest
from made_up_options import MadeUp, points

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.fitting import estimation
from blocks_planning.fitting.choiceset import ChoiceSet, choice_set
from blocks_planning.fitting.comparison import (
    POOLED,
    Makers,
    compare_models,
    cross_validate,
)
from blocks_planning.fitting.models import parse_model
from blocks_planning.fitting.points import Asking
from blocks_planning.fitting.recovery import (
    median_errors,
    recover_models,
    recover_parameters,
    win_rates,
)
from blocks_planning.fitting.simulation import Chooser, choose_again, roll_out
from blocks_planning.search.searches import BreadthFirst

ROWS = parse_model('rows')
TRUE = {'lambda': 0.002, 'temperature': 1.0, 'lapse': 0.05}


def makers() -> Makers:
    return Makers({('rows', 1): MadeUp(), ('rectangles', 1): MadeUp(salt=1)})


def simulated(sessions: int = 1, each: int = 4) -> ChoiceSet:
    """Choices of participants with the same known parameters."""
    states = [p for number in range(sessions) for p in points(f's{number}', each=each)]
    chooser = Chooser(ROWS, TRUE, MadeUp(), np.random.default_rng(5))
    return choice_set(choose_again(states, chooser), MadeUp())


def test_many_choices_give_the_parameters_away() -> None:
    found = estimation.fit(simulated(sessions=25), ROWS).values
    assert found['lambda'] == pytest.approx(TRUE['lambda'], rel=0.1)
    assert found['temperature'] == pytest.approx(TRUE['temperature'], rel=0.15)
    assert found['lapse'] == pytest.approx(TRUE['lapse'], abs=0.015)


def test_no_values_nearby_are_likelier() -> None:
    choices = simulated()
    found = estimation.fit(choices, ROWS)
    for name in ROWS.parameters:
        for factor in (0.97, 1.03):
            values = {**found.values, name: found.values[name] * factor}
            assert estimation.log_likelihood(choices, ROWS, values) <= found.log_likelihood + 1e-6


def test_criteria_punish_parameters() -> None:
    found = estimation.Fit(ROWS, {}, -100.0, 50)
    assert found.aic == 206
    assert found.bic == pytest.approx(200 + 3 * math.log(50))


def test_interval_ends_where_the_likelihood_has_fallen_enough() -> None:
    choices = simulated(sessions=2)
    found = estimation.fit(choices, ROWS)
    low, high = estimation.profile_interval(choices, found, 'lambda')
    assert low is not None
    assert high is not None
    assert low < TRUE['lambda'] < high
    for end in (low, high):
        # The best of a fine grid of the other two parameters, with this one fixed.
        grid = [
            {'lambda': end, 'temperature': t, 'lapse': e}
            for t in np.geomspace(0.4, 2.5, 40)
            for e in np.linspace(0.005, 0.2, 40)
        ]
        best = max(estimation.log_likelihood(choices, ROWS, values) for values in grid)
        assert found.log_likelihood - best == pytest.approx(1.92, abs=0.05)


def test_interval_is_open_where_the_choices_say_nothing() -> None:
    choices = simulated(each=1)
    # Nobody who chooses at random has a temperature that is too high.
    rng = np.random.default_rng(1)
    sizes = np.diff(np.append(choices.choice_starts, len(choices.option_starts)))
    by_chance = choices.with_chosen(choices.choice_starts + rng.integers(sizes))
    found = estimation.fit(by_chance, parse_model('rows-no-cost'))
    assert estimation.profile_interval(by_chance, found, 'temperature')[1] is None


def test_tower_is_scored_under_a_fit_to_the_others() -> None:
    choices = simulated()
    total = 0.0
    for tower in range(16):
        rest = choices.where(choices.tower != str(tower))
        values = estimation.fit(rest, ROWS).values
        left_out = choices.where(choices.tower == str(tower))
        total += estimation.log_likelihood(left_out, ROWS, values)
    assert cross_validate(choices, ROWS) == pytest.approx(total)
    assert cross_validate(choices.where(choices.tower == '3'), ROWS) is None


def test_comparison_has_every_session_and_all_together() -> None:
    states = [*points('a', towers=3), *points('b', towers=2)]
    chooser = Chooser(ROWS, TRUE, MadeUp(), np.random.default_rng(5))
    models = [ROWS, parse_model('random')]
    reported: list[tuple[int, int]] = []
    sets = makers().choice_sets(choose_again(states, chooser), models)
    fits, parameters = compare_models(sets, models, False, lambda *n: reported.append(n))
    assert [(row['session'], row['model'], row['choices']) for row in fits] == [
        ('a', 'rows', 12),
        ('a', 'random', 12),
        ('b', 'rows', 8),
        ('b', 'random', 8),
        (POOLED, 'rows', 20),
        (POOLED, 'random', 20),
    ]
    assert reported[-1] == (6, 6)
    assert [row['delta_bic'] == 0 for row in fits] == [True, False] * 3
    assert all(row['pseudo_r2'] == pytest.approx(0) for row in fits[1::2])
    assert len(parameters) == 9


def test_parameters_of_forty_sessions_of_sixteen_towers_are_recovered() -> None:
    towers = {one.name: Task(one.board, one.silhouette) for one in find_stimuli('cogsci2021')}
    asking = Asking(BreadthFirst(3), 0, 100_000)
    sessions = [partial(roll_out, str(number), towers, asking) for number in range(40)]
    rows = recover_parameters(sessions, ROWS, Makers(), seed=1)
    assert len(rows) == 120
    errors = median_errors(rows)
    assert errors['lambda'] < 0.06
    assert errors['temperature'] < 0.35


def test_true_model_wins() -> None:
    sessions = [partial(choose_again, points(f's{number}')) for number in range(5)]
    names = ('rows', 'rows-no-cost', 'rows-no-progress', 'rectangles', 'random')
    rows = recover_models(sessions, [parse_model(name) for name in names], makers(), seed=2)
    rates = win_rates(rows)
    assert {name: rates[name][name] >= 0.8 for name in names} == dict.fromkeys(names, True)
