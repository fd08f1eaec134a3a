from __future__ import annotations

import re
from dataclasses import replace
from io import BytesIO
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st
from matplotlib.figure import Figure
from PIL import Image, ImageSequence

from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError
from blocks_planning.view import captions, palette, picture
from blocks_planning.view.outline import outline
from blocks_planning.view.picture import draw_scene, save_picture
from blocks_planning.view.scene import last_scene, scenes_of

BEGINNINGS = {'.png': b'\x89PNG', '.svg': b'<?xml', '.pdf': b'%PDF', '.gif': b'GIF89a'}


def rgb(colour: str) -> tuple[int, ...]:
    return tuple(bytes.fromhex(colour[1:]))


def colours_of(image: Image.Image) -> set[object]:
    return {colour for _, colour in image.getcolors(1 << 16) or ()}


@pytest.mark.parametrize('suffix', picture.SUFFIXES)
def test_the_same_record_gives_the_same_file(tower_spec, recorded, tmp_path, suffix):
    record = recorded(tower_spec())
    paths = [tmp_path / f'one{suffix}', tmp_path / f'two{suffix.upper()}']
    for path in paths:
        save_picture(record, path)
    first, second = (path.read_bytes() for path in paths)
    assert first.startswith(BEGINNINGS[suffix])
    assert first == second
    assert not re.search(rb'20\d\d-\d\d-\d\d|CreationDate', first)


@pytest.mark.parametrize('name', ['tower', 'tower.bmp', 'tower.png.txt', '.png'])
def test_an_unknown_suffix_is_refused(tower_spec, recorded, tmp_path, name):
    path = tmp_path / name
    with pytest.raises(ConfigurationError) as caught:
        save_picture(recorded(tower_spec()), path)
    assert str(caught.value) == (
        f'{path}: the suffix of a picture must be one of .png, .svg, .pdf, .gif, '
        f'got {path.suffix!r}'
    )
    assert not path.exists()


@pytest.mark.parametrize('name', ['missing/tower.png', 'folder.png', 'x' * 300 + '.gif'])
def test_a_path_that_cannot_be_written_is_named(tower_spec, recorded, tmp_path, name):
    (tmp_path / 'folder.png').mkdir()
    path = tmp_path / name
    with pytest.raises(ConfigurationError, match=r'^[^\n]*: cannot be written: [^\n]+$') as caught:
        save_picture(recorded(tower_spec()), path)
    assert str(path) in str(caught.value)


@pytest.mark.parametrize('size', [(8, 8), (3, 3), (16, 16), (1, 16), (16, 1), (1, 1)])
def test_blocks_are_where_they_stand(filled_spec, recorded, tmp_path, size):
    record = recorded(filled_spec(*size))
    path = tmp_path / 'tower.png'
    save_picture(record, path)
    scene, board = last_scene(record), record.spec.task.board
    with Image.open(path) as opened:
        image = opened.convert('RGB')
    cell = picture.CELL_INCHES * picture.DPI
    left = (image.width - cell * board.width) / 2
    ground = image.height - picture.MARGIN_INCHES * picture.DPI
    for block, fill in zip(scene.blocks, palette.fills_of(scene.blocks), strict=True):
        # Beside the corner of the block: inside its edge, away from its number.
        x = left + cell * (block.placed.column + 0.15)
        y = ground - cell * (block.placed.row + 0.15)
        assert image.getpixel((round(x), round(y))) == rgb(fill)


def test_axes_show_every_block_with_its_number(tower_spec, recorded):
    scene = last_scene(recorded(tower_spec()))
    axes = Figure().add_subplot()
    draw_scene(axes, scene)
    numbers = {text.get_text(): text.get_position() for text in axes.texts}
    assert numbers == {
        str(number): (
            block.placed.column + block.placed.width / 2,
            block.placed.row + block.placed.height / 2,
        )
        for number, block in enumerate(scene.blocks, start=1)
    }
    assert axes.get_xlim() == (0, 8)
    assert axes.get_ylim() == (0, 8)


def test_numbers_are_smaller_where_there_is_less_room(tower_spec, recorded):
    scene = last_scene(recorded(tower_spec()))
    figure = Figure()
    sizes = []
    for axes in (figure.add_axes((0, 0, 1, 1)), figure.add_axes((0, 0, 0.25, 0.25))):
        draw_scene(axes, scene)
        sizes.append(axes.texts[0].get_fontsize())
    assert sizes[0] == pytest.approx(4 * sizes[1])


def test_animation_shows_every_scene_and_stays_at_the_last(tower_spec, recorded, tmp_path):
    record = recorded(tower_spec())
    path = tmp_path / 'tower.gif'
    save_picture(record, path)
    scenes = list(scenes_of(record))
    different = [one for one, other in pairwise(scenes) if one != other]
    with Image.open(path) as image:
        frames = list(ImageSequence.all_frames(image, lambda frame: frame.convert('RGB')))
        durations = [frame.info['duration'] for frame in ImageSequence.Iterator(image)]
    assert len(frames) == len(different) + 1
    assert durations[-1] >= picture.LAST_FRAME_MS > max(durations[:-1])
    assert image.info['loop'] == 0
    colours = colours_of(frames[-1])
    assert {rgb(fill) for fill in palette.fills_of(scenes[-1].blocks)} <= colours
    assert len(colours) <= 64


def test_animation_shows_the_region_that_is_filled_next(tower_spec, recorded, tmp_path):
    path = tmp_path / 'tower.gif'
    save_picture(recorded(tower_spec()), path)
    region = rgb(palette.blend(palette.COLOURS[0], picture.REGION_SHARE))
    with Image.open(path) as image:
        first, second, *_ = ImageSequence.all_frames(image, lambda frame: frame.convert('RGB'))
    assert region not in colours_of(first)
    assert region in colours_of(second)


@pytest.mark.parametrize('name', ['a$b$c', r'$\frac{$', '塔', 'x' * 500, 'a\nb', '<&>'])
def test_any_name_can_be_a_title(tower_spec, recorded, tmp_path, name):
    record = recorded(tower_spec())
    save_picture(replace(record, spec=tower_spec(name=name)), tmp_path / 'tower.svg')


def test_title_says_what_and_how(tower_spec, recorded):
    record = recorded(tower_spec())
    assert captions.heading_of(last_scene(record), picture.TITLE_CHARACTERS) == [
        'cogsci2021/9: success',
        'scoping, lambda 0.002',
        'bfs, depth 3',
        f'{record.blocks} blocks, {record.subgoals} subgoals',
        captions.costs_of(last_scene(record)),
    ]


def test_title_fits_the_narrowest_picture(filled_spec, recorded):
    record = recorded(filled_spec(1, 1))
    wide = replace(record, spec=replace(record.spec, stimulus='m' * 100))
    figure = picture._figure(last_scene(wide))
    figure.savefig(BytesIO(), format='png')
    for text in figure.texts:
        extent = text.get_window_extent()
        assert extent.x0 >= 0
        assert extent.x1 <= figure.bbox.width


@given(data=st.data(), width=st.integers(1, 6), height=st.integers(1, 6))
def test_outline_parts_the_cells_from_the_rest(data, width, height):
    board = Board(width, height)
    mask = data.draw(st.integers(0, board.full))
    pieces: list[tuple[int, int, bool]] = []
    for (x0, y0), (x1, y1) in outline(board, mask):
        assert (x0 == x1) != (y0 == y1)
        steps = max(x1 - x0, y1 - y0)
        upright = x0 == x1
        pieces += [(x0 + (not upright) * k, y0 + upright * k, upright) for k in range(steps)]
    assert len(pieces) == len(set(pieces))
    cells = set(board.cells(mask))
    assert set(pieces) == {
        (x, y, upright)
        for x in range(width + 1)
        for y in range(height + 1)
        for upright in (False, True)
        if ((x, y) in cells) != (((x - 1, y) if upright else (x, y - 1)) in cells)
    }


def test_pyplot_is_not_used():
    assert 'pyplot' not in Path(picture.__file__).read_text(encoding='utf-8')


@pytest.mark.parametrize('size', [(4, 4), (16, 16)])
def test_vector_picture_has_every_block_with_its_edge_and_colour(
    filled_spec, recorded, tmp_path, size
):
    scene = last_scene(recorded(filled_spec(*size)))
    save_picture(scene.record, tmp_path / 'tower.svg')
    root = ElementTree.parse(tmp_path / 'tower.svg').getroot()
    edged = [
        (found['fill'], [float(number) for number in re.findall(r'[\d.]+', path.get('d', ''))])
        for path in root.iterfind('.//{*}path')
        if (found := style_of(path)).get('stroke') == picture.INK and found['fill'] != 'none'
    ]
    assert [fill for fill, _ in edged] == palette.fills_of(scene.blocks)
    cell = picture.CELL_INCHES * 72
    for block, (_, corners) in zip(scene.blocks, edged, strict=True):
        xs, ys = corners[::2], corners[1::2]
        assert max(xs) - min(xs) == pytest.approx(cell * block.placed.width)
        assert max(ys) - min(ys) == pytest.approx(cell * block.placed.height)


def style_of(element: ElementTree.Element) -> dict[str, str]:
    """The properties in the style of an element of an SVG."""
    pairs = (part.partition(':') for part in element.get('style', '').split(';'))
    return {name.strip(): value.strip() for name, _, value in pairs}


@pytest.mark.parametrize('name', ['cogsci2021/9', '<&> "x"'])
def test_vector_picture_says_the_outcome_as_text_too(tower_spec, recorded, tmp_path, name):
    record = replace(recorded(tower_spec()), spec=tower_spec(name=name))
    save_picture(record, tmp_path / 'tower.svg')
    root = ElementTree.parse(tmp_path / 'tower.svg').getroot()
    assert root.findtext('{*}title') == captions.outcome_of(last_scene(record))
