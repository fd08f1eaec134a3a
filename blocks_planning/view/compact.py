"""A scene's board as text in its smallest form: two rows of cells on a line.

A cell is one character wide and half a line high. Blocks differ only in colour, so this
form is for boards that are too high or too wide for the terminal in any other form (see
:mod:`.board`). Where one half of a character is filled, the other half shows as background: grey
for a target cell, dark for a cell of the current region.
"""

from __future__ import annotations

from rich.style import Style
from rich.text import Text

from blocks_planning.board import rules
from blocks_planning.board.geometry import Board, Cell
from blocks_planning.view import palette
from blocks_planning.view.board import MARGIN
from blocks_planning.view.palette import Signs
from blocks_planning.view.scene import Scene

_TARGET = '#808080'
_DARK = -0.6
"""Share of black in the colour of a region."""


def compact_size(board: Board) -> tuple[int, int]:
    """Width and height of a board's text [characters], labels and ground included."""
    return MARGIN + board.width, (board.height + 1) // 2 + 1


def compact_text(scene: Scene, signs: Signs = palette.UNICODE) -> Text:
    """Draw the board of a scene.

    Args:
        scene: the scene.
        signs: the characters of the terminal.

    Returns:
        Lines of equal width (see :func:`compact_size`), without a newline at the end.
    """
    board = scene.task.board
    fills = _fills(scene)
    goal = scene.top
    text = Text(no_wrap=True, overflow='crop')
    for lower in reversed(range(0, board.height, 2)):
        upper = min(lower + 1, board.height - 1)
        style = Style(bold=lower < goal <= lower + 2)
        text.append(f'{upper + 1:>{MARGIN - 1}} ', style)
        for column in range(board.width):
            cells = (column, lower + 1), (column, lower)
            text.append_text(_sign(scene, cells, fills, signs))
        text.append('\n')
    text.append(' ' * MARGIN + signs.ground * board.width)
    return text


def _fills(scene: Scene) -> dict[Cell, str]:
    """The colour of every filled cell."""
    board = scene.task.board
    fills: dict[Cell, str] = {}
    for block, fill in zip(scene.blocks, palette.fills_of(scene.blocks), strict=True):
        cells = rules.cells_of(board, block.placed)
        fills.update(dict.fromkeys(board.cells(cells), fill))
    return fills


def _sign(scene: Scene, cells: tuple[Cell, Cell], fills: dict[Cell, str], signs: Signs) -> Text:
    """The character of two cells, the upper one first."""
    above, below = (fills.get(cell) for cell in cells)
    if above and below:
        if above == below:
            return Text(signs.halves[2], Style(color=above))
        return Text(signs.halves[0], Style(color=above, bgcolor=below))
    if above:
        return Text(signs.halves[0], Style(color=above, bgcolor=_background(scene, cells[1])))
    if below:
        return Text(signs.halves[1], Style(color=below, bgcolor=_background(scene, cells[0])))
    return _open_sign(scene, cells, signs)


def _open_sign(scene: Scene, cells: tuple[Cell, Cell], signs: Signs) -> Text:
    """The character of two empty cells."""
    if any(_is_in(scene, cell, scene.region) for cell in cells):
        return Text(signs.region, Style(color=palette.colour_of(scene.record.subgoals - 1)))
    if any(_is_in(scene, cell, scene.task.silhouette) for cell in cells):
        return Text(signs.target)
    return Text(' ')


def _background(scene: Scene, cell: Cell) -> str | None:
    """The background colour of an empty half."""
    if _is_in(scene, cell, scene.region):
        return palette.blend(palette.colour_of(scene.record.subgoals - 1), _DARK)
    return _TARGET if _is_in(scene, cell, scene.task.silhouette) else None


def _is_in(scene: Scene, cell: Cell, mask: int) -> bool:
    board = scene.task.board
    return cell[1] < board.height and bool(mask >> board.bit(*cell) & 1)
