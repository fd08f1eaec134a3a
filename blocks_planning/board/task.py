"""A task: a silhouette to build, and the blocks to build it from."""

from __future__ import annotations

from dataclasses import dataclass

from blocks_planning.board.blocks import PAPER_LIBRARY, Library, check_library
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.errors import InvalidInput


@dataclass(frozen=True)
class Task:
    """Rebuild ``silhouette`` on ``board`` with the blocks of ``library``.

    Raises:
        InvalidInput: if the silhouette has a cell off the board, or the library can't be used.
    """

    board: Board
    silhouette: Mask
    library: Library = PAPER_LIBRARY

    def __post_init__(self) -> None:
        if not 0 <= self.silhouette <= self.board.full:
            raise InvalidInput(
                f'silhouette {self.silhouette:#x} has cells off the board of '
                f'{self.board.width} x {self.board.height} cells'
            )
        check_library(self.library)

    def rows(self, height: int) -> Mask:
        """The target cells of the rows below ``height``: the region ``rows(k)`` of the paper."""
        return self.silhouette & self.board.rows_below(height)
