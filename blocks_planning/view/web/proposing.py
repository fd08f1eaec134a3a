"""Proposals from the page: decoding, and whether they can be accepted."""

from __future__ import annotations

from typing import Any, NamedTuple

from blocks_planning.board.geometry import Board
from blocks_planning.errors import ConfigurationError, shown
from blocks_planning.subgoals.drawn import (
    MalformedProposal,
    Refused,
    judge_region,
    parse_region,
)
from blocks_planning.subgoals.proposals import MOST_PROPOSALS, Proposal, ProposalKind
from blocks_planning.trials.messages import ProposalMade
from blocks_planning.view.web.session import Session, turn_of
from blocks_planning.worlds.observation import MAX_OBSERVATIONS

_KEYS = {'trial_id', 'sequence', 'number', 'kind', 'region', 'thinking_s'}


class Posted(NamedTuple):
    """A proposal as it was sent; ``is_again`` if it was accepted before and is repeated."""

    said: ProposalMade
    is_again: bool


def parse(data: object, board: Board) -> Posted:
    """Decode a proposal from the page.

    Args:
        data: decoded JSON; the region is a picture, rows of '#' and '.', top row first.
        board: of the running trial.

    Raises:
        MalformedProposal: if the data is invalid; names the key.
    """
    if not isinstance(data, dict) or not _KEYS <= data.keys() <= _KEYS | {'again'}:
        raise MalformedProposal(f'expected an object with the keys {", ".join(sorted(_KEYS))}')
    kinds = [kind.value for kind in ProposalKind]
    if data['kind'] not in kinds:
        raise MalformedProposal(f'kind: expected {" or ".join(kinds)}, got {shown(data["kind"])}')
    if not isinstance(data['trial_id'], str):
        raise MalformedProposal(f'trial_id: expected text, got {shown(data["trial_id"])}')
    if type(data.get('again', False)) is not bool:
        raise MalformedProposal(f'again: expected true or false, got {shown(data["again"])}')
    seconds = data['thinking_s']
    if type(seconds) not in (int, float):
        raise MalformedProposal(f'thinking_s: expected a number, got {shown(seconds)}')
    try:
        proposal = Proposal(
            sequence=_whole(data, 'sequence', MAX_OBSERVATIONS),
            number=_whole(data, 'number', MOST_PROPOSALS - 1),
            kind=ProposalKind(data['kind']),
            region=parse_region(data['region'], board),
            thinking_s=float(seconds),
        )
    except (ConfigurationError, OverflowError):
        raise MalformedProposal(
            f'thinking_s: expected a finite number of 0 or more, got {shown(seconds)}'
        ) from None
    return Posted(ProposalMade(data['trial_id'], proposal), data.get('again', False))


def _whole(data: dict[str, Any], key: str, most: int) -> int:
    value = data[key]
    if type(value) is not int or not 0 <= value <= most:
        raise MalformedProposal(f'{key}: expected a number from 0 to {most}, got {shown(value)}')
    return value


def judge(session: Session, posted: Posted) -> Refused | None:
    """The reason why a proposal cannot be accepted now; None if it can."""
    turn, (said, is_again) = turn_of(session), posted
    proposal = said.proposal
    if (
        session.scene is None
        or turn is None
        or (said.trial_id, proposal.sequence, proposal.number)
        != (session.trial_id, turn.sequence, turn.number)
    ):
        return Refused('stale', 'the tower has changed meanwhile')
    if is_again:
        return None
    if turn.is_waiting and proposal.kind is not ProposalKind.GIVE_UP:
        return Refused('waiting', 'the search for the last region is still running')
    if proposal.kind is ProposalKind.BUILD:
        return judge_region(session.scene.task, turn.built, proposal.region)
    return None
