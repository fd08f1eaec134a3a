"""The colours and signs of everything that is drawn.

A colour represents a subgoal of the trial; tints and edges distinguish touching blocks of one
subgoal. No information is in the colour alone: in a terminal the kind of line also changes with the
subgoal.

The hues are those of Okabe and Ito (2008), *Color Universal Design*, without black and with a
darker yellow, so that each is visible on a dark and on a light background. They are ordered so that
consecutive subgoals, which touch each other, differ most for colour-blind people.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import NamedTuple

from blocks_planning.view.scene import BuiltBlock

COLOURS = ('#56b4e9', '#e69f00', '#009e73', '#d55e00', '#cc79a7', '#ccb800', '#0072b2')
"""One colour for each subgoal, repeated cyclically."""

FOUND_COLOUR = '#9e9e9e'
"""Colour of blocks that stood at the start, or appeared by themselves."""

TINTS = (0.0, 0.4, -0.22, -0.42)
"""Shares of white (above 0) or black (below 0) in tints."""

GOOD, BAD = '#009e73', '#d55e00'
"""Colours of the end of a trial; a word always shows it too."""


def blend(colour: str, share: float) -> str:
    """A colour mixed with white by a share from 0 to 1, or with black by a share from 0 to -1.

    >>> blend('#0072b2', 0.5)
    '#80b8d8'
    """
    goal = 255 if share > 0 else 0
    return '#' + ''.join(
        f'{round(level + (goal - level) * abs(share)):02x}'
        for level in bytes.fromhex(colour.removeprefix('#'))
    )


def colour_of(subgoal: int) -> str:
    """The colour of a subgoal, as '#rrggbb'; grey for blocks that no subgoal placed."""
    return COLOURS[subgoal % len(COLOURS)] if subgoal >= 0 else FOUND_COLOUR


def ink_on(colour: str) -> str:
    """Black or white, whichever is more legible on a colour (relative luminance of WCAG 2)."""
    levels = (level / 255 for level in bytes.fromhex(colour.removeprefix('#')))
    linear = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in levels]
    luminance = sum(map(float.__mul__, (0.2126, 0.7152, 0.0722), linear))
    return '#000000' if (luminance + 0.05) ** 2 > 1.05 * 0.05 else '#ffffff'


def fills_of(blocks: Sequence[BuiltBlock]) -> list[str]:
    """The colour of each block, as '#rrggbb'.

    A block keeps its colour when more are placed. Touching blocks of one subgoal get different
    tints, if there are enough.
    """
    tints: list[int] = []
    for index, block in enumerate(blocks):
        around = Counter(
            tint
            for other, tint in zip(blocks[:index], tints, strict=True)
            if colour_of(other.subgoal) == colour_of(block.subgoal) and _touch(block, other)
        )
        tints.append(min(range(len(TINTS)), key=around.__getitem__))
    return [
        blend(colour_of(block.subgoal), TINTS[tint])
        for block, tint in zip(blocks, tints, strict=True)
    ]


def _touch(one: BuiltBlock, other: BuiltBlock) -> bool:
    """Whether two blocks share a part of an edge."""
    a, b = one.placed, other.placed
    across = min(a.column + a.width, b.column + b.width) - max(a.column, b.column)
    upright = min(a.row + a.height, b.row + b.height) - max(a.row, b.row)
    return min(across, upright) == 0 < max(across, upright)


class Frame(NamedTuple):
    """The characters of a block's edge.

    Attributes:
        box: 3 x 3 characters, row by row from the top left corner.
        flat: 3 characters, for a block that is one line high.
    """

    box: str
    flat: str

    def at(self, x: int, y: int, width: int, height: int) -> str:
        """The character at (x, y) of a block of ``width`` x ``height`` characters, y downwards."""
        column = 0 if x == 0 else 2 if x == width - 1 else 1
        if height == 1:
            return self.flat[column]
        return self.box[3 * (0 if y == 0 else 2 if y == height - 1 else 1) + column]


class Signs(NamedTuple):
    """The characters of a terminal.

    Attributes:
        frames: of blocks; consecutive subgoals have different ones.
        target: a cell of the silhouette that is not filled.
        region: such a cell, if the current subgoal fills it.
        halves: of a compact board: the upper half filled, the lower half, both.
        ground: below the board.
        marker: the candidate that was chosen.
        more: marks an omission.
        encoding: of the terminal.
    """

    frames: tuple[Frame, ...]
    target: str
    region: str
    halves: str
    ground: str
    marker: str
    more: str
    encoding: str

    def shown(self, text: str) -> str:
        """A text on one line, with '?' for every character that can't be shown."""
        printable = ''.join(sign if sign.isprintable() else '?' for sign in text)
        return printable.encode(self.encoding, 'replace').decode(self.encoding)


UNICODE = Signs(
    frames=(
        Frame('┌─┐│ │└─┘', '[─]'),
        Frame('╔═╗║ ║╚═╝', '[═]'),
        Frame('┏━┓┃ ┃┗━┛', '[━]'),
    ),
    target='░',
    region='▒',
    halves='▀▄█',
    ground='▔',
    marker='▶',
    more='…',
    encoding='utf-8',
)

ASCII = Signs(
    frames=(
        Frame('+-+| |+-+', '[-]'),
        Frame('#=#H H#=#', '[=]'),
        Frame('o~o! !o~o', '[~]'),
    ),
    target='.',
    region=':',
    halves='^_#',
    ground='"',
    marker='>',
    more='~',
    encoding='ascii',
)
