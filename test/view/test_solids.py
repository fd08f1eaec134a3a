"""Solids of a scene on a board of 3 x 3 cells, worked out by hand."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import pytest
from builders import PLANNERS, TOWERS, as_ordered, planner_id, spec

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.search.result import SolveStatus
from blocks_planning.subgoals.decision import Candidate, Decision, Subgoal
from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.regions import Region, rows_label
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import palette
from blocks_planning.view.scene import Scene, scene_of, scenes_of
from blocks_planning.view.solids import INK, TEXT_INK, Box, Boxes, Lines, Solid, Words, solids_of

BOARD = Board(3, 3)
SPEC = spec('#../#.#/###', library='2x1,1x1,1x2', stimulus='corner')
GROUND_ROW = BOARD.rows_below(1)
PLACEMENTS = (Placed(2, 1, 0, 0), Placed(1, 1, 2, 0), Placed(1, 2, 0, 1), Placed(1, 1, 2, 1))


def decision(placed: int, height: int, cost: int) -> DecisionRecord:
    """To fill the target rows below a height with the next two of the placements."""
    region = BOARD.rows_below(height) & SPEC.task.silhouette
    rows = Region(rows_label(height), region)
    subgoal = Subgoal(rows, region, 2, PLACEMENTS[placed : placed + 2], cost, cost, 1)
    candidate = Candidate((rows,), 3, cost, 2.5, SolveStatus.SOLVED)
    built = GROUND_ROW if placed else 0
    return DecisionRecord(placed, Decision(built, (candidate,), 0, (subgoal,), 10 * cost, 1), 1)


SCENE = Scene(
    trial=scene_of(SPEC).trial,
    observations=as_ordered(*PLACEMENTS[:3]),
    chosen=SubgoalChosen(SPEC.trial_id, 2, (decision(0, 1, 7), decision(2, 3, 9))),
)
"""Two blocks of the first subgoal and one of the second stand; cell (2, 1) is still to fill."""


def layer(scene: Scene, name: str) -> list[Solid]:
    return [solid for solid in solids_of(scene) if solid.layer == name]


def words(scene: Scene) -> list[Words]:
    return [solid for solid in solids_of(scene) if isinstance(solid, Words)]


def test_blocks_stand_in_their_cells_in_the_colour_of_their_subgoal():
    first, second = palette.COLOURS[:2]
    assert layer(SCENE, 'blocks') == [
        Box('blocks', 1, first, centre=(1, 0.5, 0.5), size=(1.94, 0.94, 0.94)),
        Box('blocks', 2, palette.blend(first, 0.4), centre=(2.5, 0.5, 0.5), size=(0.94,) * 3),
        Box('blocks', 3, second, centre=(0.5, 0.5, 2), size=(0.94, 0.94, 1.94)),
    ]


def test_region_is_what_the_subgoal_has_still_to_fill():
    assert layer(SCENE, 'region') == [
        Boxes('region', 0, palette.COLOURS[1], ((2.5, 0.5, 1.5),), (0.94,) * 3, opacity=0.4)
    ]


def test_outline_is_the_border_of_the_silhouette_in_front_of_the_blocks():
    [lines] = layer(SCENE, 'silhouette')
    assert isinstance(lines, Lines)
    pairs = zip(lines.ends[::2], lines.ends[1::2], strict=True)
    assert {((x0, z0), (x1, z1)) for (x0, _, z0), (x1, _, z1) in pairs} == {
        ((0, 0), (0, 3)),
        ((1, 1), (1, 3)),
        ((2, 1), (2, 2)),
        ((3, 0), (3, 2)),
        ((0, 0), (3, 0)),
        ((1, 1), (2, 1)),
        ((2, 2), (3, 2)),
        ((0, 3), (1, 3)),
    }
    assert {y for _, y, _ in lines.ends} == {0}
    assert len(lines.ends) == 16


def test_ground_and_frame_are_those_of_the_board():
    assert layer(SCENE, 'ground') == [
        Box('ground', 0, INK, centre=(1.5, 0.5, -0.05), size=(3, 1, 0.1))
    ]
    [frame] = layer(SCENE, 'frame')
    assert isinstance(frame, Lines)
    corners = Counter(frame.ends)
    assert corners == dict.fromkeys([(x, 0.5, z) for x in (0, 3) for z in (0, 3)], 2)


def test_words_say_what_is_built_by_whom_and_what_it_cost():
    spacing = 1.8 * 0.25
    assert layer(SCENE, 'text') == [
        Words('text', number, TEXT_INK, (1.5, 0.5, pytest.approx(z)), height=0.25, text=text)  # type: ignore[arg-type]
        for number, (z, text) in enumerate(
            [
                (3.5 + 4.5 * spacing, 'corner: building'),
                (3.5 + 3.5 * spacing, 'scoping, lambda 0.002'),
                (3.5 + 2.5 * spacing, 'bfs, depth 3'),
                (3.5 + 1.5 * spacing, '3 blocks, 2 subgoals'),
                (3.5 + 0.5 * spacing, 'action planning 16, subgoal planning 160 [states]'),
            ]
        )
    ]


def test_words_are_as_wide_as_a_board_that_is_wide_enough():
    heights = {}
    for width in (3, 8, 16):
        [heights[width]] = {line.height for line in words(scene_of(spec('#' * width)))}
    assert heights[3] == heights[8] == 0.25
    assert 0.25 < heights[16] <= 0.5


def test_words_hold_no_sign_that_a_font_may_lack():
    texts = [line.text for line in words(scene_of(spec('#', stimulus='塔\n' * 99)))]
    assert len(texts) == 5
    assert all(text.isascii() and text.isprintable() for text in texts)
    assert len(texts[0]) <= 62


@pytest.mark.parametrize(
    ('status', 'colour'),
    [
        (TrialStatus.BUILDING, TEXT_INK),
        (TrialStatus.SUCCESS, palette.GOOD),
        (TrialStatus.STUCK, palette.BAD),
        (TrialStatus.GAVE_UP, palette.BAD),
        (TrialStatus.CANCELLED, palette.BAD),
    ],
)
def test_colour_of_the_words_tells_how_the_trial_ended(status: TrialStatus, colour: str):
    assert {line.colour for line in words(replace(SCENE, status=status))} == {colour}


@pytest.mark.parametrize(
    ('costs', 'status', 'told'),
    [
        ('shown', TrialStatus.BUILDING, True),
        ('hidden', TrialStatus.BUILDING, False),
        ('hidden', TrialStatus.SUCCESS, True),
    ],
)
def test_costs_are_hidden_from_a_person_who_must_not_see_them(costs, status, told):
    trial = replace(SPEC, strategy=Human(costs=costs))
    scene = replace(SCENE, trial=scene_of(trial).trial, status=status)
    assert any('[states]' in line.text for line in words(scene)) == told
    assert len(words(scene)) == 4 + told


def test_what_is_not_there_has_no_solid():
    layers = {solid.layer for solid in solids_of(scene_of(spec('.../...')))}
    assert layers == {'ground', 'frame', 'text'}
    ended = replace(SCENE, status=TrialStatus.CANCELLED)
    assert layer(ended, 'region') == []


@pytest.mark.parametrize('settings', PLANNERS, ids=planner_id)
def test_no_two_solids_have_the_same_name(settings):
    for tower in TOWERS:
        for scene in scenes_of(run_trial(spec(tower, budget=1_000, **settings))):
            names = [(solid.layer, solid.number) for solid in solids_of(scene)]
            assert len(names) == len(set(names))
