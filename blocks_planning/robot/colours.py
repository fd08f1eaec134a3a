"""The colours by which the camera distinguishes blocks.

Each block has its own colour, and all of them are saturated. Table, arm and sky are grey, so a grey
pixel is never mistaken for a block.
"""

from __future__ import annotations

import colorsys
from functools import lru_cache

HUES = 16
SHADES = ((0.95, 0.95), (0.95, 0.6), (0.45, 1.0), (0.5, 0.6))
"""Saturation and brightness; with the hues 64 colours, then they repeat."""
COUNT = HUES * len(SHADES)


@lru_cache(maxsize=COUNT)
def _nth(index: int) -> tuple[int, int, int]:
    # 7 and 16 have no common factor, so successive numbers have very different hues.
    hue = (7 * index) % HUES / HUES
    saturation, brightness = SHADES[index // HUES]
    red, green, blue = colorsys.hsv_to_rgb(hue, saturation, brightness)
    return round(255 * red), round(255 * green), round(255 * blue)


def colour_of(number: int) -> tuple[int, int, int]:
    """The colour of a block by its number, each level 0 to 255."""
    return _nth(number % COUNT)
