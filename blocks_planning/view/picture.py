"""Pictures of trials in files: the finished tower, or its building block by block.

With the same versions of matplotlib and pillow, the same record gives the same bytes.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from io import BytesIO
from pathlib import Path
from typing import Any

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import extra
from blocks_planning.trials.record import TrialRecord
from blocks_planning.view import captions, palette
from blocks_planning.view.outline import outline
from blocks_planning.view.scene import Scene, last_scene, scenes_of

with extra('figures'):
    import matplotlib as mpl
    from matplotlib.axes import Axes
    from matplotlib.collections import LineCollection, PolyCollection
    from matplotlib.figure import Figure
    from PIL import Image

CELL_INCHES = 0.5
MIN_WIDTH_INCHES = 4.8
LINE_INCHES = 0.2
TITLE_INCHES = 1.2
MARGIN_INCHES = 0.15
TITLE_SHARE = 0.95
"""Share of the width that a title may take; a longer one gets smaller letters."""
TITLE_CHARACTERS = 60

DPI = 150
ANIMATION_DPI = 80
FRAME_MS = 400
LAST_FRAME_MS = 3000

INK, GRID, TARGET, PAPER = '#000000', '#ffffff', '#e4e4e4', '#ffffff'
REGION_SHARE = 0.6
"""Share of white in the colour of cells that will be filled."""

_TITLED = ('.svg', '.pdf')
"""Formats that also contain the outcome as text, for tooltips and screen readers."""
_METADATA: dict[str, dict[str, Any]] = {
    '.png': {'Software': None},
    '.svg': {'Date': None, 'Creator': 'blocks_planning'},
    '.pdf': {'CreationDate': None, 'Creator': 'blocks_planning'},
}
SUFFIXES = (*_METADATA, '.gif')

_STYLE = {
    'font.family': 'DejaVu Sans',
    'path.simplify': False,
    'svg.fonttype': 'path',
    'svg.hashsalt': 'blocks_planning',
    'text.usetex': False,
}


def check_picture_path(path: Path) -> None:
    """Refuse a path whose suffix is not one of ``SUFFIXES``, in upper or lower case.

    Raises:
        ConfigurationError: naming the suffix and those that can be used.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise ConfigurationError(
            f'{path}: the suffix of a picture must be one of {", ".join(SUFFIXES)}, '
            f'got {path.suffix!r}'
        )


def save_picture(record: TrialRecord, path: Path | str) -> None:
    """Draw a trial into a file.

    Args:
        record: the trial.
        path: .png, .svg and .pdf show the end, .gif all steps.

    Raises:
        ConfigurationError: if the suffix is unknown, or the file can't be written.
    """
    path = Path(path)
    check_picture_path(path)
    suffix = path.suffix.lower()
    data = _animation(record) if suffix == '.gif' else _drawn(last_scene(record), suffix, DPI)
    try:
        path.write_bytes(data)
    except OSError as error:
        raise ConfigurationError(f'{path}: cannot be written: {error.strerror}') from None


def draw(record: TrialRecord) -> Image.Image:
    """The end of a trial as a picture in memory; a notebook shows it."""
    return image_of(last_scene(record))


def draw_scene(axes: Axes, scene: Scene) -> None:
    """Draw the board of a scene: target, region, blocks with their numbers, outline and ground.

    Args:
        axes: gets the limits of the board [cells], equal scales and no ticks. Lines and numbers
            are scaled to its current size.
        scene: the scene.
    """
    board, silhouette = scene.task.board, scene.task.silhouette
    cell = _cell_points(axes, board)
    thin, thick = cell / 24, cell / 12
    region = palette.blend(palette.colour_of(max(scene.record.subgoals - 1, 0)), REGION_SHARE)
    for cells, colour in (silhouette & ~scene.built, TARGET), (scene.region, region):
        squares = [Placed(1, 1, *square) for square in board.cells(cells)]
        _add_rectangles(axes, squares, [colour] * len(squares), GRID, thin)
    placed = [block.placed for block in scene.blocks]
    fills = palette.fills_of(scene.blocks)
    _add_rectangles(axes, placed, fills, INK, thin)
    for number, (rectangle, fill) in enumerate(zip(placed, fills, strict=True), start=1):
        axes.text(
            rectangle.column + rectangle.width / 2,
            rectangle.row + rectangle.height / 2,
            str(number),
            color=palette.ink_on(fill),
            fontsize=cell / 3,
            ha='center',
            va='center_baseline',
        )
    axes.add_collection(
        LineCollection(
            list(outline(board, silhouette)),
            colors=INK,
            linewidths=thick,
            capstyle='projecting',
            clip_on=False,
        ),
        autolim=False,
    )
    axes.plot([0, board.width], [0, 0], color=INK, linewidth=2 * thick, clip_on=False)
    axes.set(xlim=(0, board.width), ylim=(0, board.height), aspect='equal')
    axes.set_axis_off()


def _add_rectangles(
    axes: Axes, rectangles: Sequence[Placed], fills: Sequence[str], edge: str, line: float
) -> None:
    corners = [
        [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
        for width, height, x, y in rectangles
    ]
    axes.add_collection(
        PolyCollection(corners, facecolors=fills, edgecolors=edge, linewidths=line),
        autolim=False,
    )


def _cell_points(axes: Axes, board: Board) -> float:
    """The length of a cell's side when the board is fitted into the axes [points]."""
    inches = axes.get_window_extent().transformed(axes.figure.dpi_scale_trans.inverted())
    return 72 * min(inches.width / board.width, inches.height / board.height)


def _figure(scene: Scene) -> Figure:
    """A figure with the board of a scene and a title."""
    board = scene.task.board
    board_width, board_height = CELL_INCHES * board.width, CELL_INCHES * board.height
    width = max(board_width + 2 * MARGIN_INCHES, MIN_WIDTH_INCHES)
    height = board_height + 2 * MARGIN_INCHES + TITLE_INCHES
    figure = Figure(figsize=(width, height), facecolor=PAPER)
    left, bottom = (width - board_width) / 2, MARGIN_INCHES
    axes = figure.add_axes(
        (left / width, bottom / height, board_width / width, board_height / height)
    )
    draw_scene(axes, scene)
    for line, text in enumerate(captions.heading_of(scene, TITLE_CHARACTERS), start=1):
        size, weight = (11, 'bold') if line == 1 else (9, 'normal')
        written = figure.text(
            0.5,
            1 - (MARGIN_INCHES + line * LINE_INCHES) / height,
            text,
            color=INK,
            fontsize=size,
            fontweight=weight,
            ha='center',
            va='baseline',
            parse_math=False,
        )
        excess = written.get_window_extent().width / (TITLE_SHARE * figure.bbox.width)
        written.set_fontsize(size / max(excess, 1))
    return figure


def _drawn(scene: Scene, suffix: str, dpi: int) -> bytes:
    """The bytes of a file with a scene."""
    file = BytesIO()
    with mpl.rc_context(_STYLE), warnings.catch_warnings():
        # The name of a stimulus may contain characters that the font lacks; they become boxes.
        warnings.filterwarnings('ignore', 'Glyph .* missing', UserWarning)
        figure = _figure(scene)
        metadata = {**_METADATA[suffix]}
        if suffix in _TITLED:
            metadata['Title'] = captions.outcome_of(scene)
        figure.savefig(file, format=suffix[1:], dpi=dpi, metadata=metadata)
    return file.getvalue()


def _animation(record: TrialRecord) -> bytes:
    """A GIF of all scenes of a trial."""
    colours = _colours(record)
    images = [_image(scene, colours) for scene in scenes_of(record)]
    durations = [FRAME_MS] * (len(images) - 1) + [LAST_FRAME_MS]
    file = BytesIO()
    images[0].save(
        file, 'GIF', save_all=True, append_images=images[1:], duration=durations, loop=0
    )
    return file.getvalue()


def image_of(scene: Scene) -> Image.Image:
    """A scene as a picture in memory, for films with several pictures."""
    with Image.open(BytesIO(_drawn(scene, '.png', ANIMATION_DPI))) as image:
        return image.convert('RGB')


def _image(scene: Scene, colours: Image.Image) -> Image.Image:
    """A scene in the colours of a palette."""
    return image_of(scene).quantize(palette=colours, dither=Image.Dither.NONE)


def _colours(record: TrialRecord) -> Image.Image:
    """An image with the palette that the scenes of a trial need."""
    scenes = list(scenes_of(record))
    colours = set(palette.fills_of(scenes[-1].blocks))
    colours |= {
        palette.blend(palette.colour_of(max(scene.record.subgoals - 1, 0)), REGION_SHARE)
        for scene in scenes
    }
    greys = {f'#{level:02x}{level:02x}{level:02x}' for level in (*range(0, 256, 17), 0xE4)}
    image = Image.new('P', (1, 1))
    image.putpalette(bytes.fromhex(''.join(sorted(colours | greys)).replace('#', '')))
    return image
