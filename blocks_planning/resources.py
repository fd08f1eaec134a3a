"""Location of the files that ship with the package: in the checkout, or under ``share/``."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path

_PACKAGE = Path(__file__).resolve().parent
_PREFIX_LEVELS = 4
"""Levels to search upwards: a package is in ``PREFIX``, in ``PREFIX/Lib/site-packages`` or in
``PREFIX/lib/pythonX.Y/site-packages``."""


def resource_directories(kind: str) -> Iterator[Path]:
    """The existing directories of one kind ('stimuli', 'config'), in order of precedence.

    A checkout (also one that is installed in editable mode) comes before the prefixes of
    ``AMENT_PREFIX_PATH`` (a ROS workspace), that before the folder that this package was installed
    into (also with ``pip install --user`` or ``--target``), and that before ``sys.prefix``.
    """
    prefixes: list[str | Path] = [
        *filter(None, os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep)),
        *_PACKAGE.parents[:_PREFIX_LEVELS],
        sys.prefix,
    ]
    candidates = [
        _PACKAGE.parent / kind,
        *(Path(prefix) / 'share' / _PACKAGE.name / kind for prefix in prefixes),
    ]
    return (candidate for candidate in dict.fromkeys(candidates) if candidate.is_dir())
