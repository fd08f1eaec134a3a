"""What the documentation tells a reader to type works, in the order in which it says so."""

from __future__ import annotations

import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest
from source_imports import ROOT


class Listing(NamedTuple):
    """A listing of a document: what kind it is, which file it is, and its text."""

    kind: str
    file: str | None
    text: str


def listings(path: Path) -> list[Listing]:
    found = re.findall(r'^```(\w+)(?: file=(\S+))?\n(.*?)^```$', path.read_text(), re.M | re.S)
    return [Listing(kind, file or None, text) for kind, file, text in found]


def run(command: list[str], folder: Path) -> str:
    environment = os.environ | {'PYTHONPATH': f'{folder}{os.pathsep}{ROOT}'}
    done = subprocess.run(
        [sys.executable, *command], cwd=folder, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.long
def test_own_towers_can_be_followed(tmp_path: Path) -> None:
    program = []
    for listing in listings(ROOT / 'docs' / 'own_towers.md'):
        if listing.file:
            (tmp_path / listing.file).write_text(listing.text)
        elif listing.kind == 'bash':
            for line in listing.text.splitlines():
                name, *words = shlex.split(line)
                assert name == 'blocks-planning'
                run(['-m', 'blocks_planning.cli', *words], tmp_path)
        else:
            assert listing.kind == 'python'
            program.append(listing.text)
    assert len(program) == 5
    said = run(['-c', '\n'.join(program)], tmp_path)
    assert re.search(r'success \d\.\d\d \[\d', said)
    assert 'stairs' in said


def test_page_about_python_can_be_followed(tmp_path: Path) -> None:
    blocks = [listing.text for listing in listings(ROOT / 'docs' / 'python.md')]
    said = run(['-c', '\n'.join(blocks)], tmp_path)
    assert 'chosen: ' in said
    assert (tmp_path / 'arch.gif').stat().st_size > 1000


@pytest.mark.long
def test_notebook_can_be_run(tmp_path: Path) -> None:
    notebook = json.loads((ROOT / 'docs' / 'scoping.ipynb').read_text(encoding='utf-8'))
    cells = [''.join(cell['source']) for cell in notebook['cells'] if cell['cell_type'] == 'code']
    assert all(not cell['outputs'] for cell in notebook['cells'] if 'outputs' in cell)
    program = ['import matplotlib', "matplotlib.use('agg')", *cells]
    assert len(cells) == 5
    run(['-c', '\n'.join(program)], tmp_path)


@pytest.mark.parametrize('path', sorted((ROOT / 'docs').glob('*.md')), ids=lambda path: path.name)
def test_commands_of_documents_exist(path: Path) -> None:
    from blocks_planning.cli import commands

    named = set(re.findall(r'blocks-planning ([a-z][a-z-]*)', path.read_text()))
    assert named <= set(commands.commands)


def install_plug_in(folder: Path) -> list[Listing]:
    """Write the package of docs/plug_ins.md, as installed; return the other listings."""
    others = []
    for listing in listings(ROOT / 'docs' / 'plug_ins.md'):
        if listing.file:
            (folder / listing.file).write_text(listing.text)
        else:
            others.append(listing)
    points = re.findall(
        r"^\[project\.entry-points\.'(\S+)'\]\n(\w+ = )'(\S+)'$",
        (folder / 'pyproject.toml').read_text(),
        re.M,
    )
    info = folder / 'my_planners-1.0.dist-info'
    info.mkdir()
    (info / 'METADATA').write_text('Metadata-Version: 2.1\nName: my-planners\nVersion: 1.0\n')
    lines = [f'[{group}]\n{name}{place}\n' for group, name, place in points]
    assert len(lines) == 2
    (info / 'entry_points.txt').write_text(''.join(lines))
    return others


def test_page_about_plug_ins_can_be_followed(tmp_path: Path) -> None:
    python, bash = install_plug_in(tmp_path)
    assert (python.kind, bash.kind) == ('python', 'bash')
    assert len(listed_lines(tmp_path / 'my_planners.py')) < 60
    run(['-c', python.text], tmp_path)
    solving, verifying = bash.text.splitlines()
    command, _, file = solving.partition(' > ')
    said = run(['-m', 'blocks_planning.cli', *shlex.split(command)[1:]], tmp_path)
    (tmp_path / file).write_text(said)
    record = json.loads(said)
    assert (record['strategy'], record['search']) == ('thrifty', 'largest_first')
    assert record['status'] == 'success'
    said = run(['-m', 'blocks_planning.cli', *shlex.split(verifying)[1:]], tmp_path)
    assert said.endswith('all consistent\n')


def listed_lines(path: Path) -> list[str]:
    return [line for line in path.read_text().splitlines() if line.strip()]
