"""Compilation of all kernels of the package."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

_PACKAGE = Path(__file__).resolve().parents[2]


def _sources() -> list[Path]:
    """The source files of all kernels."""
    return [*sorted(_PACKAGE.glob('*/kernels/*.py')), _PACKAGE / 'search' / 'randomness.py']


def _cache_directory() -> str:
    """A cache folder that is specific to the state of the sources.

    numba checks only the file of a kernel, and would keep using a kernel whose callees in other
    files have changed. The folder is below NUMBA_CACHE_DIR if that is set, otherwise beside the
    package, or below the user's cache folder.
    """
    digest = hashlib.sha256(b''.join(path.read_bytes() for path in _sources())).hexdigest()[:12]
    base = _PACKAGE / '__pycache__'
    if numba.config.CACHE_DIR:
        base = Path(numba.config.CACHE_DIR)
    elif not os.access(_PACKAGE, os.W_OK):
        home = os.environ.get('XDG_CACHE_HOME') or Path.home() / '.cache'
        base = Path(home) / 'blocks_planning'
    return str(base / f'kernels-{digest}')


_CACHE_DIRECTORY = _cache_directory()


# Without reference counts: counting every array of every tuple for each use would take longer than
# the search itself. So a kernel creates no arrays, and its caller keeps the arguments alive.
_OPTIONS = {'nogil': True, 'error_model': 'numpy', '_nrt': False}


def kernel(function: Callable[..., Any]) -> Any:
    """Compile a function on its first call, once per machine; it runs without the GIL."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = _CACHE_DIRECTORY
    try:
        return numba.njit(cache=True, **_OPTIONS)(function)
    finally:
        numba.config.CACHE_DIR = before


def inlined(function: Callable[..., Any]) -> Any:
    """Compile a function into each calling kernel: for code that runs once per state.

    A call would pass every array of its arguments as seven numbers.
    """
    return numba.njit(forceinline=True, **_OPTIONS)(function)
