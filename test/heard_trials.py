"""Trials as they are heard, one with a person among them."""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

from builders import CHAIR, spec
from page_fixture import browser, opened, stage, troubles  # noqa: F401

from blocks_planning.subgoals.human import Human
from blocks_planning.subgoals.proposals import Proposal, ProposalKind
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec


class Heard(NamedTuple):
    """A trial, everything that was said in it, and its record."""

    spec: TrialSpec
    messages: list[Message]
    record: TrialRecord


def heard(trial: TrialSpec, proposals: tuple[Proposal, ...] = ()) -> Heard:
    """Run a trial and listen."""
    messages: list[Message] = []
    record = run_trial(trial, observe=messages.append, proposals=proposals)
    return Heard(trial, messages, record)


def human_spec(rows: str = CHAIR, participant: str = 'P01', costs: str = 'shown') -> TrialSpec:
    """A trial in which a person scopes."""
    return replace(spec(rows, depth=2), strategy=Human(participant, costs))


def person_says(trial: TrialSpec) -> tuple[Proposal, ...]:
    """On the chair: a region let go, one that can't be filled, then two that can."""
    board = trial.task.board
    one_cell, seat = board.mask([(0, 0)]), board.rows_below(4)
    return (
        Proposal(0, 0, ProposalKind.WITHDRAWN, board.full, 1.5),
        Proposal(0, 1, ProposalKind.BUILD, one_cell, 2.25),
        Proposal(0, 2, ProposalKind.BUILD, seat, 0.5),
        Proposal(3, 0, ProposalKind.BUILD, board.full, 3.0),
    )
