"""How every kernel of the package is compiled."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba

_PACKAGE = Path(__file__).resolve().parents[2]


def _sources() -> list[Path]:
    """The files whose text decides what the kernels do."""
    return [*sorted(_PACKAGE.glob('*/kernels/*.py')), _PACKAGE / 'search' / 'randomness.py']


def _cache_directory() -> str:
    """A folder of its own for every state of the sources.

    numba looks at the file of a kernel only, and would go on using a kernel whose callees, in
    other files, have changed. The folder is below NUMBA_CACHE_DIR if that is set, else beside the
    package, else below the user's cache folder.
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


# Without the runtime that counts references: every array of every tuple that a kernel is handed
# would be counted up and down for each use, which takes longer than the search itself. So a
# kernel makes no arrays; its caller keeps those it hands over alive.
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
    """A part of kernels that is compiled into each caller: for what runs once per state.

    A call would pass every array of its arguments as seven numbers.
    """
    return numba.njit(forceinline=True, **_OPTIONS)(function)
