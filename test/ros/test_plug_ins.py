"""Plug-ins of another distribution, in every process of a graph."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
from graphs import local_lines, record_lines, run_graph, write_script

from blocks_planning.search.searches import SEARCHES
from blocks_planning.subgoals.registry import STRATEGIES

PLUG_INS = '''\
"""A search and a strategy."""

from dataclasses import dataclass

from blocks_planning.search.searches import BreadthFirst
from blocks_planning.settings import setting
from blocks_planning.subgoals.scoping import Scoping


@dataclass(frozen=True)
class Patient(BreadthFirst):
    """Looks ahead, and takes its time."""

    name = 'patient'
    patience: float = setting(1.5, 'How long it waits.', least=0, unit='s')
    mood: str = setting('calm', 'How it feels.', choices=('calm', 'cross'))


@dataclass(frozen=True)
class Bold(Scoping):
    """Scopes boldly."""

    name = 'bold'
    courage: int = setting(3, 'How bold it is.', least=1, most=9)
    loud: bool = setting(False, 'Whether it shouts.')
'''
ENTRY_POINTS = """\
[blocks_planning.searches]
patient = graph_plug_ins:Patient
[blocks_planning.strategies]
bold = graph_plug_ins:Bold
"""


@pytest.fixture
def installed(tmp_path: Path) -> Path:
    """A folder that holds an installed distribution with two plug-ins."""
    folder = tmp_path / 'installed'
    info = folder / 'graph_plug_ins-1.0.dist-info'
    info.mkdir(parents=True)
    (info / 'METADATA').write_text('Metadata-Version: 2.1\nName: graph-plug-ins\nVersion: 1.0\n')
    (info / 'entry_points.txt').write_text(ENTRY_POINTS)
    (folder / 'graph_plug_ins.py').write_text(PLUG_INS)
    return folder


@pytest.mark.long
def test_graph_runs_records_and_verifies_them(
    installed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_script(
        tmp_path,
        searches=[{'name': 'patient', 'patience': 2.5, 'mood': 'cross', 'depth': 2}],
        strategies=[{'name': 'bold', 'courage': 7, 'loud': True, 'lambda': 0.25}],
    )
    environment = {**os.environ, 'PYTHONPATH': str(installed)}
    out, bag = tmp_path / 'out', tmp_path / 'bag'
    done = run_graph(path, '--out', out, '--bag', bag, environment=environment)
    assert done.returncode in (0, 1), done.stderr
    assert 'courage 7, loud' in ' '.join(done.stdout.split())
    for recorded in (bag, out / 'trials.jsonl'):
        command = [sys.executable, '-m', 'blocks_planning.cli', 'verify', str(recorded)]
        verified = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert verified.stdout.endswith('all consistent\n'), verified.stderr

    monkeypatch.syspath_prepend(installed)
    monkeypatch.delitem(sys.modules, 'graph_plug_ins', raising=False)
    plug_ins = importlib.import_module('graph_plug_ins')
    with SEARCHES.added(plug_ins.Patient), STRATEGIES.added(plug_ins.Bold):
        assert record_lines(out) == local_lines(path)
