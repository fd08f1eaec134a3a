"""Every length of the scene, from the size of a cell and of the board."""

from __future__ import annotations

from dataclasses import dataclass

from blocks_planning.board.blocks import Block
from blocks_planning.board.geometry import Board
from blocks_planning.robot.settings import RobotSettings


@dataclass(frozen=True)
class Sizes:
    """Lengths [m] in the frame of the board; the arm scales with the cell.

    The *tool* is the point between the pads of the two fingers. Both axes of the arm count in
    the frame of the board, so the tool is at (x, z) when the axes are.
    """

    board: Board
    cell: float
    gap: float

    @classmethod
    def of(cls, board: Board, settings: RobotSettings) -> Sizes:
        """The lengths for a board."""
        return cls(board, settings.cell_m, settings.gap_m)

    def half(self, block: Block) -> tuple[float, float, float]:
        """Half the sides of a block along x, y and z.

        Only width and depth are smaller than the cells. If the height were smaller too, two stacked
        low blocks would end below one high block, and a block across both would tilt.
        """
        return (
            (block.width * self.cell - self.gap) / 2,
            (self.cell - self.gap) / 2,
            block.height * self.cell / 2,
        )

    @property
    def middle(self) -> float:
        """y of the plane in which the arm moves and the blocks stand."""
        return self.cell / 2

    @property
    def below_top(self) -> float:
        """Distance from the top of a block down to the grip."""
        return 0.4 * self.cell

    @property
    def pad(self) -> tuple[float, float, float]:
        """Half the sides of the pad of a finger."""
        return 0.3 * self.cell, 0.1 * self.cell, 0.3 * self.cell

    @property
    def lowest(self) -> float:
        """Least z of the tool: the pads are just above the table."""
        return self.pad[2] + 0.05 * self.cell

    @property
    def open_gap(self) -> float:
        """Gap between an open finger and the face of the cell."""
        return 0.4 * self.cell

    @property
    def overclosing(self) -> float:
        """Distance of the set point of a closed finger inside the face of a block."""
        return 0.12 * self.cell

    @property
    def palm_above(self) -> float:
        """Distance from the tool up to the lower face of the palm."""
        return 0.75 * self.cell

    @property
    def clearance(self) -> float:
        """Least distance between the carried block and the tower."""
        return 0.5 * self.cell

    @property
    def rail(self) -> float:
        """z of the rail, high enough to carry a block over any tower."""
        return (2 * self.board.height + 4) * self.cell

    def feeder(self, block: Block) -> float:
        """x of the middle of a block that the feeder presents, left of the board."""
        return -(3 + block.width / 2) * self.cell

    @property
    def reach(self) -> tuple[float, float]:
        """Least and greatest x of the tool."""
        return -(4 + self.board.width) * self.cell, (self.board.width + 1) * self.cell

    def centre(self, column: int, width: int) -> float:
        """x of the middle of a block by its leftmost column."""
        return (column + width / 2) * self.cell
