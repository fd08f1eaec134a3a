"""The command in this process; no lines on progress, which depend on how busy the machine is."""

from __future__ import annotations

import sys
from math import inf
from pathlib import Path

import pytest
from builders import CHAIR, FRAME
from command import Done, Run, draw_towers

from blocks_planning.cli import main, progress


@pytest.fixture(autouse=True)
def _no_lines_on_progress(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if request.path.name != 'test_progress.py':
        monkeypatch.setattr(progress, 'FIRST_LINE_S', inf)


@pytest.fixture
def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Run:
    """Calls the command in this process, in a terminal of 80 columns."""
    monkeypatch.setenv('COLUMNS', '80')

    def call(*arguments: object) -> Done:
        monkeypatch.setattr(sys, 'argv', ['blocks-planning', *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return Done(ended.value.code or 0, *capsys.readouterr())

    return call


@pytest.fixture
def towers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A file with small towers, in the working directory."""
    monkeypatch.chdir(tmp_path)
    draw_towers(tmp_path / 'towers.txt', chair=CHAIR, frame=FRAME, square='##/##')
    return 'towers.txt'
