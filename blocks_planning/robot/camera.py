"""Blocks in the picture of the front camera, which is segmented by colour.

The camera looks along y without perspective and shows only the board. A block in front of the board
hides the cells behind it, and counts as a part of the board.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from blocks_planning.robot.colours import colour_of
from blocks_planning.robot.coverage import Coverage, Sighting
from blocks_planning.robot.rendering import Painter, Pixels
from blocks_planning.robot.scene import FRONT_CAMERA, PIXELS_PER_CELL, Body
from blocks_planning.robot.simulation import Simulation

MOST_OFF = 20.0
"""Tolerance of the colour of a pixel [levels]; the two nearest block colours differ by 21."""


class Camera:
    """Takes pictures of the board and finds blocks in them.

    Raises:
        ConfigurationError: if this machine cannot render.
    """

    def __init__(self, simulation: Simulation) -> None:
        """Set the camera up."""
        self._painter = Painter(simulation)
        self._board = simulation.sizes.board

    def picture(self) -> Pixels:
        """The current picture of the camera."""
        side = PIXELS_PER_CELL
        return self._painter.paint(
            FRONT_CAMERA, side * self._board.width, side * self._board.height
        )

    def see(self, bodies: Iterable[Body]) -> list[Sighting]:
        """Sightings of those blocks that are in the picture, and of the others as off the board."""
        looked_for = list(bodies)
        shares = coverages(self.picture(), [body.number for body in looked_for])
        return [
            Sighting(body.number, body.block, coverage, is_off_plane=not coverage)
            for body, coverage in zip(looked_for, shares, strict=True)
        ]


def coverages(pixels: Pixels, numbers: Sequence[int]) -> list[Coverage]:
    """The cells that each block covers in a picture.

    Args:
        pixels: of the board, ``PIXELS_PER_CELL`` for each cell.
        numbers: of the blocks to look for.
    """
    if not numbers:
        return []
    palette = np.array([colour_of(number) for number in numbers], np.float64)
    away = np.linalg.norm(pixels[:, :, None, :] - palette, axis=3)
    nearest = np.where(away.min(axis=2) <= MOST_OFF, away.argmin(axis=2), -1)
    return [_coverage(nearest == index) for index in range(len(numbers))]


def _coverage(shown: np.ndarray[tuple[int, int], np.dtype[np.bool_]]) -> Coverage:
    """Shares of the cells in a boolean picture, top row first."""
    side = PIXELS_PER_CELL
    rows, columns = shown.shape[0] // side, shown.shape[1] // side
    shares = shown.reshape(rows, side, columns, side).mean(axis=(1, 3))
    return {
        (column, rows - 1 - line): float(shares[line, column])
        for line in range(rows)
        for column in range(columns)
        if shares[line, column] > 0
    }
