"""What a person says while scoping: regions to build, regions let go, and giving up."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum

from blocks_planning.board.geometry import Mask
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError


class ProposalKind(str, Enum):
    """What is to become of a region."""

    BUILD = 'build'
    """Search for a way to fill it, and build it."""
    WITHDRAWN = 'withdrawn'
    """It was looked at and let go."""
    GIVE_UP = 'give_up'
    """End the trial; the region means nothing."""


@dataclass(frozen=True)
class Proposal:
    """A person's word on what to build next.

    Attributes:
        sequence: number of blocks placed when it was made.
        number: counts the proposals made in that state, from 0.
        kind: what is to become of the region.
        region: where to build, as it was drawn; see :func:`target_of`.
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
    """The cells that stand when a drawn region is filled: its target cells, and what is built.

    Equal to ``built`` if there is nothing to fill.
    """
    return built | (region & task.silhouette)


def proposed_at(proposals: Iterable[Proposal], sequence: int) -> tuple[Proposal, ...]:
    """The proposals that were made after so many placements."""
    return tuple(proposal for proposal in proposals if proposal.sequence == sequence)


def decisive(task: Task, built: Mask, proposals: Iterable[Proposal]) -> Iterator[Proposal]:
    """Those proposals of a state that ask for something: to build what can be, or to give up."""
    for proposal in proposals:
        match proposal.kind:
            case ProposalKind.GIVE_UP:
                yield proposal
                return
            case ProposalKind.BUILD if target_of(task, built, proposal.region) != built:
                yield proposal
