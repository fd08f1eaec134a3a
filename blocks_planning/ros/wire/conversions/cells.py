"""Cells, blocks and placements.

The messages created here are cached and reused: they must not be changed.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import lru_cache

from blocks_planning_msgs import msg as ros

from blocks_planning.board import rules
from blocks_planning.board.blocks import Block, Placed
from blocks_planning.board.geometry import MAX_SIDE, Board, Mask
from blocks_planning.ros.wire.conversions.fields import bounded, refuse


@lru_cache(maxsize=4096)  # the same cells are sent again and again
def grid_to_ros(board: Board, mask: Mask) -> ros.Grid:
    """A mask as cells, row by row from the ground."""
    cells = bytearray(board.size)
    for column, row in board.cells(mask):
        cells[row * board.width + column] = 1
    return ros.Grid(width=board.width, height=board.height, cells=bytes(cells))


def grid_from_ros(grid: ros.Grid, field: str) -> tuple[Board, Mask]:
    """The board of a grid, and its mask."""
    for name in ('width', 'height'):
        side = getattr(grid, name)
        if not 1 <= side <= MAX_SIDE:
            raise refuse(f'{field}.{name}', side, f'1 to {MAX_SIDE} cells')
    board = Board(grid.width, grid.height)
    cells = bytes(grid.cells)
    if len(cells) != board.size:
        raise refuse(f'{field}.cells', len(cells), f'{board.size} cells')
    if cells.translate(None, b'\x00\x01'):
        raise refuse(f'{field}.cells', max(cells), '0 or 1 in each cell')
    return board, _mask_of(board, cells)


@lru_cache(maxsize=4096)
def _mask_of(board: Board, cells: bytes) -> Mask:
    places = (place for place, filled in enumerate(cells) if filled)
    return board.mask((place % board.width, place // board.width) for place in places)


def mask_on(board: Board, grid: ros.Grid, field: str) -> Mask:
    """The mask of a grid that must be of a board."""
    other, mask = grid_from_ros(grid, field)
    if other != board:
        raise refuse(
            field, f'{other.width} x {other.height}', f'{board.width} x {board.height} cells'
        )
    return mask


@lru_cache(maxsize=1 << 14)
def placed_to_ros(placed: Placed) -> ros.Placement:
    """A block where it lies."""
    return ros.Placement(
        block=block_to_ros(placed.placement.block),
        column=placed.column,
        row=placed.row,
    )


def block_from_ros(block: ros.Block, field: str) -> Block:
    """A block of a library."""
    for name in ('width', 'height'):
        side = getattr(block, name)
        if not 1 <= side <= MAX_SIDE:
            raise refuse(f'{field}.{name}', side, f'1 to {MAX_SIDE} cells')
    return Block(block.width, block.height)


@lru_cache(maxsize=MAX_SIDE * MAX_SIDE)
def block_to_ros(block: Block) -> ros.Block:
    """A block of a library."""
    return ros.Block(width=block.width, height=block.height)


def placed_from_ros(board: Board, message: ros.Placement, field: str) -> Placed:
    """A block that lies on the board; whether it can be placed there is not checked."""
    size, block = (board.width, board.height), message.block
    placed = _placed(*size, block.width, block.height, message.column, message.row)
    if placed is not None:
        return placed
    kind = block_from_ros(message.block, f'{field}.block')
    place = f'column {message.column}, row {message.row}'
    raise refuse(field, place, f'a place on the board for a block of {kind}')


@lru_cache(maxsize=1 << 14)  # the same blocks are sent again in every state
def _placed(
    columns: int, rows: int, width: int, height: int, column: int, row: int
) -> Placed | None:
    """A block in its place; None if that is not on a board of this size."""
    is_block = 1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE
    if is_block and column + width <= columns and row + height <= rows:
        return Placed(width, height, column, row)
    return None


def way_from_ros(
    board: Board, built: Mask, messages: Iterable[ros.Placement], field: str
) -> tuple[tuple[Placed, ...], Mask]:
    """Placements that can be carried out in order, and the state after them."""
    placements = []
    for index, message in enumerate(messages):
        placed = placed_from_ros(board, message, f'{field}[{index}]')
        rest = rules.drop(board, built, placed.placement)
        if rest != placed:
            expected = 'a possible placement' if rest is None else f'row {rest.row}'
            raise refuse(f'{field}[{index}].row', placed.row, expected)
        placements.append(placed)
        built |= rules.cells_of(board, placed)
    return tuple(placements), built


def blocks_from_ros(
    board: Board, messages: Sequence[ros.Placement], field: str
) -> tuple[Placed, ...]:
    """Blocks that lie on the board; whether they can be placed there is not checked."""
    bounded(messages, field, 0, board.size)
    return tuple(
        placed_from_ros(board, message, f'{field}[{index}]')
        for index, message in enumerate(messages)
    )


def blocks_to_ros(blocks: Iterable[Placed]) -> list[ros.Placement]:
    """Blocks where they lie."""
    return [placed_to_ros(placed) for placed in blocks]
