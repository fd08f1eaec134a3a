"""Read what the project declares that it needs: in setup.py, in the lists and in the locks."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import pytest
import setuptools
from source_imports import ROOT

REQUIREMENTS = ROOT / 'requirements'
LOCKS = sorted(REQUIREMENTS.glob('lock*.txt'))
# Module: distribution on the package index, key of rosdep. A module of ROS is named like its
# ROS package, and its wheel like that with ros- before it. rosdep has no key for some.
NAMES: dict[str, tuple[str, str | None]] = {
    'PIL': ('pillow', 'python3-pil'),
    'aiohttp': ('aiohttp', 'python3-aiohttp'),
    'click': ('click', 'python3-click'),
    'dask': ('distributed', None),
    'jinja2': ('jinja2', 'python3-jinja2'),
    'joblib': ('joblib', 'python3-joblib'),
    'matplotlib': ('matplotlib', 'python3-matplotlib'),
    # rosdep knows it only as a dependency of another.
    'mcap': ('mcap', 'mcap-ros2-support'),
    'mujoco': ('mujoco', None),
    'numba': ('numba', 'python3-numba'),
    'numpy': ('numpy', 'python3-numpy'),
    'pandas': ('pandas', 'python3-pandas'),
    'portalocker': ('portalocker', None),
    'pyarrow': ('pyarrow', None),
    'rich': ('rich', 'python3-rich'),
    'rosbags': ('rosbags', 'python3-rosbags-pip'),
    'scipy': ('scipy', 'python3-scipy'),
    'yaml': ('pyyaml', 'python3-yaml'),
}


def canonical(requirement: str) -> str:
    """Return the name in a requirement, in the one spelling that an index compares."""
    found = re.match(r'[A-Za-z0-9._-]+', requirement)
    assert found, requirement
    return re.sub(r'[-_.]+', '-', found.group()).lower()


def pins(*paths: Path) -> dict[str, set[str]]:
    """Read the exact versions in lists of requirements; there may be several by marker."""
    found: dict[str, set[str]] = {}
    for path in paths:
        for line in path.read_text(encoding='utf-8').splitlines():
            requirement = line.partition('#')[0].rstrip(' \\')
            if requirement and not requirement.startswith(' '):
                name, _, version = requirement.partition(';')[0].partition('==')
                found.setdefault(canonical(name), set()).add(version.strip())
    return found


def setup_arguments() -> dict[str, Any]:
    """What setup.py says to setuptools."""
    said: dict[str, Any] = {}
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(setuptools, 'setup', said.update)
        patch.chdir(ROOT)
        runpy.run_path('setup.py')
    return said
