"""What the page sends, and what is taken of it."""

from __future__ import annotations

import math
from functools import reduce
from typing import Any

import pytest
from builders import CHAIR, task
from heard_trials import Heard

from blocks_planning.subgoals.drawn import MalformedProposal, Refused, judge_region
from blocks_planning.subgoals.proposals import ProposalKind, target_of
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import ProposalMade
from blocks_planning.view.web.pictures import rows_of
from blocks_planning.view.web.proposing import judge, parse
from blocks_planning.view.web.session import Session, session_after

BOARD = task(CHAIR).board
EMPTY_ROWS = ['....'] * 6


def data(**changes: Any) -> dict[str, Any]:
    """What the page would send first."""
    return {
        'trial_id': 'x',
        'sequence': 0,
        'number': 0,
        'kind': 'build',
        'region': [*EMPTY_ROWS[1:], '####'],
        'thinking_s': 1.5,
        **changes,
    }


def test_it_is_read_as_it_was_meant() -> None:
    posted = parse(data(), BOARD)
    assert not posted.is_again
    assert posted.said.trial_id == 'x'
    proposal = posted.said.proposal
    assert proposal.region == BOARD.rows_below(1)
    assert (proposal.kind, proposal.thinking_s) == (ProposalKind.BUILD, 1.5)
    assert parse(data(again=True, thinking_s=2), BOARD).is_again


@pytest.mark.parametrize(
    ('changes', 'said'),
    [
        ({'kind': 'burn'}, "kind: expected build or withdrawn or give_up, got 'burn'"),
        ({'kind': ['build']}, 'kind: expected'),
        ({'trial_id': 7}, 'trial_id: expected text, got 7'),
        ({'sequence': -1}, 'sequence: expected a number from 0 to 1024, got -1'),
        ({'sequence': 1025}, 'sequence: expected'),
        ({'sequence': True}, 'sequence: expected'),
        ({'number': 1000}, 'number: expected a number from 0 to 999, got 1000'),
        ({'number': 0.0}, 'number: expected'),
        ({'thinking_s': -0.1}, 'thinking_s: expected a finite number of 0 or more, got -0.1'),
        ({'thinking_s': math.nan}, 'thinking_s: expected'),
        ({'thinking_s': math.inf}, 'thinking_s: expected'),
        ({'thinking_s': 10**400}, 'thinking_s: expected'),
        ({'thinking_s': '1'}, "thinking_s: expected a number, got '1'"),
        ({'region': EMPTY_ROWS[1:]}, 'region: expected 6 rows of 4 cells'),
        ({'region': [*EMPTY_ROWS[1:], '#####']}, 'region: expected 6 rows of 4 cells'),
        ({'region': [*EMPTY_ROWS[1:], '##x#']}, 'region: expected'),
        ({'region': '....' * 6}, 'region: expected'),
        ({'region': [list('....')] * 6}, 'region: expected'),
        ({'again': 1}, 'again: expected true or false, got 1'),
        ({'colour': 'red'}, 'expected an object with the keys'),
    ],
)
def test_what_is_no_proposal_is_named(changes: dict[str, Any], said: str) -> None:
    with pytest.raises(MalformedProposal) as refused:
        parse(data(**changes), BOARD)
    assert str(refused.value).startswith(said)
    assert '\n' not in str(refused.value)


@pytest.mark.parametrize('key', sorted(data()))
def test_every_key_is_needed(key: str) -> None:
    sent = data()
    del sent[key]
    with pytest.raises(MalformedProposal, match='expected an object with the keys'):
        parse(sent, BOARD)


@pytest.mark.parametrize('sent', [None, [], 'build', 7])
def test_only_an_object_is_read(sent: object) -> None:
    with pytest.raises(MalformedProposal):
        parse(sent, BOARD)


def test_region_must_have_something_to_fill() -> None:
    tower = task(CHAIR)
    board, seat = tower.board, tower.rows(4)
    assert judge_region(tower, 0, board.rows_below(1)) is None
    assert judge_region(tower, seat, board.full) is None
    for built, region, code in (
        (0, 0, 'empty'),
        (0, board.mask([(1, 0), (2, 5)]), 'outside'),
        (seat, board.rows_below(3), 'built'),
        (tower.silhouette, board.full, 'built'),
    ):
        refused = judge_region(tower, built, region)
        assert isinstance(refused, Refused)
        assert refused.code == code
        assert (code == 'empty') or target_of(tower, built, region) == built


def test_what_the_selector_takes_is_taken(by_person: Heard) -> None:
    """Every proposal of a trial that ran, when it was made; and never a second time."""
    session = Session()
    judged = 0
    for message in by_person.messages:
        if isinstance(message, ProposalMade):
            posted = sent(message)
            assert judge(session, posted) is None
            after = session_after(session, message)
            refused = judge(after, posted)
            assert refused is not None
            assert refused.code == 'stale'
            judged += 1
        session = session_after(session, message)
    assert judged == 4


def sent(message: ProposalMade, **changes: Any) -> Any:
    """A proposal as the page sends it."""
    proposal = message.proposal
    return parse(
        data(
            **{
                'trial_id': message.trial_id,
                'sequence': proposal.sequence,
                'number': proposal.number,
                'kind': proposal.kind.value,
                'region': rows_of(BOARD, proposal.region),
                'thinking_s': proposal.thinking_s,
                **changes,
            }
        ),
        BOARD,
    )


@pytest.mark.parametrize('changes', [{'trial_id': 'y'}, {'sequence': 1}, {'number': 1}])
def test_what_is_about_another_moment_is_refused(by_person: Heard, changes: Any) -> None:
    session = reduce(session_after, by_person.messages[:2], Session())
    first = next(m for m in by_person.messages if isinstance(m, ProposalMade))
    refused = judge(session, sent(first, **changes))
    assert refused is not None
    assert refused.code == 'stale'
    assert judge(session, sent(first)) is None


def test_while_an_answer_is_waited_for_only_giving_up_is_taken(by_person: Heard) -> None:
    proposals = [m for m in by_person.messages if isinstance(m, ProposalMade)]
    session = reduce(session_after, [*by_person.messages[:2], *proposals[:2]], Session())
    refused = judge(session, sent(proposals[2]))
    assert refused is not None
    assert refused.code == 'waiting'
    assert judge(session, sent(proposals[2], kind='give_up')) is None
    assert judge(session, sent(proposals[2], again=True)) is None


def test_nothing_is_taken_while_it_is_built_or_before_a_trial(by_person: Heard) -> None:
    proposals = [m for m in by_person.messages if isinstance(m, ProposalMade)]
    index = next(i for i, m in enumerate(by_person.messages) if isinstance(m, SubgoalChosen))
    for session in (
        Session(),
        reduce(session_after, by_person.messages[: index + 1], Session()),
        reduce(session_after, by_person.messages, Session()),
    ):
        refused = judge(session, sent(proposals[2], number=3))
        assert refused is not None
        assert refused.code == 'stale'
