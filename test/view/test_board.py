from __future__ import annotations

from textwrap import dedent

import pytest
from builders import as_ordered
from rich.text import Text

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.decision import Decision, Subgoal
from blocks_planning.subgoals.regions import Region, rows_label
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import TrialStarted
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view import board as view_board
from blocks_planning.view import palette
from blocks_planning.view.board import MARGIN, board_text, scale_for, size_at
from blocks_planning.view.scene import Scene, last_scene, scene_of, scenes_of

BOARD = Board(4, 4)
SILHOUETTE = BOARD.parse(['##.#', '##.#', '####', '####'])


@pytest.fixture
def second_subgoal() -> Scene:
    """Two blocks of the first subgoal stand, and two of the second, rows(3)."""
    task = Task(BOARD, SILHOUETTE)
    spec = TrialSpec('small', task, make_strategy('full', {}), make_search('bfs', {}))
    blocks = [(2, 1, 0, 0), (2, 1, 2, 0), (1, 2, 0, 1), (2, 1, 1, 1)]
    placements = tuple(Placed(*block) for block in blocks)
    subgoals = tuple(
        Subgoal(Region(rows_label(height), cells), cells, 2, plan, 0, 0, 1)
        for height, plan in ((1, placements[:2]), (3, placements[2:]))
        for cells in (task.rows(height),)
    )
    decision = Decision(0, (), 0, subgoals, 0, 1)
    return Scene(
        TrialStarted(spec.trial_id, spec),
        observations=as_ordered(*placements),
        chosen=SubgoalChosen(spec.trial_id, 2, (DecisionRecord(0, decision, 2),)),
    )


def cells_of(text: Text, scale: int) -> list[str]:
    """The lines without labels and ground."""
    return [line[MARGIN:] for line in text.plain.split('\n')[:-1]]


def style_at(text: Text, line: int, character: int) -> str:
    """The style of one character."""
    offset = sum(len(each) + 1 for each in text.plain.split('\n')[:line]) + character
    return ' '.join(str(span.style) for span in text.spans if span.start <= offset < span.end)


def test_drawing_is_the_one_in_the_documentation(second_subgoal):
    assert view_board.__doc__ is not None
    _, _, drawing = view_board.__doc__.partition('::\n\n')
    drawn = dedent(board_text(second_subgoal).plain)
    assert [line.rstrip() for line in drawn.split('\n')] == dedent(drawing).rstrip().split('\n')


def test_larger_drawing_without_unicode(second_subgoal):
    assert cells_of(board_text(second_subgoal, 2, palette.ASCII), 2) == [
        '........    ....',
        '........    ....',
        '#==#::::    ::::',
        'H  H::::    ::::',
        'H  H#======#::::',
        '#==##======#::::',
        '+------++------+',
        '+------++------+',
    ]


def test_labels_stand_in_the_middle_of_their_rows(second_subgoal):
    lines = board_text(second_subgoal, 3).plain.split('\n')
    assert [line[:MARGIN] for line in lines[:6]] == ['   ', ' 4 ', '   ', '   ', ' 3 ', '   ']


def test_colours_of_blocks_and_of_the_region(second_subgoal):
    text = board_text(second_subgoal)
    first, second = palette.COLOURS[:2]
    fills = palette.fills_of(second_subgoal.blocks)
    assert style_at(text, 3, MARGIN) == f'#000000 on {first}'
    assert style_at(text, 2, MARGIN) == f'#000000 on {second}'
    assert style_at(text, 2, MARGIN + 2) == f'#000000 on {fills[3]}'
    assert style_at(text, 1, MARGIN + 2) == second
    assert style_at(text, 0, MARGIN) == ''
    bold = [line for line in range(4) if 'bold' in style_at(text, line, 1)]
    assert bold == [1]


@pytest.mark.parametrize('size', [(8, 8), (3, 3), (16, 16), (1, 16), (16, 1), (1, 1)])
@pytest.mark.parametrize('scale', [1, 2, 3])
def test_size_is_as_said(filled_spec, recorded, size, scale):
    scene = last_scene(recorded(filled_spec(*size)))
    lines = board_text(scene, scale).plain.split('\n')
    width, height = size_at(scene.task.board, scale)
    assert len(lines) == height
    assert {len(line) for line in lines} == {width}


@pytest.mark.parametrize('number', range(1, 17))
@pytest.mark.parametrize('signs', [palette.UNICODE, palette.ASCII])
def test_target_can_be_read_off(tower_spec, number, signs):
    scene = scene_of(tower_spec(number))
    lines = cells_of(board_text(scene, 1, signs), 1)
    rows = [line[::2].replace(signs.target, '#').replace(' ', '.') for line in lines]
    assert scene.task.board.parse([row.replace(' ', '.') for row in rows]) == scene.task.silhouette


def test_every_scene_shows_which_cells_are_filled(tower_spec, recorded):
    signs, board = palette.UNICODE, Board(8, 8)
    for scene in scenes_of(recorded(tower_spec())):
        for index, line in enumerate(cells_of(board_text(scene), 1)):
            for column in range(8):
                bit = board.bit(column, 7 - index)
                pair = line[2 * column : 2 * column + 2]
                if scene.region >> bit & 1:
                    assert pair == signs.region * 2
                elif scene.task.silhouette >> bit & 1 and not scene.built >> bit & 1:
                    assert pair == signs.target * 2
                elif not scene.built >> bit & 1:
                    assert pair == '  '
                else:
                    assert not set(pair) & {signs.region, signs.target}


@pytest.mark.parametrize(
    ('size', 'room', 'scale'),
    [
        ((8, 8), (41, 23), 2),
        ((16, 16), (41, 23), 1),
        ((3, 3), (41, 23), 3),
        ((16, 16), (160, 48), 2),
        ((16, 16), (160, 49), 3),
        ((16, 16), (10, 10), 1),
        ((1, 16), (41, 33), 2),
        ((16, 1), (67, 23), 2),
    ],
)
def test_scale_is_the_largest_that_fits(size, room, scale):
    assert scale_for(Board(*size), *room) == scale
