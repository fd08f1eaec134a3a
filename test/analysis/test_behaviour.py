"""People beside planners: shares with intervals, and the section that shows them."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import builders
import numpy as np
import pytest
from jinja2 import Environment, PackageLoader, StrictUndefined

from blocks_planning.analysis.behaviour import section
from blocks_planning.analysis.behaviour.building import compare_building
from blocks_planning.analysis.behaviour.difficulty import (
    among_people,
    compare_difficulty,
    rank_correlation,
)
from blocks_planning.analysis.behaviour.marking import compare_parts
from blocks_planning.analysis.behaviour.planners import builds_of_records, builds_of_sweep
from blocks_planning.analysis.behaviour.shares import Tally, estimate_gain, estimate_share
from blocks_planning.analysis.style import save_figure
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.experiments.spec import Experiment, SweepSpec
from blocks_planning.experiments.sweeping import run_sweep
from blocks_planning.people.data import Build, read_builds, read_markings
from blocks_planning.people.orders import Count
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.none import NoSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.script import Tower


def rng() -> np.random.Generator:
    return np.random.default_rng(3)


def test_share_is_over_all_builds_and_its_interval_over_builders() -> None:
    counts = [('a', Count(9, 10)), ('a', Count(1, 10)), ('b', Count(0, 20)), ('c', Count(20, 20))]
    found = estimate_share(Tally(counts), rng())
    assert found.mean == pytest.approx(30 / 60)
    # Three builders: all draws of b alone, or of c alone, are rarer than 1 in 20 together ...
    assert 0 <= found.low < 1 / 4
    assert 3 / 4 < found.high <= 1


def test_share_of_builders_that_are_alike_is_certain() -> None:
    found = estimate_share(Tally([(name, Count(3, 4)) for name in 'abcdef']), rng())
    assert found[:3] == (0.75, 0.75, 0.75)


def test_share_of_nothing_is_unknown() -> None:
    assert np.isnan(estimate_share(Tally([('a', Count(0, 0))]), rng())).all()
    assert np.isnan(estimate_share(Tally([]), rng())).all()


def test_gain_is_measured_on_what_chance_leaves() -> None:
    own = Tally([('a', Count(9, 10)), ('b', Count(9, 10))])
    chance = Tally([('a', Count(6, 10)), ('b', Count(6, 10))])
    assert estimate_gain(own, chance, rng())[:3] == pytest.approx((0.75, 0.75, 0.75))
    with pytest.raises(ValueError, match='the same builders'):
        estimate_gain(own, Tally([('a', Count(6, 10))]), rng())


def test_rank_correlation_is_over_towers_and_its_interval_over_builders() -> None:
    builds = np.ones((40, 4))
    hits = np.array([[1, 1, 1, 0]] * 10 + [[1, 1, 0, 0]] * 10 + [[1, 0, 0, 0]] * 20)
    found = rank_correlation(hits, builds, np.array([0.9, 0.7, 0.5, 0.1]), rng())
    assert found.mean == pytest.approx(1)
    assert found.high == pytest.approx(1)
    back = rank_correlation(hits, builds, np.array([0.1, 0.5, 0.7, 0.9]), rng())
    assert back.mean == pytest.approx(-1)
    # A tower without a value is left out; with fewer than three there is nothing to say.
    some = rank_correlation(hits, builds, np.array([0.1, np.nan, 0.7, 0.9]), rng())
    assert some.mean == pytest.approx(-1)
    assert np.isnan(rank_correlation(hits, builds, np.array([1, np.nan, np.nan, 0]), rng()).mean)
    assert np.isnan(rank_correlation(hits, builds, np.ones(4), rng()).mean)


def test_halves_of_people_that_are_alike_agree() -> None:
    hits = np.array([[3.0, 2, 1, 0]] * 20)
    assert among_people(hits, np.full_like(hits, 4), rng()).mean == pytest.approx(1)


@pytest.fixture(scope='module')
def sweep(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two planners on three of the towers that people built."""
    towers = [
        Tower(one.name, Task(one.board, one.silhouette))
        for name in ('5', '12', '4')
        for one in find_stimuli(f'cogsci2021/{name}')
    ]
    strategies = (NoSubgoals(), Scoping(0.001), Scoping(0.004))
    experiment = Experiment('small', (BreadthFirst(2),), strategies, 2_000)
    folder = tmp_path_factory.mktemp('behaviour') / 'sweep'
    run_sweep(SweepSpec('test', tuple(towers), (1, 2, 3), (experiment,)), folder)
    return folder


def test_builds_of_a_sweep_are_those_of_its_planners(sweep: Path) -> None:
    found = builds_of_sweep(sweep, ['5', '12'])
    assert set(found) == {'bfs none', 'bfs scoping'}
    for builds in found.values():
        # Of two values of lambda one is taken, of three towers two.
        assert sorted((build.tower, build.builder) for build in builds) == [
            (tower, seed) for tower in ('12', '5') for seed in ('1', '2', '3')
        ]
    [stimulus] = find_stimuli('cogsci2021/5')
    rows = '/'.join(stimulus.board.draw(stimulus.silhouette).split('\n'))
    record = builders.record(
        rows, strategy='scoping', lam=0.004, depth=2, seed=2, budget=2_000, stimulus=stimulus.name
    )
    own = builds_of_records([record])
    assert own == [one for one in found['bfs scoping'] if one[:2] == ('2', '5')]
    assert own[0].placements == record.placements


def test_planners_that_look_ahead_differently_have_names_of_their_own(tmp_path: Path) -> None:
    [tower] = find_stimuli('cogsci2021/12')
    strategies = (NoSubgoals(), Scoping(0.004), Scoping(0.004, horizon=2))
    experiment = Experiment('small', (BreadthFirst(1),), strategies, 200)
    towers = (Tower(tower.name, Task(tower.board, tower.silhouette)),)
    run_sweep(SweepSpec('test', towers, (1,), (experiment,)), tmp_path / 'sweep')
    found = builds_of_sweep(tmp_path / 'sweep', ['12'])
    assert set(found) == {'bfs none', 'bfs scoping 1', 'bfs scoping 2'}


@pytest.fixture(scope='module')
def found(sweep: Path) -> dict[str, Any]:
    """The numbers of the section from a few people and a small sweep."""
    people = [build for build in read_builds() if int(build.builder) <= 12]
    planners = builds_of_sweep(sweep, {build.tower for build in people})
    return {
        'building': compare_building({'people': people, **planners}),
        'parts': compare_parts(read_markings()[:64]),
        'difficulty': compare_difficulty(people, planners),
    }


def test_numbers_are_the_same_every_time(sweep: Path, found: dict[str, Any]) -> None:
    people = [build for build in read_builds() if int(build.builder) <= 12]
    assert compare_building({'people': people}) == found['building'][:1]
    assert compare_parts(read_markings()[:64]) == found['parts']


def test_planner_that_looks_at_rows_is_described_by_rows(found: dict[str, Any]) -> None:
    rows = {row['who']: row['families']['rows'] for row in found['building']}
    assert rows['bfs scoping']['gain']['mean'] > 0.8
    assert rows['people']['gain']['mean'] < rows['bfs scoping']['gain']['mean']


def test_section_shows_every_builder_and_number(found: dict[str, Any], tmp_path: Path) -> None:
    figures = section.behaviour_figures(found)
    for name, figure in figures.items():
        assert save_figure(figure, tmp_path, name).stat().st_size > 2_000
    environment = Environment(
        loader=PackageLoader('blocks_planning.analysis', 'templates'),
        undefined=StrictUndefined,
        autoescape=True,
    )
    html = environment.get_template(section.TEMPLATE).render(
        behaviour=section.section_content(found), figures=dict.fromkeys(figures, 'x')
    )
    for word in ('people', 'BFS, none', 'BFS, scoping', 'rows', 'rectangles'):
        assert f'<td>{word}</td>' in html or f'{word}</th>' in html
    share = found['parts']['families']['rectangles']['all']['mean']
    assert f'{100 * share:.1f}' in html
    assert not re.search(r'\bnan\b|None', html)


def test_group_without_a_complete_build_has_no_description() -> None:
    [row] = compare_building({'people': [Build('1', '4', ())]})
    assert row['complete'] == 0
    assert row['families']['rows']['gain']['mean'] is None
