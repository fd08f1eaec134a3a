"""A scene's board as text.

A cell is drawn ``2 * scale`` characters wide and ``scale`` lines high, which is about square. The
edge of a block is inside its own cells, so neighbours never share a line, and every scale shows
each block completely. Rows are labelled with heights: the region ``rows(k)`` contains the rows with
labels up to k. At scale 1, while the second subgoal, ``rows(3)``, is executed::

     4 ░░░░  ░░
     3 ╔╗▒▒  ▒▒
     2 ╚╝[══]▒▒
     1 [──][──]
       ▔▔▔▔▔▔▔▔
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

from rich.style import Style
from rich.text import Text

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.view import palette
from blocks_planning.view.palette import Signs
from blocks_planning.view.scene import Scene

MARGIN = 3
"""Width of the row labels [characters]."""
MAX_SCALE = 3

_Canvas: TypeAlias = list[list[tuple[str, Style]]]
_PLAIN = Style()


def size_at(board: Board, scale: int) -> tuple[int, int]:
    """Width and height of a board's text [characters], labels and ground included."""
    return MARGIN + 2 * scale * board.width, scale * board.height + 1


def scale_for(board: Board, width: int, height: int) -> int:
    """The largest scale at which a board fits into ``width`` x ``height`` characters, or 1."""
    for scale in range(MAX_SCALE, 1, -1):
        wide, high = size_at(board, scale)
        if wide <= width and high <= height:
            return scale
    return 1


def board_text(scene: Scene, scale: int = 1, signs: Signs = palette.UNICODE) -> Text:
    """Draw the board of a scene.

    Args:
        scene: the scene.
        scale: lines for each row, 1 or more.
        signs: the characters of the terminal.

    Returns:
        Lines of equal width (see :func:`size_at`), without a newline at the end.
    """
    board, silhouette = scene.task.board, scene.task.silhouette
    canvas: _Canvas = [
        [(' ', _PLAIN)] * (2 * scale * board.width) for _ in range(scale * board.height)
    ]
    highlighted = Style(color=palette.colour_of(max(scene.record.subgoals - 1, 0)))
    for cells, sign, style in (
        (silhouette & ~scene.built, signs.target, _PLAIN),
        (scene.region, signs.region, highlighted),
    ):
        for cell in board.cells(cells):
            _paint(canvas, scale, Placed(1, 1, *cell), lambda *_, sign=sign: sign, style)
    for block, fill in zip(scene.blocks, palette.fills_of(scene.blocks), strict=True):
        frame = signs.frames[block.subgoal % len(signs.frames)]
        style = Style(color=palette.ink_on(fill), bgcolor=fill)
        _paint(canvas, scale, block.placed, frame.at, style)
    return _to_text(canvas, scale, scene, signs)


def _paint(
    canvas: _Canvas,
    scale: int,
    placed: Placed,
    sign_at: Callable[[int, int, int, int], str],
    style: Style,
) -> None:
    """Fill a rectangle with the signs of (x, y, width, height) [characters], y downwards."""
    width, height = 2 * scale * placed.width, scale * placed.height
    left = 2 * scale * placed.column
    top = len(canvas) - scale * (placed.row + placed.height)
    for y in range(height):
        for x in range(width):
            canvas[top + y][left + x] = (sign_at(x, y, width, height), style)


def _to_text(canvas: _Canvas, scale: int, scene: Scene, signs: Signs) -> Text:
    """Add the labels and the ground to the cells; the top row of the current region is bold."""
    goal = scene.top
    text = Text(no_wrap=True, overflow='crop')
    for line, cells in enumerate(canvas, start=1):
        row, above = divmod(len(canvas) - line, scale)
        label = f'{row + 1:>{MARGIN - 1}} ' if above == scale // 2 else ' ' * MARGIN
        text.append(label, Style(bold=True) if row + 1 == goal else _PLAIN)
        text.append_tokens(cells)
        text.append('\n')
    text.append(' ' * MARGIN + signs.ground * len(canvas[0]))
    return text
