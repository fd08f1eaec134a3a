"""Proposals of a person: regions to build, withdrawn regions, and giving up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from enum import Enum

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError

MOST_PROPOSALS = 1000
"""Largest number of proposals in one state, so that memory stays bounded."""


class ProposalKind(str, Enum):
    """The kind of a proposal."""

    BUILD = 'build'
    """Search for a plan that fills the region, and build it."""
    WITHDRAWN = 'withdrawn'
    """The region was drawn and withdrawn; nothing happens."""
    GIVE_UP = 'give_up'
    """End the trial; the region is ignored."""


@dataclass(frozen=True)
class Proposal:
    """A proposal of a person.

    Attributes:
        sequence: of the observation in whose state it was made.
        number: counts the proposals made in that state, from 0.
        kind: its kind.
        region: the cells, as they were drawn; see :func:`target_of`.
        thinking_s: from seeing the state, or the answer to the last proposal, to this one [s].

    Raises:
        ConfigurationError: if ``thinking_s`` is not a finite number of 0 or more.
    """

    sequence: int
    number: int
    kind: ProposalKind
    region: Mask
    thinking_s: float

    def __post_init__(self) -> None:
        if not 0 <= self.thinking_s < math.inf:
            raise ConfigurationError(
                f'thinking_s must be a finite number of 0 or more, got {self.thinking_s!r}'
            )


def target_of(task: Task, built: Mask, region: Mask) -> Mask:
    """The cells that are filled when a drawn region is filled: its target cells and the built ones.

    Equal to ``built`` if there is nothing to fill.
    """
    return built | (region & task.silhouette)


def is_filled(task: Task, built: Mask, region: Mask) -> bool:
    """Whether no target cell of a drawn region is still empty."""
    return target_of(task, built, region) == built


def proposed_at(proposals: Iterable[Proposal], sequence: int) -> tuple[Proposal, ...]:
    """The proposals that were made in the state of an observation."""
    return tuple(proposal for proposal in proposals if proposal.sequence == sequence)


def decisive(task: Task, built: Mask, proposals: Iterable[Proposal]) -> Iterator[Proposal]:
    """The proposals of a state that have an effect: regions with empty cells, and giving up."""
    for proposal in proposals:
        match proposal.kind:
            case ProposalKind.GIVE_UP:
                yield proposal
                return
            case ProposalKind.BUILD if not is_filled(task, built, proposal.region):
                yield proposal


def out_of_turn(taken: Sequence[Proposal], proposal: Proposal) -> str:
    """Why a proposal is not the next one after those taken in its state; '' if it is."""
    expected = len(proposed_at(taken, proposal.sequence))
    if expected >= MOST_PROPOSALS:
        return f'number: a state takes at most {MOST_PROPOSALS} proposals'
    if proposal.number != expected:
        return f'number: expected {expected}, got {proposal.number}'
    return ''


def asks_nothing(task: Task, built: Mask, proposal: Proposal) -> str:
    """Why a proposal has no effect in a state; '' if it has one, or is of kind withdrawn."""
    if proposal.kind is ProposalKind.BUILD and is_filled(task, built, proposal.region):
        return 'region: expected a target cell that is still empty'
    return ''
