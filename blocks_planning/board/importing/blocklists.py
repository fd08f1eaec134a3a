"""Lists of placed blocks: ``{"blocks": [{"x": 0, "y": 0, "width": 2, "height": 1}]}``."""

from __future__ import annotations

from typing import Any

from blocks_planning.board.geometry import MAX_SIDE
from blocks_planning.board.importing.cells import Cells
from blocks_planning.errors import StimulusError, shown

MAX_BLOCKS = 256
"""Most blocks of a tower: one for each cell of the largest board."""
MAX_COORDINATE = 10_000
_SIZES = ('width', 'height')


def is_block_list(value: Any) -> bool:
    """Whether a value has the key of a block list."""
    return isinstance(value, dict) and 'blocks' in value


def cells_of_blocks(value: dict[str, Any], y: str, place: str) -> Cells:
    """The cells that the blocks of a list fill.

    Args:
        value: with the key 'blocks'; other keys of the list and of its blocks, such as colours,
            are ignored.
        y: 'up' if y is the lowest row of a block, counted upwards; 'down' if it is its top row,
            counted downwards.
        place: where it comes from, for messages.

    Raises:
        StimulusError: naming place, key and value, for a block without one of its four keys, a
            value that is not a whole number in its range, or two blocks in one cell.
    """
    blocks = value['blocks']
    if not isinstance(blocks, list) or not 1 <= len(blocks) <= MAX_BLOCKS:
        raise StimulusError(
            f'{place}.blocks: expected a list of 1 to {MAX_BLOCKS} blocks, got {shown(blocks)}'
        )
    owner: dict[tuple[int, int], int] = {}
    for index, block in enumerate(blocks):
        where = f'{place}.blocks[{index}]'
        if not isinstance(block, dict):
            raise StimulusError(
                f'{where}: expected an object with x, y, width and height, got {shown(block)}'
            )
        x, top_or_bottom = (_number(block, key, where) for key in ('x', 'y'))
        width, height = (_number(block, key, where) for key in _SIZES)
        bottom = top_or_bottom if y == 'up' else -(top_or_bottom + height)
        for cell in ((x + i, bottom + j) for i in range(width) for j in range(height)):
            other = owner.setdefault(cell, index)
            if other != index:
                raise StimulusError(f'{where}: overlaps blocks[{other}]')
    return frozenset(owner)


def _number(block: dict[str, Any], key: str, where: str) -> int:
    """A coordinate or a size of a block."""
    if key not in block:
        raise StimulusError(f'{where}: missing key {key!r}')
    value = block[key]
    low, high = (1, MAX_SIDE) if key in _SIZES else (-MAX_COORDINATE, MAX_COORDINATE)
    whole = isinstance(value, (int, float)) and not isinstance(value, bool) and value % 1 == 0
    if not (whole and low <= value <= high):
        raise StimulusError(
            f'{where}.{key}: expected a whole number from {low} to {high}, got {shown(value)}'
        )
    return int(value)
