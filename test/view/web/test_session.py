"""What the page knows, from what it hears."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import reduce

import pytest
from builders import CHAIR, spec
from heard_trials import Heard, heard

from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchAnswer,
    TrialEnded,
    TrialStarted,
    WorldState,
    observed,
)
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.scene import last_scene
from blocks_planning.view.web import session as module
from blocks_planning.view.web.session import Session, session_after, turn_of, with_told_again


def after(messages: Sequence[Message], start: Session | None = None) -> Session:
    """The session after some messages."""
    return reduce(session_after, messages, start or Session())


def start_of(seed: int) -> TrialStarted:
    """A trial that begins."""
    trial = spec(CHAIR, seed=seed)
    return TrialStarted(trial.trial_id, trial)


@pytest.mark.parametrize('name', ['scoped', 'by_person'])
def test_a_trial_that_was_heard_is_the_trial_that_ran(
    name: str, request: pytest.FixtureRequest
) -> None:
    trial: Heard = request.getfixturevalue(name)
    session = after(trial.messages)
    assert session.scene is not None
    assert session.scene.record == trial.record
    assert [past.scene.record for past in session.past] == [trial.record]
    assert session.count == 1


def test_nothing_changes_by_what_is_doubled_or_foreign(scoped: Heard) -> None:
    session = after(scoped.messages)
    visible = (TrialStarted, WorldState, SubgoalChosen, TrialEnded)
    again = [message for message in scoped.messages if isinstance(message, visible)]
    assert after(again, session) == session
    foreign = [replace(m, trial_id='x') for m in again if not isinstance(m, TrialStarted)]
    assert after(foreign, session) == session


def test_news_of_the_trial_before_is_not_lost(scoped: Heard) -> None:
    """Topics are not ordered among each other."""
    late = [m for m in scoped.messages if isinstance(m, (WorldState, SubgoalChosen))][-2:]
    rest = [m for m in scoped.messages if m not in late]
    early = after([*rest, start_of(7)])
    assert early.past[-1].scene.record != scoped.record
    late_after = after(late, early)
    assert late_after.past[-1].scene.record == scoped.record
    assert late_after.scene == early.scene


def test_outcome_that_comes_last_of_all_is_taken(scoped: Heard) -> None:
    *rest, end = scoped.messages
    assert isinstance(end, TrialEnded)
    session = after([*rest, start_of(7)])
    assert session.past[-1].scene.status is TrialStatus.BUILDING
    assert after([end], session).past[-1].scene.record == scoped.record


def test_what_ran_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, 'MOST_PAST', 3)
    starts = [start_of(seed) for seed in range(6)]
    session = after(starts)
    assert [past.number for past in session.past] == [2, 3, 4]
    assert [past.scene.trial for past in session.past] == starts[2:5]
    assert session.count == 5


def test_candidates_of_what_ran_are_bounded(
    scoped: Heard, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The chosen one stays, and everything else of the record."""
    monkeypatch.setattr(module, 'MOST_CANDIDATES', 1)
    kept = after(scoped.messages).past[-1].scene.record
    for entry, whole in zip(kept.decisions, scoped.record.decisions, strict=True):
        assert len(whole.decision.candidates) > 1 or entry == whole
        assert whole.decision.chosen is not None
        chosen = whole.decision.candidates[whole.decision.chosen]
        assert entry.decision == replace(whole.decision, candidates=(chosen,), chosen=0)
    assert any(len(entry.decision.candidates) > 1 for entry in scoped.record.decisions)
    assert kept.placements == scoped.record.placements
    assert last_scene(kept).built == last_scene(scoped.record).built


# The person


def turns(trial: Heard) -> list[tuple[int, int, bool] | None]:
    """Whose turn it is after each message; repeated ones once."""
    session = Session()
    found: list[tuple[int, int, bool] | None] = []
    for message in trial.messages:
        session = session_after(session, message)
        turn = turn_of(session)
        shown = None if turn is None else (turn.sequence, turn.number, turn.is_waiting)
        if not found or found[-1] != shown:
            found.append(shown)
    return found


def test_the_person_is_asked_in_every_state_that_nothing_leads_on_from(by_person: Heard) -> None:
    assert by_person.record.status is TrialStatus.SUCCESS
    assert turns(by_person) == [
        None,
        (0, 0, False),
        (0, 1, False),  # after one was withdrawn
        (0, 2, True),
        (0, 2, False),  # it can't be built
        (0, 3, True),
        None,  # it can, and will be
        (3, 0, False),
        (3, 1, True),
        None,
    ]


def test_nobody_is_asked_without_a_person(scoped: Heard) -> None:
    assert turns(scoped) == [None]
    made = ProposalMade(
        scoped.spec.trial_id, Proposal(0, 0, ProposalKind.BUILD, scoped.spec.task.board.full, 0.0)
    )
    session = after(scoped.messages[:2])
    assert after([made], session) == session


def test_giving_up_ends_the_turn(by_person: Heard) -> None:
    trial = heard(by_person.spec, (Proposal(0, 0, ProposalKind.GIVE_UP, 0, 0.0),))
    assert trial.record.status is TrialStatus.GAVE_UP
    assert turns(trial) == [None, (0, 0, False), (0, 1, True), None]


def test_a_proposal_that_asks_for_nothing_is_not_waited_for(by_person: Heard) -> None:
    """As the selector takes it: somebody may publish such a one."""
    nothing = Proposal(0, 0, ProposalKind.BUILD, 0, 0.0)
    said = ProposalMade(by_person.spec.trial_id, nothing)
    turn = turn_of(after([*by_person.messages[:2], said]))
    assert turn is not None
    assert (turn.number, turn.is_waiting) == (1, False)


def test_proposals_out_of_their_order_are_ignored(by_person: Heard) -> None:
    start = after(by_person.messages[:2])
    proposals = [m for m in by_person.messages if isinstance(m, ProposalMade)]
    assert after([proposals[1]], start) == start
    assert after([proposals[0], proposals[0]], start).proposals == (proposals[0].proposal,)


def test_a_block_that_lies_elsewhere_makes_it_the_persons_turn(by_person: Heard) -> None:
    index = next(i for i, m in enumerate(by_person.messages) if isinstance(m, SubgoalChosen))
    session = after(by_person.messages[: index + 1])
    assert turn_of(session) is None
    states = [m for m in by_person.messages if isinstance(m, WorldState)]
    trial = by_person.messages[0]
    assert isinstance(trial, TrialStarted)
    (placed,) = states[1].placements
    moved = placed._replace(column=placed.column + 1)
    seen = states[1].observations[1]._replace(landed=(moved,))
    elsewhere = observed(
        trial.trial_id,
        trial.spec.task.board,
        (states[1].observations[0], seen),
        states[1].status,
    )
    turn = turn_of(after([elsewhere], session))
    assert turn is not None
    assert (turn.sequence, turn.number) == (1, 0)


def test_what_is_told_again_is_not_waited_for(by_person: Heard) -> None:
    """Nobody will answer it once more."""
    proposals = [m for m in by_person.messages if isinstance(m, ProposalMade)][:2]
    session = after([*by_person.messages[:2], *proposals])
    turn, again = turn_of(session), turn_of(with_told_again(session))
    assert turn is not None
    assert again is not None
    assert (turn.is_waiting, again.is_waiting) == (True, False)
    assert again.number == turn.number == 2


def test_next_state_waits_for_its_own_proposals(by_person: Heard) -> None:
    """Also if as many of the state before were told again."""
    said = by_person.messages
    last = max(i for i, m in enumerate(said) if isinstance(m, ProposalMade))
    first = next(i for i, m in enumerate(said) if isinstance(m, ProposalMade))
    turn = turn_of(after(said[first + 1 : last + 1], with_told_again(after(said[: first + 1]))))
    assert turn is not None
    assert (turn.sequence, turn.number, turn.is_waiting) == (3, 1, True)


def test_answers_are_those_of_the_searches(by_person: Heard) -> None:
    session = after(by_person.messages)
    answers = {m.query: m.result for m in by_person.messages if isinstance(m, SearchAnswer)}
    assert session.answers == answers
    assert {result.solved for result in answers.values()} == {True, False}
