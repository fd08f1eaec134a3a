"""Films of the arm and the tower, as GIF, with pictures of something else beside them."""

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
"""Of a frame without what stands beside it [pixels]."""
EVERY_S = 0.3
"""Between two frames, in the time of the simulation [s]."""
FRAME_MS = 60
LAST_FRAME_MS = 3000
PAPER = 'white'
COLOURS = 128


@dataclass
class Film:
    """Collects frames while a robot works.

    Raises:
        ConfigurationError: if nothing can be drawn on this machine.

    Attributes:
        robot: what is filmed.
        every: between two frames, in the time of the simulation [s].
        frames: pictures, each with the number of acts that were over.
    """

    robot: Robot
    every: float = EVERY_S
    frames: list[tuple[Image.Image, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._painter = Painter(self.robot.simulation)
        self._next = 0.0
        self._acts = 0

    def watch(self, progress: Progress) -> None:
        """Take a frame if it is time; to be called after every tick."""
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
            beside: what to show on the right: the first before any act is over, the next after
                the first, and so on; the last one stays.

        Raises:
            ConfigurationError: if the suffix is not .gif, nothing was filmed, or the file can't
                be written.
        """
        if path.suffix.lower() != '.gif' or not self.frames:
            raise ConfigurationError(
                f'{path}: a film is a .gif of at least one frame, there are {len(self.frames)}'
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
        """Give back what was needed for drawing."""
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
