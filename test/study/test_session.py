"""A participant's session, without a page."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from blocks_planning.errors import RecordError
from blocks_planning.study import session
from blocks_planning.study.desk import Desk
from blocks_planning.study.events import EventKind
from blocks_planning.study.log import read_events
from blocks_planning.study.machine import Status
from blocks_planning.study.plan import StepKind
from blocks_planning.subgoals.drawn import MalformedProposal
from blocks_planning.trials.reading import record_from_json
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions, differs_from_rerun

from .conftest import Clock, Person, session_of

ARCH = ['####', '####', '#..#', '#..#']
LEGS = ['....', '....', '#..#', '#..#']


def kept(folder: Path, *kinds: EventKind) -> list[dict[str, Any]]:
    """The data of the events of some kinds, in order."""
    return [event.data for event in read_events(folder) if event.kind in kinds]


def records(folder: Path) -> list[TrialRecord]:
    found = kept(folder, EventKind.ENDED, EventKind.STOPPED)
    return [record_from_json(data['record'], 'event') for data in found if data['record']]


def test_a_session_from_consent_to_debrief(person: Person, folder: Path) -> None:
    session = person.session
    seen = []
    while session.step is not None:
        seen.append(session.step.kind.value)
        person.go_on()
    assert seen == [
        *('consent', 'text', 'text', 'trial', 'trial', 'trial'),
        *('trial', 'break', 'trial', 'debrief'),
    ]
    assert session.state.status is Status.FINISHED
    found = records(folder)
    assert [record.status for record in found] == [TrialStatus.SUCCESS] * 5
    assert len({record.spec.trial_id for record in found}) == 5
    for record in found:
        assert list(contradictions(record)) == []
        assert list(differs_from_rerun(record)) == []


def test_what_is_placed_stands_where_it_fell(person: Person, folder: Path) -> None:
    person.go_to(StepKind.TRIAL, 'building')
    assert person.place(0, 3) is None
    assert person.place(0, 0) is None
    record = person.session.record
    assert record is not None
    assert [tuple(placed) for placed in record.placements] == [(1, 2, 3, 0), (1, 2, 0, 0)]
    person.act('give_up', thinking_s=2.0)
    record = records(folder)[-1]
    assert record.status is TrialStatus.GAVE_UP
    assert list(contradictions(record)) + list(differs_from_rerun(record)) == []


@pytest.mark.parametrize(
    ('block', 'column', 'code'), [(3, 0, 'sticks_out'), (1, 3, 'no_room'), (2, 0, 'sticks_out')]
)
def test_a_block_outside_the_silhouette_is_refused_and_kept(
    person: Person, folder: Path, block: int, column: int, code: str
) -> None:
    person.go_to(StepKind.TRIAL, 'building')
    acts = person.session.state.acts
    refused = person.place(block, column)
    assert refused is not None
    assert refused.code == code
    assert person.session.state.acts == acts
    assert [one['code'] for one in kept(folder, EventKind.REFUSED)] == [code]


def test_regions_are_built_withdrawn_and_found_impossible(person: Person, folder: Path) -> None:
    person.go_to(StepKind.TRIAL)
    person.go_on()  # the practice tower
    assert person.draw('withdrawn', ARCH) is None
    assert person.draw('build', ['....', '....', '....', '#...']) is None
    assert person.draw('build', LEGS) is None
    refused = person.draw('build', LEGS)
    assert refused is not None
    assert refused.code == 'built'
    assert person.draw('build', ARCH) is None
    record = records(folder)[-1]
    assert [proposal.kind.value for proposal in record.proposals] == [
        *('withdrawn', 'build', 'build', 'build')
    ]
    assert record.status is TrialStatus.SUCCESS
    assert list(contradictions(record)) + list(differs_from_rerun(record)) == []


def test_proposals_in_one_state_are_limited(
    person: Person, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(session, 'MOST_PROPOSALS', 2)
    person.go_to(StepKind.TRIAL)
    person.go_on()  # the practice tower
    before = len(kept(folder, EventKind.PROPOSED))
    assert [person.draw('withdrawn', ARCH) for _ in range(2)] == [None, None]
    refused = person.draw('withdrawn', ARCH)
    assert refused is not None
    assert refused.code == 'many'
    assert len(kept(folder, EventKind.PROPOSED)) == before + 2


def test_a_repeated_act_changes_nothing(person: Person, folder: Path) -> None:
    said = {'act': 'agree', 'number': 0, 'step': 0}
    for _ in range(2):
        assert person.session.act(said) is None
    assert person.session.state.step == 1
    assert len(kept(folder, EventKind.AGREED)) == 1
    late = person.session.act({'act': 'next', 'number': 1, 'step': 0})
    assert late is not None
    assert late.code == 'stale'


@pytest.mark.parametrize(
    'fields',
    [
        {},
        {'act': 'agree'},
        {'act': 1, 'number': 0, 'step': 0},
        {'act': 'agree', 'number': True, 'step': 0},
    ],
)
def test_what_is_no_act_is_malformed(person: Person, fields: dict[str, Any]) -> None:
    with pytest.raises(MalformedProposal, match='expected act, number and step'):
        person.session.act(fields)


@pytest.mark.parametrize('word', ['next', 'build', 'place', 'stop', 'close', ''])
def test_only_what_is_asked_for_can_be_done(person: Person, word: str) -> None:
    refused = person.act(word)
    assert refused is not None
    assert refused.code == 'stale'
    assert person.session.state.step == 0


def test_who_does_not_agree_sees_no_more(person: Person, folder: Path) -> None:
    assert person.act('decline') is None
    assert (person.session.step, person.session.state.status) == (None, Status.DECLINED)
    assert person.act('next') is not None
    assert kept(folder, EventKind.ENDED) == []


def test_who_stops_is_debriefed_and_the_trial_is_kept(person: Person, folder: Path) -> None:
    person.go_to(StepKind.TRIAL, 'building')
    person.place(0, 0)
    assert person.act('stop') is None
    step = person.session.step
    assert step is not None
    assert step.kind is StepKind.DEBRIEF
    person.go_on()
    assert person.session.state.status is Status.STOPPED
    last = records(folder)[-1]
    assert (last.status, last.blocks) == (TrialStatus.CANCELLED, 1)
    assert list(contradictions(last)) == []


def test_time_runs_only_while_the_page_is_there(person: Person, clock: Clock) -> None:
    session = person.session
    session.arrive()
    person.go_to(StepKind.TRIAL, 'building')
    clock.s += 50
    session.leave()
    clock.s += 1000
    assert not session.tick()
    assert session.left_s == 10
    session.arrive()
    clock.s += 9
    assert not session.tick()
    clock.s += 1
    assert session.tick()
    assert not session.tick()
    record = session.record
    assert record is not None
    assert (record.status, record.reason) == (TrialStatus.CANCELLED, 'time limit of 60 s')
    assert list(contradictions(record)) == []
    person.go_on()


def test_time_goes_on_when_the_page_comes_again_before_it_is_known_to_be_gone(
    person: Person, clock: Clock
) -> None:
    session = person.session
    session.arrive()
    person.go_to(StepKind.TRIAL, 'building')
    clock.s += 40
    session.arrive()
    clock.s += 5
    assert session.left_s == 15


def test_after_a_crash_at_any_event_it_goes_on_where_it_was(
    opened: Callable[[], Desk], folder: Path
) -> None:
    """The server opens again, once before each act of a whole session."""
    desk = opened()
    desk.begin('P01')
    blocks = [(0, 0), (0, 3), (3, 0)]
    while (session := session_of(desk)).step is not None:
        before = session.state
        desk = opened()
        if before.status is not Status.RUNNING:
            break
        session = session_of(desk)
        state = session.state
        assert (state.step, state.acts, state.proposals, state.is_ended) == (
            *(before.step, before.acts, before.proposals, before.is_ended),
        )
        person, trial = Person(session), session.step.trial if session.step else None
        places = trial is not None and 'place' in trial.condition.mode.wishes
        if trial and places and trial.spec.task.board.height == 4 and not state.is_ended:
            assert person.place(*blocks[len(state.proposals)]) is None
        else:
            person.go_on()
    found = records(folder)
    assert len(found) == 5
    assert [list(contradictions(record)) for record in found] == [[]] * 5
    assert opened().session is None


def test_an_end_that_was_not_kept_is_kept_later(
    person: Person, folder: Path, opened: Callable[[], Desk]
) -> None:
    """The server dies between the last proposal of a trial and the record."""
    person.go_to(StepKind.TRIAL)
    person.whole()
    path = folder / 'events.jsonl'
    lines = path.read_bytes().splitlines(keepends=True)
    assert b'"ended"' in lines[-1]
    path.write_bytes(b''.join(lines[:-1]) + b'{"event":"en')
    assert session_of(opened()).state.is_ended
    assert len(records(folder)) == 1
    assert (folder / 'events.torn').read_bytes() == b'{"event":"en\n'


def test_on_a_full_disk_nothing_happens_and_nothing_is_lost(
    person: Person, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    person.go_to(StepKind.TRIAL)
    before, there = person.session.state, (folder / 'events.jsonl').read_bytes()
    write = os.write

    def full(descriptor: int, data: bytes) -> int:
        write(descriptor, bytes(data)[:5])
        raise OSError(errno.ENOSPC, 'No space left on device')

    with monkeypatch.context() as patch:
        patch.setattr(os, 'write', full)
        for word in ('build', 'stop'):
            with pytest.raises(RecordError, match='No space left'):
                person.draw(word, ['####', '####'])
    assert person.session.state == before
    assert (folder / 'events.jsonl').read_bytes() == there
    person.go_on()


def test_time_does_not_run_while_the_server_is_down(
    opened: Callable[[], Desk], clock: Clock
) -> None:
    desk = opened()
    desk.begin('P01')
    session = session_of(desk)
    session.arrive()
    Person(session).go_to(StepKind.TRIAL, 'building')
    clock.s += 20
    session.note({'note': 'visible', 'step': session.state.step, 'visible': False})
    session.release()  # killed: that the page is gone is not kept
    desk.session = None
    clock.s += 500
    again = session_of(opened())
    assert (again.left_s, again.state.is_present) == (40, False)
