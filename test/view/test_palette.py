from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from blocks_planning.board.blocks import Placed
from blocks_planning.view import palette
from blocks_planning.view.scene import BuiltBlock, last_scene

# How linear RGB is seen with one kind of cone missing: Machado, Oliveira and Fernandes (2009),
# "A physiologically-based model for simulation of color vision deficiency", severity 1.
VISIONS = {
    'normal': np.eye(3),
    'protanopia': np.array(
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ]
    ),
    'deuteranopia': np.array(
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.01182, 0.04294, 0.968881],
        ]
    ),
    'tritanopia': np.array(
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.3039],
        ]
    ),
}
XYZ_OF_RGB = np.array(
    [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]]
)
WHITE_XYZ = np.array([0.9505, 1.0, 1.089])


def linear(colour: str) -> np.ndarray:
    levels = np.array(list(bytes.fromhex(colour[1:]))) / 255
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


def lab(rgb: np.ndarray) -> np.ndarray:
    """CIE L*a*b* of linear RGB."""
    ratio = XYZ_OF_RGB @ rgb.clip(0, 1) / WHITE_XYZ
    x, y, z = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16 / 116)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def contrast(one: str, other: str) -> float:
    """Contrast ratio of WCAG 2."""
    low, high = sorted(float(XYZ_OF_RGB[1] @ linear(colour)) for colour in (one, other))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize('vision', VISIONS)
def test_consecutive_subgoals_differ_for_everybody(vision):
    for one, other in pairwise((*palette.COLOURS, palette.COLOURS[0])):
        seen = [lab(VISIONS[vision] @ linear(colour)) for colour in (one, other)]
        assert np.linalg.norm(seen[0] - seen[1]) > 20, (one, other)


@pytest.mark.parametrize('colour', palette.COLOURS)
def test_colours_are_seen_on_dark_and_on_light(colour):
    assert contrast(colour, '#ffffff') > 2
    assert contrast(colour, '#000000') > 4


@pytest.mark.parametrize('tint', palette.TINTS)
@pytest.mark.parametrize('colour', palette.COLOURS)
def test_ink_is_read_on_every_tint(colour, tint):
    fill = palette.blend(colour, tint)
    assert contrast(palette.ink_on(fill), fill) >= 4.5


def test_blend_reaches_white_and_black():
    assert [palette.blend('#0072b2', share) for share in (0, 1, -1)] == [
        '#0072b2',
        '#ffffff',
        '#000000',
    ]


def test_blocks_that_touch_get_other_colours():
    pile = [(2, 1, 0, 0), (2, 1, 2, 0), (1, 2, 0, 1), (2, 2, 1, 1), (1, 1, 3, 1)]
    blocks = [BuiltBlock(Placed(*each), 0) for each in pile]
    fills = palette.fills_of(blocks)
    for one, other in [(0, 1), (0, 2), (0, 3), (1, 3), (1, 4), (2, 3), (3, 4)]:
        assert fills[one] != fills[other]
    assert fills[1] == fills[2]  # only a corner, at most, is common to these


@pytest.mark.parametrize('strategy', ['none', 'scoping', 'full'])
def test_towers_need_no_more_tints_than_there_are(tower_spec, recorded, strategy):
    for number in range(1, 17):
        scene = last_scene(recorded(tower_spec(number, strategy)))
        fills = palette.fills_of(scene.blocks)
        for index, block in enumerate(scene.blocks):
            for other in range(index):
                if palette._touch(block, scene.blocks[other]):
                    assert fills[index] != fills[other]


def test_a_block_keeps_its_colour(tower_spec, recorded):
    blocks = last_scene(recorded(tower_spec())).blocks
    fills = palette.fills_of(blocks)
    for count in range(len(blocks)):
        assert palette.fills_of(blocks[:count]) == fills[:count]


@pytest.mark.parametrize('signs', [palette.UNICODE, palette.ASCII])
def test_signs_can_be_shown_and_told_apart(signs):
    single = (signs.target, signs.region, signs.ground, signs.marker, signs.more)
    ''.join((*signs.frames[0], *signs.frames[1], *single, signs.halves)).encode(signs.encoding)
    assert len({signs.target, signs.region, ' '}) == 3
    for one, other in pairwise((*signs.frames, signs.frames[0])):
        assert set(one.box) & set(other.box) <= {' '}
        assert one.flat != other.flat
    for frame in signs.frames:
        assert (len(frame.box), len(frame.flat)) == (9, 3)
    assert all(len(sign) == 1 for sign in single)
    assert len(set(signs.halves)) == len(signs.halves) == 3


def test_shown_leaves_one_line_that_can_be_encoded():
    assert palette.UNICODE.shown('a\x1b[31m\nb\udc80…') == 'a?[31m?b?…'
    assert palette.ASCII.shown('türme\t1') == 't?rme?1'


def test_frame_goes_round():
    frame = palette.UNICODE.frames[0]
    lines = [''.join(frame.at(x, y, 4, 3) for x in range(4)) for y in range(3)]
    assert lines == ['┌──┐', '│  │', '└──┘']
    assert ''.join(frame.at(x, 0, 4, 1) for x in range(4)) == '[──]'
