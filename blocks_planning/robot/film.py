"""Films of the arm and the tower, as GIF, optionally with other pictures beside them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from blocks_planning.errors import ConfigurationError
from blocks_planning.extras import extra
from blocks_planning.robot.phases import Progress
from blocks_planning.robot.rendering import Painter
from blocks_planning.robot.robot import Robot
from blocks_planning.robot.scene import FILM_CAMERA

with extra('figures'):
    from PIL import Image

WIDTH, HEIGHT = 440, 400
"""Size of a frame without the pictures beside it [pixels]."""
EVERY_S = 0.3
"""Time between two frames, in simulated time [s]."""
FRAME_MS = 60
LAST_FRAME_MS = 3000
PAPER = 'white'
COLOURS = 128


@dataclass
class Film:
    """Collects frames while a robot works.

    Raises:
        ConfigurationError: if this machine cannot render.

    Attributes:
        robot: the robot.
        every: time between two frames, in simulated time [s].
        frames: pictures, each with the number of finished acts.
    """

    robot: Robot
    every: float = EVERY_S
    frames: list[tuple[Image.Image, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._painter = Painter(self.robot.simulation)
        self._next = 0.0
        self._acts = 0

    def watch(self, progress: Progress) -> None:
        """Take a frame if one is due; to be called after every step."""
        is_over = progress.report is not None
        self._acts += is_over
        if progress.time >= self._next or is_over:
            self._next = progress.time + self.every
            pixels = self._painter.paint(FILM_CAMERA, WIDTH, HEIGHT)
            self.frames.append((Image.fromarray(pixels), self._acts))

    def save(self, path: Path, beside: Sequence[Image.Image] = ()) -> None:
        """Write the film as a GIF.

        Args:
            path: of the file.
            beside: pictures on the right: the first one until the end of the first act, the next
                until the end of the second, and so on; the last one stays.

        Raises:
            ConfigurationError: if the suffix is not .gif, nothing was filmed, or the file can't
                be written.
        """
        if path.suffix.lower() != '.gif' or not self.frames:
            raise ConfigurationError(
                f'{path}: a film must be a .gif with at least one frame, got {len(self.frames)} frames'
            )
        whole = [_join(frame, _at(beside, acts)) for frame, acts in self.frames]
        palette = whole[-1].quantize(COLOURS)
        images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in whole]
        durations = [FRAME_MS] * (len(images) - 1) + [LAST_FRAME_MS]
        try:
            images[0].save(
                path, 'GIF', save_all=True, append_images=images[1:], duration=durations, loop=0
            )
        except OSError as error:
            raise ConfigurationError(f'{path}: cannot be written: {error.strerror}') from None

    def close(self) -> None:
        """Release the rendering context."""
        self._painter.close()


def _at(pictures: Sequence[Image.Image], index: int) -> Image.Image | None:
    return pictures[min(index, len(pictures) - 1)] if pictures else None


def _join(left: Image.Image, right: Image.Image | None) -> Image.Image:
    """Two pictures side by side, the right one in the height of the left one."""
    if right is None:
        return left
    width = round(right.width * left.height / right.height)
    joined = Image.new('RGB', (left.width + width, left.height), PAPER)
    joined.paste(left, (0, 0))
    joined.paste(right.convert('RGB').resize((width, left.height)), (left.width, 0))
    return joined
