"""From records to choices and their options."""

from __future__ import annotations

import csv
import dataclasses
from itertools import pairwise
from pathlib import Path

import builders
import numpy as np
import pytest

from blocks_planning.board.geometry import Mask, area
from blocks_planning.errors import BlocksPlanningError
from blocks_planning.fitting.choiceset import choice_set
from blocks_planning.fitting.models import parse_model
from blocks_planning.fitting.options import Ahead, Solves
from blocks_planning.fitting.points import Asking, points_of
from blocks_planning.fitting.simulation import Chooser, roll_out
from blocks_planning.people.families import family_names, find_family
from blocks_planning.search.result import Problem
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.search.solve import solve
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal, ProposalKind

ASKING = Asking(BreadthFirst(2), 3, 500)


def test_choices_of_a_planner_are_its_first_subgoals() -> None:
    record = builders.record(builders.CHAIR, strategy='scoping', lam=0.01, seed=4)
    points = points_of([record])
    assert [point.built for point in points] == [one.decision.built for one in record.decisions]
    assert {point.session for point in points} == {'seed 4'}
    for point, entry in zip(points, record.decisions, strict=True):
        assert point.built | point.cells == entry.decision.subgoals[0].target
        assert not point.built & point.cells
        assert point.asking == Asking(record.spec.search, 4, record.spec.budget)


def test_choices_of_a_person_are_the_regions_to_be_built() -> None:
    planned = builders.record(builders.CHAIR, strategy='scoping', lam=0.01)
    task = planned.spec.task
    first, *_ = planned.decisions
    drawn = first.decision.subgoals[0].target
    kinds = [
        (ProposalKind.WITHDRAWN, drawn),
        (ProposalKind.BUILD, 1),  # could not be built
        (ProposalKind.BUILD, drawn | ~task.silhouette & task.board.full),
    ]
    record = dataclasses.replace(
        planned,
        spec=dataclasses.replace(planned.spec, strategy=Human('P07')),
        decisions=(first,),
        proposals=tuple(
            Proposal(0, number, kind, region, 1.0) for number, (kind, region) in enumerate(kinds)
        ),
    )
    assert [(point.session, point.cells) for point in points_of([record])] == [
        ('P07', 1),
        ('P07', drawn),
    ]


@pytest.mark.parametrize('family', family_names())
def test_options_are_the_regions_with_what_their_solves_gave(family: str) -> None:
    task = builders.task(builders.FRAME)
    options = Ahead(family, Solves()).options(task, 0, ASKING)
    assert [option.cells for option in options] == find_family(family)(task, 0)
    for option in options:
        result = solve(Problem(task, 0, option.cells), *ASKING)
        assert bool(option.sequences) == result.solved
        if result.solved:
            assert option.sequences == ((area(option.cells), result.planning_cost),)
            assert option.placements == result.placements


@pytest.mark.parametrize('family', family_names())
@pytest.mark.parametrize('horizon', [1, 2, 3])
@pytest.mark.parametrize('lam', [0.0, 0.003, 0.1])
def test_best_sequence_of_an_option_is_that_of_a_planner(
    family: str, horizon: int, lam: float
) -> None:
    record = builders.record(
        builders.CHAIR, lam=lam, regions=family, horizon=horizon, depth=2, seed=3, budget=500
    )
    maker = Ahead(family, Solves(), horizon)
    for decision in (entry.decision for entry in record.decisions):
        best: dict[Mask, float] = {}
        for candidate in decision.candidates:
            if candidate.value is not None:
                cells = candidate.regions[0].cells & ~decision.built
                best[cells] = max(candidate.value, best.get(cells, candidate.value))
        options = maker.options(record.spec.task, decision.built, ASKING)
        found = {
            option.cells: max(one.cells - lam * one.cost for one in option.sequences)
            for option in options
            if option.sequences
        }
        assert found == pytest.approx(best)


def test_quick_try_gives_the_answer_of_the_whole_budget() -> None:
    task = builders.task('####/####/####/####/#..#/#..#')
    asking = Asking(BreadthFirst(1), 1, 50_000)
    for cells in find_family('rectangles')(task, 0):
        result = solve(Problem(task, 0, cells), *asking)
        found = Solves().solved(task, 0, cells, asking)
        assert found == (result if result.solved else None)


def test_solves_are_shared() -> None:
    solves = Solves()
    task = builders.task(builders.SQUARE)
    Ahead('rectangles', solves).options(task, 0, ASKING)
    known = len(solves)
    Ahead('rectangles', solves).options(task, 0, ASKING)
    assert len(solves) == known > 0


def test_simulated_participant_builds_what_can_be_built() -> None:
    towers = {'chair': builders.task(builders.CHAIR), 'never': builders.task('#../#../#.#')}
    values = {'lambda': 0.001, 'temperature': 0.5, 'lapse': 0.1}
    maker = Ahead('rows', Solves())
    chooser = Chooser(parse_model('rows'), values, maker, np.random.default_rng(1))
    points = roll_out('s', towers, ASKING, chooser)
    # Nothing can be built of the second tower, so that its trial ends at once.
    assert [point.tower for point in points].count('never') == 1
    chair = [point for point in points if point.tower == 'chair']
    assert chair[0].built == 0
    for before, after in pairwise(chair):
        assert after.built in (before.built, before.built | before.cells)
    assert len(choice_set(points, maker)) == len(points)


def run_fit(*words: str) -> None:
    from blocks_planning.cli import commands

    commands.main(['fit', *words], standalone_mode=False)


def test_command_writes_tables_and_a_figure(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / 'records.jsonl'
    records = [
        builders.record(rows, strategy='scoping', lam=0.01, depth=2, seed=seed, stimulus=rows[:4])
        for rows in (builders.CHAIR, builders.SQUARE, builders.ARCH)
        for seed in (0, 1)
    ]
    path.write_text(''.join(record.to_line() + '\n' for record in records))
    out = tmp_path / 'out'
    run_fit(str(path), '--out', str(out), '--model', 'rows', '--model', 'random')
    said = capsys.readouterr().out
    assert 'seed 0: ' in said
    assert 'all: ' in said
    tables = {
        name: list(csv.DictReader((out / f'{name}.csv').read_text().splitlines()))
        for name in ('fits', 'parameters', 'choices')
    }
    assert {row['model'] for row in tables['fits']} == {'rows', 'random'}
    assert {row['session'] for row in tables['fits']} == {'seed 0', 'seed 1', 'all'}
    assert len(tables['choices']) == len(points_of(records))
    assert len(tables['parameters']) == 9
    assert (out / 'figures' / 'fit.svg').stat().st_size > 2_000


@pytest.mark.parametrize(
    ('text', 'said'),
    [('', 'is empty'), ('{"format": 1}\n', 'line 1'), (None, 'no region was chosen')],
)
def test_bad_records_are_named(tmp_path: Path, text: str | None, said: str) -> None:
    path = tmp_path / 'records.jsonl'
    if text is None:
        text = builders.record(builders.NOTHING_FITS, strategy='scoping', lam=0.01).to_line()
    path.write_text(text)
    with pytest.raises(BlocksPlanningError, match=said):
        run_fit(str(path), '--out', str(tmp_path / 'out'), '--model', 'rows')
    assert not (tmp_path / 'out').exists()
