"""Blocks, block libraries and placements.

A block library is an ordered tuple of different blocks with unlimited supply and no rotation.
The order is part of the task: searches generate children block by block in library order.
"""

from __future__ import annotations

import re
from typing import NamedTuple, TypeAlias

from blocks_planning.board.geometry import MAX_SIDE, Column, Row
from blocks_planning.errors import ConfigurationError, shown

MAX_BLOCKS = 64
"""Most blocks in a library."""


class Block(NamedTuple):
    """A rectangle, ``width`` x ``height`` [cells]."""

    width: int
    height: int

    @property
    def area(self) -> int:
        """Number of cells that the block fills."""
        return self.width * self.height

    def __str__(self) -> str:
        return f'{self.width}x{self.height}'


class Placement(NamedTuple):
    """The decision to drop a block with its leftmost cell in a column."""

    block: Block
    column: Column


class Placed(NamedTuple):
    """A block where it came to rest; ``column`` and ``row`` are those of its lower left cell."""

    width: int
    height: int
    column: Column
    row: Row

    @property
    def placement(self) -> Placement:
        """The decision that put it there."""
        return Placement(Block(self.width, self.height), self.column)


Library: TypeAlias = tuple[Block, ...]

PAPER_LIBRARY: Library = (Block(1, 2), Block(2, 1), Block(2, 2), Block(2, 4), Block(4, 2))
"""The library of Binder et al. (2021), section "Task"."""


def check_library(library: Library, origin: str = 'block library') -> Library:
    """Return the library if it can be used.

    Raises:
        ConfigurationError: if it is empty, too long, repeats a block, or has a block whose sides
            are not 1 to 16 cells; the message begins with ``origin``.
    """
    if not 1 <= len(library) <= MAX_BLOCKS:
        raise ConfigurationError(
            f'{origin}: a library has 1 to {MAX_BLOCKS} blocks, got {len(library)}'
        )
    for index, block in enumerate(library):
        if not all(1 <= side <= MAX_SIDE for side in block):
            raise ConfigurationError(
                f'{origin}: the sides of a block are 1 to {MAX_SIDE} cells, got {block}'
            )
        if block in library[:index]:
            raise ConfigurationError(f'{origin}: block {block} is listed twice')
    return library


def parse_library(text: str, origin: str = 'block library') -> Library:
    """Read a library such as ``'1x2,2x1,2x2'`` (width x height).

    >>> parse_library('1x2, 2x1')
    (Block(width=1, height=2), Block(width=2, height=1))

    Raises:
        ConfigurationError: if a block is not of the form WIDTHxHEIGHT, or the library can't be
            used (see :func:`check_library`).
    """
    blocks = []
    for item in text.split(','):
        match = re.fullmatch(r'\s*([0-9]{1,3})x([0-9]{1,3})\s*', item)
        if match is None:
            raise ConfigurationError(
                f'{origin}: expected blocks as WIDTHxHEIGHT between commas, such as 1x2,2x1, '
                f'got {shown(item.strip())}'
            )
        blocks.append(Block(int(match[1]), int(match[2])))
    return check_library(tuple(blocks), origin)


def format_library(library: Library) -> str:
    """The text that :func:`parse_library` reads."""
    return ','.join(map(str, library))
