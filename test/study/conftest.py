"""A small study, and participants who go through it without a page."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from blocks_planning.study.desk import Desk
from blocks_planning.study.events import Moment
from blocks_planning.study.plan import StepKind
from blocks_planning.study.session import Session
from blocks_planning.study.spec import Study, read_study
from blocks_planning.subgoals.drawn import Refused

TOWERS = 'tower arch\n####\n####\n#..#\n#..#\n\ntower square\n####\n####\n'
STUDY = """\
title: Small
consent: May we?
instructions: [Look at the towers.]
conditions:
  - {{name: parts, mode: scoping, instructions: [Draw.], practice: ['{towers}/square']}}
  - {{name: hands, mode: building, time_limit_s: 60}}
towers: ['{towers}/arch', '{towers}/square']
library: 1x2,2x1,2x2,4x2
order: fixed
break_every: 3
debrief: Thank you.
"""


class Clock:
    """A clock that goes on when it is told to."""

    def __init__(self) -> None:
        self.s = 1000.0

    def __call__(self) -> Moment:
        return Moment(1.7e9 + self.s, self.s)


def session_of(desk: Desk) -> Session:
    """The session that is open."""
    assert desk.session is not None
    return desk.session


class Person:
    """A participant."""

    def __init__(self, session: Session) -> None:
        self.session = session

    def act(self, word: str, **fields: Any) -> Refused | None:
        """Do something, as a page sends it."""
        state = self.session.state
        fields = {'act': word, 'number': state.acts, 'step': state.step, **fields}
        return self.session.act(fields)

    def draw(self, word: str, rows: list[str], thinking_s: float = 1.0) -> Refused | None:
        """Say something about a region."""
        return self.act(word, region=rows, thinking_s=thinking_s)

    def place(self, block: int, column: int) -> Refused | None:
        """Place a block of the library."""
        return self.act('place', block=block, column=column, thinking_s=0.5)

    def whole(self) -> None:
        """Rebuild the tower of this step, whatever is asked for."""
        step, record = self.session.step, self.session.record
        assert step is not None
        assert step.trial is not None
        assert record is not None
        task = record.spec.task
        if 'build' in step.trial.condition.mode.wishes:
            self.draw('build', task.board.draw(task.silhouette).split('\n'))
        elif task.board.height == 4:
            for block, column in ((0, 0), (0, 3), (3, 0)):
                assert self.place(block, column) is None
        else:
            assert self.place(3, 0) is None

    def go_on(self) -> None:
        """Do what leads to the next step."""
        step, before = self.session.step, self.session.state.step
        assert step is not None
        if step.kind is StepKind.TRIAL and not self.session.state.is_ended:
            self.whole()
        if step.marks is not None:
            task = step.marks.spec.task
            self.draw('mark', task.board.draw(task.silhouette).split('\n'))
        word = 'agree' if step.kind is StepKind.CONSENT else 'next'
        assert self.act(word) is None
        assert self.session.state.step == before + 1

    def go_to(self, kind: StepKind, mode: str = '') -> None:
        """Go on up to a step of a kind."""
        while True:
            step = self.session.step
            assert step is not None
            if step.kind is kind and (
                not mode or (step.trial and step.trial.condition.mode.name == mode)
            ):
                return
            self.go_on()


@pytest.fixture
def study(tmp_path: Path) -> Study:
    """The study, read from its file."""
    towers, path = tmp_path / 'towers.txt', tmp_path / 'study.yaml'
    towers.write_text(TOWERS)
    path.write_text(STUDY.format(towers=towers))
    return read_study(path)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where the first participant's events are kept."""
    return tmp_path / 'out' / 'participants' / 'P01'


@pytest.fixture
def opened(study: Study, tmp_path: Path, clock: Clock) -> Iterator[Callable[[], Desk]]:
    """Opens the desk, again if it was open."""
    desks: list[Desk] = []

    def make() -> Desk:
        for desk in desks:
            desk.release()
        desks.append(Desk(study, tmp_path / 'out', clock))
        return desks[-1]

    yield make
    for desk in desks:
        desk.release()


@pytest.fixture
def person(opened: Callable[[], Desk]) -> Person:
    """The first participant, who has just been asked for consent."""
    desk = opened()
    desk.begin('P01')
    return Person(session_of(desk))
