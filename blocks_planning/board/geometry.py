"""The coordinate convention, with a drawing. All other code uses this module.

Column 0 is left, row 0 is the ground, rows count upwards. A set of cells is a *mask*: an ``int``
in which cell (column, row) is bit ``column * height + row``, so the bits run up a column, then on
to the next one. On a board of width 3 and height 4::

    row 3 |  3  7 11        a mask                as text, top row first
    row 2 |  2  6 10        0b0001_0011_0001      ...
    row 1 |  1  5  9                              ...
    row 0 |  0  4  8                              .#.
          +---------                              ###
    column   0  1  2

With this order the lowest landing place of a mask is also the leftmost one, and "everything
below" is a shift inside a column.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

from blocks_planning.settings import check_whole

Mask: TypeAlias = int
Column: TypeAlias = int
Row: TypeAlias = int
Cell: TypeAlias = tuple[Column, Row]

MAX_SIDE = 16
"""Longest side of a board [cells]."""

FILLED, EMPTY = '#', '.'


@dataclass(frozen=True)
class Board:
    """The size of a board: ``width`` x ``height`` [cells], each 1 to 16.

    >>> board = Board(width=3, height=2)
    >>> mask = board.mask([(0, 0), (1, 0), (1, 1), (2, 0)])
    >>> bin(mask)
    '0b11101'
    >>> print(board.draw(mask))
    .#.
    ###

    Raises:
        ConfigurationError: if a side is not a whole number from 1 to 16.
    """

    width: int
    height: int

    def __post_init__(self) -> None:
        for name, side in (('width', self.width), ('height', self.height)):
            check_whole(f'board {name}', side, 1, MAX_SIDE)

    @property
    def size(self) -> int:
        """Number of cells."""
        return self.width * self.height

    @cached_property
    def full(self) -> Mask:
        """Every cell of the board."""
        return (1 << self.size) - 1

    @cached_property
    def ground(self) -> Mask:
        """The cells of row 0."""
        return sum(1 << (column * self.height) for column in range(self.width))

    def bit(self, column: Column, row: Row) -> int:
        """Index of a cell's bit. The cell must lie on the board."""
        return column * self.height + row

    def cell(self, bit: int) -> Cell:
        """The cell of a bit index."""
        return divmod(bit, self.height)

    def mask(self, cells: Iterable[Cell]) -> Mask:
        """The mask of some cells of the board."""
        mask = 0
        for column, row in cells:
            mask |= 1 << self.bit(column, row)
        return mask

    def cells(self, mask: Mask) -> Iterator[Cell]:
        """The cells of a mask, column by column from the left, each upwards."""
        while mask:
            lowest = mask & -mask
            yield self.cell(lowest.bit_length() - 1)
            mask ^= lowest

    def rows_below(self, height: Row) -> Mask:
        """All cells whose row is below ``height``, 0 <= height <= board height."""
        return self.ground * ((1 << height) - 1)

    def rectangle(self, column: Column, row: Row, width: int, height: int) -> Mask:
        """The cells of a rectangle that lies on the board, by its lower left cell."""
        first_cells = ((1 << (width * self.height)) - 1) // ((1 << self.height) - 1)
        return first_cells * ((1 << height) - 1) << self.bit(column, row)

    def rows_up_to(self, mask: Mask) -> int:
        """Number of rows from the ground up to the highest cell of a mask; 0 if it is empty."""
        column, folded = (1 << self.height) - 1, 0
        while mask:
            folded |= mask & column
            mask >>= self.height
        return folded.bit_length()

    def parse(self, rows: Sequence[str]) -> Mask:
        """The mask of a picture from :meth:`draw`, top row first; the text is not checked."""
        return self.mask(
            (column, self.height - 1 - line)
            for line, text in enumerate(rows)
            for column, character in enumerate(text)
            if character == FILLED
        )

    def draw(self, mask: Mask) -> str:
        """A picture of a mask: ``height`` lines of '#' and '.', top row first."""
        return '\n'.join(
            ''.join(
                FILLED if mask >> self.bit(column, row) & 1 else EMPTY
                for column in range(self.width)
            )
            for row in reversed(range(self.height))
        )


def area(mask: Mask) -> int:
    """Number of cells in a mask."""
    return mask.bit_count()
