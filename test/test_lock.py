"""The locks hold exactly what the lists and setup.py name, each file with its hash."""

from __future__ import annotations

import re
import runpy
from pathlib import Path
from typing import Any

import pytest
from declared import LOCKS, REQUIREMENTS, canonical, pins, setup_arguments
from source_imports import ROOT

LISTS = sorted(REQUIREMENTS.glob('*.in'))
WRITER: dict[str, Any] = runpy.run_path(str(REQUIREMENTS / 'lock.py'))
REQUIREMENT = re.compile(r'[a-z0-9-]+==[0-9][\w.+!]*( ; [\w.\'=<>!* ]+)? \\\n')
HASHES = re.compile(r'(    --hash=sha256:[0-9a-f]{64} \\\n)*    --hash=sha256:[0-9a-f]{64}\n')


@pytest.mark.parametrize('path', LISTS, ids=lambda path: path.name)
def test_lock_holds_what_is_listed(path: Path) -> None:
    listed = pins(path)
    assert listed
    locked = pins(*LOCKS)
    assert {name: locked.get(name) for name in listed} == listed


def test_every_list_is_in_a_lock() -> None:
    assert set(WRITER['LOCKS']) == {path.name for path in LOCKS} == set(WRITER['HEADERS'])
    listed = sorted(name for lists in WRITER['LOCKS'].values() for name in lists)
    assert listed == sorted(path.stem for path in LISTS)


@pytest.mark.parametrize('lock', LOCKS, ids=lambda path: path.name)
def test_lock_is_exact_and_every_file_has_a_hash(lock: Path) -> None:
    text = lock.read_text(encoding='utf-8')
    blocks = WRITER['blocks'](text)
    assert ''.join(blocks) == ''.join(
        line for line in text.splitlines(keepends=True) if not line.startswith('#')
    )
    assert blocks
    for block in blocks:
        requirement, _, hashes = block.partition('\n')
        assert REQUIREMENT.fullmatch(f'{requirement}\n'), requirement
        assert HASHES.fullmatch(hashes), requirement


def test_no_package_is_in_two_locks() -> None:
    names = [name for lock in LOCKS for name in pins(lock)]
    assert sorted(set(names)) == sorted(names)


def test_the_demo_is_spared_what_only_development_needs() -> None:
    demo = pins(REQUIREMENTS / 'lock.txt')
    for path in LISTS:
        if path.stem in ('experiments', 'page', 'development'):
            assert set(pins(path)) & set(demo) == set(), path.name


@pytest.mark.parametrize('tier', ['runtime', 'experiments', 'figures', 'page', 'robot'])
def test_what_setup_asks_for_is_what_is_listed(tier: str) -> None:
    arguments = setup_arguments()
    asked = arguments['extras_require'].get(tier, arguments['install_requires'])
    assert sorted(map(canonical, asked)) == sorted(pins(REQUIREMENTS / f'{tier}.in'))


def test_messages_are_built_with_what_is_locked() -> None:
    # No tomllib before Python 3.11.
    text = (ROOT / 'msg_defs' / 'pyproject.toml').read_text(encoding='utf-8')
    pinned = re.findall(r"'([\w-]+)(?:\[\w+\])?==([\w.]+)'", text)
    locked = pins(*LOCKS)
    assert {name: locked.get(name) for name, _ in pinned} == {name: {pin} for name, pin in pinned}
    # pip alone finds these on the machine, or adds them by itself; the last two build the package.
    spared = {'cmake', 'ninja', 'setuptools', 'wheel'}
    assert set(pins(REQUIREMENTS / 'build.in')) - spared <= dict(pinned).keys()
