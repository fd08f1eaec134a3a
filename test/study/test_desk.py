"""The experimenter's desk, without a page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from blocks_planning.errors import ConfigurationError, RecordError
from blocks_planning.study.desk import Desk
from blocks_planning.study.folder import StudyFolder
from blocks_planning.study.plan import StepKind

from .conftest import Clock, Person, session_of


def test_a_participant_is_never_written_over(opened: Callable[[], Desk], tmp_path: Path) -> None:
    folder = tmp_path / 'out' / 'participants' / 'P01'
    desk = opened()
    desk.begin('P01')
    with pytest.raises(ConfigurationError, match="'P01' is open: close it first"):
        desk.begin('P02')
    desk.close()
    there = (folder / 'events.jsonl').read_bytes()
    with pytest.raises(ConfigurationError, match="'P01' has a folder already"):
        desk.begin('P01')
    assert (folder / 'events.jsonl').read_bytes() == there
    for code in ('', '../P02', 'P 2', 'x' * 33, '.'):
        with pytest.raises(ConfigurationError, match='participant must be a code'):
            desk.begin(code)
    desk.begin(desk.suggested())
    assert [one.participant[:2] for one in desk.standings()] == [('P01', 0), ('P02', 1)]


def test_a_closed_session_can_be_opened_again(opened: Callable[[], Desk]) -> None:
    desk = opened()
    desk.begin('P01')
    Person(session_of(desk)).go_to(StepKind.TRIAL)
    step = session_of(desk).state.step
    desk.close()
    desk = opened()
    assert desk.standings()[0].state.is_closed
    desk.reopen('P01')
    state = session_of(desk).state
    assert (state.step, state.is_closed) == (step, False)
    desk.close()
    with pytest.raises(ConfigurationError, match="no participant 'P02'"):
        desk.reopen('P02')


def test_the_file_of_another_study_is_refused(
    opened: Callable[[], Desk], tmp_path: Path, clock: Clock
) -> None:
    desk = opened()
    study = desk.study
    desk.release()
    with pytest.raises(ConfigurationError, match='holds another study'):
        Desk(replace(study, seed=1), tmp_path / 'out', clock)


def test_two_servers_do_not_share_a_folder(opened: Callable[[], Desk], tmp_path: Path) -> None:
    study = opened().study
    with pytest.raises(RecordError, match='another process is writing it'):
        StudyFolder(tmp_path / 'out', study, wait_s=0)
