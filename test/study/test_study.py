"""The file of a study, its texts, and the steps that follow from it."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import pytest
from source_imports import ROOT

from blocks_planning.errors import ConfigurationError
from blocks_planning.search.result import Problem
from blocks_planning.search.solve import solve
from blocks_planning.study.modes import BUILDING
from blocks_planning.study.orders import ORDERS, latin_square
from blocks_planning.study.plan import StepKind, steps_of
from blocks_planning.study.spec import Study, read_study
from blocks_planning.study.texts import Span, parse_text

from .conftest import STUDY, TOWERS

EXAMPLE = ROOT / 'config' / 'studies' / 'example.yaml'


def towers_of(study: Study, number: int) -> list[str]:
    return [
        f'{step.trial.condition.name} {step.trial.spec.stimulus.rpartition("/")[2]}'
        for step in steps_of(study, 'P01', number)
        if step.trial and not step.trial.is_practice
    ]


@pytest.mark.parametrize(
    ('old', 'new', 'reason'),
    [
        (
            'title: Small',
            'titel: Small',
            "line 1, key 'titel'",
        ),
        ('title: Small', '', "key 'title'"),
        ('order: fixed', 'order: any', 'expected one of fixed, shuffled, latin square'),
        ('mode: building', 'mode: both', 'expected one of scoping, building'),
        ('name: hands', 'name: parts', 'names must differ, got parts, parts'),
        ('name: hands', 'name: my hands', 'expected up to 32 letters, digits, _ and -'),
        ('time_limit_s: 60', 'time_limit_s: 0', 'time_limit_s must be a whole number from 1'),
        ('/arch', '/bridge', "has no tower 'bridge'"),
        ('break_every: 3', 'break_every: often', 'break_every must be a whole number'),
        ('consent: May we?', 'consent: [x]', 'text, got'),
        ('order: fixed', 'order: fixed\nsearch: {name: dfs}', 'search must be one of'),
        ('order: fixed', 'order: fixed\nconditions_per_person: 2', 'text, got 2'),
    ],
)
def test_what_is_wrong_is_told_with_its_place(
    tmp_path: Path, old: str, new: str, reason: str
) -> None:
    towers, path = tmp_path / 'towers.txt', tmp_path / 'study.yaml'
    towers.write_text(TOWERS)
    text = STUDY.format(towers=towers)
    assert old in text
    path.write_text(text.replace(old, new, 1))
    with pytest.raises(ConfigurationError, match=r'study\.yaml') as told:
        read_study(path)
    assert reason in str(told.value)


def test_the_name_of_a_study_is_made_of_all_of_it(study: Study) -> None:
    other = study.towers[0]._replace(task=study.towers[1].task)
    changed = [
        replace(study, seed=1),
        replace(study, consent='x'),
        replace(study, towers=(other, *study.towers[1:])),
        replace(study, conditions=study.conditions[:1]),
        replace(study, effort=study.effort._replace(budget=1)),
    ]
    assert len({one.study_id for one in (study, *changed)}) == 6


def test_steps_of_the_small_study(study: Study) -> None:
    steps = steps_of(study, 'P01', 0)
    assert Counter(step.kind for step in steps)[StepKind.TRIAL] == 5
    assert towers_of(study, 0) == ['parts arch', 'parts square', 'hands arch', 'hands square']
    strategies = {step.trial.spec.strategy.hides_costs for step in steps if step.trial}
    assert strategies == {True}
    again = [step.trial.spec.seed for step in steps if step.trial]
    assert again == [0, 0, 1, 0, 0]  # the square is practised and built with the same mode


@pytest.mark.parametrize('order', ORDERS)
@pytest.mark.parametrize('spread', ['all', 'one'])
def test_everybody_gets_every_tower_once_in_each_condition(
    study: Study, order: str, spread: str
) -> None:
    study = replace(study, order=order, conditions_per_person=spread)
    met = [towers_of(study, number) for number in range(4)]
    conditions = 2 if spread == 'all' else 1
    for towers in met:
        assert len(set(towers)) == len(towers) == 2 * conditions
    if spread == 'one':
        assert Counter(towers[0].partition(' ')[0] for towers in met) == {'parts': 2, 'hands': 2}
    if order == 'latin square':
        assert Counter(towers[0] for towers in met) == Counter(
            f'{condition} {tower}'
            for condition in ('parts', 'hands')
            for tower in ('arch', 'square')
        )


@pytest.mark.parametrize('count', [1, 2, 3, 4, 7, 8])
def test_a_latin_square_is_balanced(count: int) -> None:
    rows = [latin_square(count, row, '') for row in range(count)]
    for lines in (rows, zip(*rows, strict=True)):
        assert all(sorted(line) == list(range(count)) for line in lines)
    if count % 2 == 0:
        followers = Counter(pair for row in rows for pair in pairwise(row))
        assert set(followers.values()) == {1}
        assert len(followers) == count * (count - 1)


def test_shuffles_differ_between_participants_and_seeds(study: Study) -> None:
    study = replace(study, order='shuffled', towers=study.towers * 4)
    orders = [
        tuple(towers_of(replace(study, seed=seed), number))
        for seed in (0, 1)
        for number in (0, 1, 2)
    ]
    assert len(set(orders)) == 6
    assert towers_of(study, 1) == towers_of(study, 1)


def test_the_search_of_a_builder_finds_just_the_block_that_was_placed() -> None:
    from blocks_planning.board import rules

    study = read_study(EXAMPLE)
    search, budget = BUILDING.effort(study.effort)
    for tower in study.towers:
        task, built = tower.task, 0
        while placements := list(rules.legal_placements(task, built, task.silhouette)):
            for placed in placements:
                target = built | rules.cells_of(task.board, placed)
                found = solve(Problem(task, built, target), search, study.seed, budget)
                assert found.placements == (placed,)
            built |= rules.cells_of(task.board, placements[len(placements) // 2])


def test_texts_are_read_into_data() -> None:
    blocks = parse_text('# Hello *you*\nfirst\nline **bold**\n\n- one\n  more\n- two\n1. three')
    assert [(block.tag, len(block.lines)) for block in blocks] == [
        *(('h2', 1), ('p', 1), ('ul', 2), ('ol', 1)),
    ]
    assert blocks[0].lines[0] == (Span('', 'Hello '), Span('em', 'you'))
    assert blocks[1].lines[0][-2:] == (Span('', 'line '), Span('strong', 'bold'))
    assert ''.join(span.text for span in blocks[2].lines[0]) == 'one more'


@pytest.mark.parametrize(
    'text', ['<script>x</script>', '[x](javascript:x)', '2 * 3 * 4', 'a ** b', '![](x)', '&lt;']
)
def test_everything_else_stays_as_it_stands(text: str) -> None:
    assert parse_text(text) == parse_text(f'\n{text}\n')
    (block,) = parse_text(text)
    assert block.lines == ((Span('', text),),)


@pytest.mark.parametrize('path', sorted(EXAMPLE.parent.glob('*.yaml')), ids=lambda path: path.name)
def test_shipped_studies_can_be_read(path: Path) -> None:
    study = read_study(path)
    assert steps_of(study, 'P01', 3)[-1].kind is StepKind.DEBRIEF
