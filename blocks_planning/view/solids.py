"""A scene in three dimensions: boxes, lines and text, for viewers such as RViz and Foxglove.

All lengths are in cells. The tower stands in the x-z plane: columns go along +x, rows along +z, and
it is one cell deep along +y, so that a view along +y shows the board as it is drawn elsewhere.
The lower left corner of cell (0, 0) is the origin.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TypeAlias

from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import captions, palette
from blocks_planning.view.outline import outline
from blocks_planning.view.scene import Scene

Point: TypeAlias = tuple[float, float, float]

GAP = 0.03
"""Gap between the face of a block and its cells, which makes edges visible [cells]."""
GROUND_THICKNESS = 0.1
OUTLINE_WIDTH, FRAME_WIDTH = 0.08, 0.02
TEXT_ABOVE = 0.5
"""Distance from the board to the lowest line of text [cells]."""
LINE_SPACING, CHARACTER_WIDTH = 1.8, 0.75
"""Line spacing, and mean letter spacing, for letters of height 1."""
LETTER_HEIGHTS = (0.25, 0.5)
"""Smallest and largest height of letters [cells]."""
TITLE_CHARACTERS = 60

INK, TEXT_INK = '#8c8c8c', '#d9d9d9'
"""Lines are visible on dark and light backgrounds, text on dark ones."""
REGION_OPACITY = 0.4
_ENDED = {TrialStatus.BUILDING: TEXT_INK, TrialStatus.SUCCESS: palette.GOOD}


@dataclass(frozen=True)
class Solid:
    """An object in the scene.

    Attributes:
        layer: its kind; a viewer can hide a layer.
        number: unique within its layer.
        colour: as '#rrggbb'.
    """

    layer: str
    number: int
    colour: str


@dataclass(frozen=True)
class Box(Solid):
    """A box by its centre and its size along x, y and z [cells]."""

    centre: Point
    size: Point


@dataclass(frozen=True)
class Boxes(Solid):
    """Boxes of one size [cells]; ``opacity`` is from 0 (invisible) to 1."""

    centres: tuple[Point, ...]
    size: Point
    opacity: float


@dataclass(frozen=True)
class Lines(Solid):
    """Straight lines of a width [cells]; two consecutive ``ends`` form one line."""

    ends: tuple[Point, ...]
    width: float


@dataclass(frozen=True)
class Words(Solid):
    """A line of text, centred at a point; ``height`` is that of a capital letter [cells]."""

    centre: Point
    height: float
    text: str


def solids_of(scene: Scene) -> list[Solid]:
    """All solids of a scene; no two have the same layer and number."""
    return [
        _ground(scene),
        _frame(scene),
        *_outline(scene),
        *_blocks(scene),
        *_region(scene),
        *_words(scene),
    ]


def _ground(scene: Scene) -> Box:
    width = scene.task.board.width
    return Box(
        'ground',
        0,
        INK,
        centre=(width / 2, 0.5, -GROUND_THICKNESS / 2),
        size=(width, 1, GROUND_THICKNESS),
    )


def _frame(scene: Scene) -> Lines:
    """The rectangle of the board, halfway deep."""
    board = scene.task.board
    ends = _in_plane(outline(board, board.full), depth=0.5)
    return Lines('frame', 0, INK, tuple(ends), FRAME_WIDTH)


def _outline(scene: Scene) -> Iterator[Lines]:
    """The border of the silhouette, in front of the blocks."""
    ends = tuple(_in_plane(outline(scene.task.board, scene.task.silhouette), depth=0))
    if ends:
        yield Lines('silhouette', 0, INK, ends, OUTLINE_WIDTH)


def _in_plane(
    lines: Iterator[tuple[tuple[int, int], tuple[int, int]]], depth: float
) -> Iterator[Point]:
    for line in lines:
        for x, z in line:
            yield x, depth, z


def _blocks(scene: Scene) -> Iterator[Box]:
    """Every block, numbered from 1 in the order in which they were placed."""
    fills = palette.fills_of(scene.blocks)
    for number, (block, fill) in enumerate(zip(scene.blocks, fills, strict=True), start=1):
        width, height, column, row = block.placed
        yield Box(
            'blocks',
            number,
            fill,
            centre=(column + width / 2, 0.5, row + height / 2),
            size=(width - 2 * GAP, 1 - 2 * GAP, height - 2 * GAP),
        )


def _region(scene: Scene) -> Iterator[Boxes]:
    """The unfilled cells of the current subgoal, in the colour of its blocks."""
    cells = scene.task.board.cells(scene.region)
    centres = tuple((column + 0.5, 0.5, row + 0.5) for column, row in cells)
    if centres:
        colour = palette.colour_of(max(scene.record.subgoals - 1, 0))
        side = 1 - 2 * GAP
        yield Boxes('region', 0, colour, centres, (side, side, side), REGION_OPACITY)


def _words(scene: Scene) -> Iterator[Words]:
    """Stimulus, status, planner and costs, above the board; of its width, if that is legible.

    Each line is a separate solid, because viewers differ in line spacing.
    """
    board = scene.task.board
    lines = captions.heading_of(scene, TITLE_CHARACTERS, palette.ASCII)
    if _are_costs_hidden(scene):
        lines.remove(captions.costs_of(scene))
    least, most = LETTER_HEIGHTS
    height = max(least, min(most, board.width / (CHARACTER_WIDTH * max(map(len, lines)))))
    colour = _ENDED.get(scene.status, palette.BAD)
    for number, text in enumerate(lines):
        above = TEXT_ABOVE + LINE_SPACING * height * (len(lines) - number - 0.5)
        yield Words(
            'text', number, colour, (board.width / 2, 0.5, board.height + above), height, text
        )


def _are_costs_hidden(scene: Scene) -> bool:
    """Whether planning costs must be hidden."""
    return scene.spec.strategy.hides_costs and scene.status is TrialStatus.BUILDING
