"""Towers in terminals that are too small for their usual form."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from blocks_planning.view import palette
from blocks_planning.view.compact import compact_size, compact_text
from blocks_planning.view.scene import last_scene, scene_of, scenes_of
from blocks_planning.view.terminal import ROOM, frame, print_outcome


def lines_of(drawn: object, width: int) -> list[str]:
    console = Console(file=io.StringIO(), width=width, height=24, _environ={})
    lines = console.render_lines(drawn, console.options.update_width(width), pad=False)  # type: ignore[arg-type]
    return [''.join(segment.text for segment in line) for line in lines]


def first_characters(text: str) -> str:
    return text.replace(palette.UNICODE.target, '.').replace('▔', '"')


def test_two_rows_share_a_line(filled_spec, recorded):
    spec = filled_spec(4, 3, 'none')
    empty, full = scene_of(spec), last_scene(recorded(spec))
    assert first_characters(compact_text(empty).plain).split('\n') == [
        ' 3 ....',
        ' 2 ....',
        '   """"',
    ]
    assert full.built == spec.task.board.full
    top, bottom, _ = compact_text(full).plain.split('\n')
    assert (top, set(bottom[3:]) <= {'█', '▀'}) == (' 3 ▄▄▄▄', True)


def test_every_filled_cell_shows_the_colour_of_its_block(tower_spec, recorded):
    scene = last_scene(recorded(tower_spec()))
    board = scene.task.board
    text = compact_text(scene)
    fills = palette.fills_of(scene.blocks)
    console = Console(width=80)
    wide = compact_size(board)[0] + 1
    for block, fill in zip(scene.blocks, fills, strict=True):
        placed = block.placed
        for column in range(placed.column, placed.column + placed.width):
            for row in range(placed.row, placed.row + placed.height):
                line = (board.height + 1) // 2 - 1 - row // 2
                offset = line * wide + 3 + column
                style = text.get_style_at_offset(console, offset)
                shown = {style.color and style.color.name, style.bgcolor and style.bgcolor.name}
                assert fill in shown


@pytest.mark.parametrize('size', [(8, 8), (16, 16), (1, 16), (16, 1), (5, 7)])
def test_it_has_the_size_that_it_says(filled_spec, recorded, size):
    for scene in scenes_of(recorded(filled_spec(*size))):
        for signs in (palette.UNICODE, palette.ASCII):
            lines = compact_text(scene, signs).plain.split('\n')
            wide, high = compact_size(scene.task.board)
            assert len(lines) == high
            assert {len(line) for line in lines} == {wide}


@pytest.mark.parametrize(
    ('width', 'height', 'rows'),
    [(80, 24, 16), (100, 30, 16), (200, 50, 32), (60, 24, 8), (80, 12, 8), (40, 24, 8)],
)
def test_a_tower_of_16_rows_is_shown_whole(filled_spec, width, height, rows):
    scene = scene_of(filled_spec(16, 16, 'none'))
    lines = lines_of(frame(scene, width, height - ROOM), width)
    assert len(lines) <= height - ROOM
    assert max(map(len, lines)) <= width
    assert sum(palette.UNICODE.target in line for line in lines) == rows
    assert any('▔' in line for line in lines)
    assert any('subgoal planning cost' in line for line in lines)


@pytest.mark.parametrize(('width', 'height'), [(30, 8), (80, 5), (10, 24), (30, 3)])
def test_where_nothing_fits_the_ground_is_kept_and_it_says_so(filled_spec, width, height):
    scene = scene_of(filled_spec(16, 16, 'none'))
    lines = lines_of(frame(scene, width, height - ROOM), width)
    assert len(lines) <= height - ROOM
    assert lines[0].startswith('too small:'[:width])
    if height - ROOM > 1:
        assert any('▔' in line for line in lines)


@pytest.mark.parametrize(('width', 'height', 'lines'), [(80, 24, 17), (80, 50, 33), (30, 24, 9)])
def test_the_last_picture_fits_a_terminal_that_cannot_move_its_cursor(
    filled_spec, recorded, width, height, lines
):
    record = recorded(filled_spec(16, 16))
    file = io.StringIO()
    print_outcome(record, Console(file=file, width=width, height=height, _environ={}))
    assert len(file.getvalue().splitlines()) == lines + 1
