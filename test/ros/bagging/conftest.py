"""Trials as they are said, a bag of them, one that is cut off, and the command."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bag_builders import SPECS, Said, add_all, open_bag, trial_said, write_bag

from blocks_planning.cli import main
from blocks_planning.trials.record import TrialRecord


@pytest.fixture(scope='module')
def trials() -> list[tuple[TrialRecord, list[Said]]]:
    return [trial_said(one) for one in SPECS]


@pytest.fixture(scope='module')
def said(trials: list[tuple[TrialRecord, list[Said]]]) -> list[Said]:
    return [one for _, messages in trials for one in messages]


@pytest.fixture(scope='module')
def bag(said: list[Said], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A finished bag of all trials."""
    return write_bag(tmp_path_factory.mktemp('bags') / 'bag', said, flush_after=9)


@pytest.fixture(scope='module')
def cut_file(said: list[Said], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a bag whose writer vanished."""
    path = tmp_path_factory.mktemp('cut') / 'bag'
    writer = open_bag(path)
    add_all(writer, said, flush_after=9)
    os.close(writer._lock)
    return path / 'bag_0.mcap'


@pytest.fixture
def cli(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Callable[..., Any]:
    """Calls the command in this process; returns exit code, stdout and stderr."""

    def call(*arguments: object) -> tuple[object, str, str]:
        monkeypatch.setattr(sys, 'argv', ['blocks-planning', *map(str, arguments)])
        with pytest.raises(SystemExit) as ended:
            main()
        return (ended.value.code or 0, *capsys.readouterr())

    return call
