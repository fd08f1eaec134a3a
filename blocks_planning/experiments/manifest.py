"""The manifest of a sweep: versions, revision of the sources, and machine."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
from importlib import metadata
from pathlib import Path
from typing import Any

from blocks_planning import __version__

_LIBRARIES = ('numpy', 'numba', 'pandas', 'pyarrow', 'scipy', 'joblib', 'distributed')


def provenance() -> dict[str, Any]:
    """Versions, revision and machine of this process."""
    return {
        'blocks_planning': __version__,
        'git_revision': _git_revision(),
        'python': sys.version.split()[0],
        'libraries': {name: _version(name) for name in _LIBRARIES},
        'machine': {
            'system': platform.platform(),
            'processor': _processor(),
            'processors': os.cpu_count(),
        },
    }


def _version(name: str) -> str | None:
    try:
        return metadata.version(name)
    except metadata.PackageNotFoundError:
        return None


def _git_revision() -> str | None:
    """The commit of the checkout of this package, followed by '+' if files differ from it."""
    folder = Path(__file__).resolve().parents[2]
    if not (folder / '.git').exists():
        return None
    try:
        revision = _git(folder, 'rev-parse', 'HEAD')
        return revision + '+' * bool(_git(folder, 'status', '--porcelain'))
    except (OSError, subprocess.SubprocessError):
        return None


def _git(folder: Path, *words: str) -> str:
    command = ['git', '-C', str(folder), *words]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=10)
    return done.stdout.strip()


def _processor() -> str:
    try:
        lines = Path('/proc/cpuinfo').read_text(encoding='utf-8').splitlines()
    except OSError:
        return platform.processor()
    names = [line.partition(':')[2].strip() for line in lines if line.startswith('model name')]
    return names[0] if names else platform.processor()
