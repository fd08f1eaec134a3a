"""The messages between the parts of a trial.

There are four parts, each a pure function ``step(memory, message) -> (memory, messages)``:

* :mod:`.world` owns the board,
* :mod:`.selector` chooses the next region,
* :mod:`.searcher` plans how to fill a region,
* :mod:`.scribe` starts and ends the trial and records it.

``Message`` is the union of all messages. Every message contains the id of its trial and, if it
refers to a state, the sequence number of that state. A part ignores messages that are stale,
repeated or of another trial. :mod:`.local` passes the messages inside one process.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any, TypeAlias

from blocks_planning.board.blocks import Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Query
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.worlds.observation import Blocks, Observations, mask_of, standing


@dataclass(frozen=True)
class TrialStarted:
    """The trial that runs from now on. ``trial_id`` identifies this run of it."""

    trial_id: str
    spec: TrialSpec


@dataclass(frozen=True)
class WorldState:
    """The board as it was observed last.

    Attributes:
        trial_id: of the trial.
        observations: all of the trial, the first one before any order.
        placements: the blocks that stand, in the order in which they landed.
        built: the cells that they fill.
        status: building, success or stuck.
    """

    trial_id: str
    observations: Observations
    placements: Blocks
    built: Mask
    status: TrialStatus

    @property
    def sequence(self) -> int:
        """The number of the latest observation."""
        return len(self.observations) - 1


def observed(
    trial_id: str, board: Board, observations: Observations, status: TrialStatus
) -> WorldState:
    """The state after some observations."""
    blocks = standing(observations)
    return WorldState(trial_id, observations, blocks, mask_of(board, blocks), status)


@dataclass(frozen=True)
class SearchRequest:
    """The selector asks for solves of a decision, thousands in one message."""

    trial_id: str
    queries: tuple[Query, ...]


@dataclass(frozen=True)
class SearchAnswer:
    """The result of one solve; the answers of a request come one by one, in any order."""

    trial_id: str
    query: Query
    result: SolveResult


@dataclass(frozen=True)
class ProposalMade:
    """A person proposes what to build next, or withdraws a region, or gives up."""

    trial_id: str
    proposal: Proposal


@dataclass(frozen=True)
class DecisionFailed:
    """No decision can be made: it would exceed a limit. The trial has to end; ``reason`` says why."""

    trial_id: str
    reason: str


@dataclass(frozen=True)
class PlanMade:
    """The placements that will be carried out for a subgoal, for viewers."""

    trial_id: str
    sequence: int
    target: Mask
    execute: int
    placements: tuple[Placed, ...]


@dataclass(frozen=True)
class Solve:
    """A query for the searcher's driver to solve; a :class:`SearchAnswer` returns the result."""

    trial_id: str
    query: Query


@dataclass(frozen=True)
class PlaceBlock:
    """Order a placement on the board of the state with ``sequence``."""

    trial_id: str
    sequence: int
    placement: Placement


class PlacementCode(IntEnum):
    """The outcome of an order; the numbers are those of the ROS message."""

    PLACED = 1
    """The block is where it was ordered."""
    SLIPPED = 2
    """A block landed, but elsewhere."""
    LOST = 3
    """No block landed; the order can be repeated."""
    COLLAPSED = 4
    """The tower fell."""
    IMPOSSIBLE = 5
    """The block would not come to rest inside the board; it was not tried."""
    FAILED = 6
    """No block can be placed any more: the trial has to end."""
    TRY_AGAIN = 7
    """The world is busy; the order can be repeated."""
    IN_PROGRESS = 8
    """The order is being carried out; another outcome follows."""


PLACEMENT_REASONS = {
    PlacementCode.PLACED: 'the block rests where it was ordered',
    PlacementCode.SLIPPED: 'the block landed elsewhere',
    PlacementCode.LOST: 'no block landed',
    PlacementCode.COLLAPSED: 'the tower fell',
    PlacementCode.IMPOSSIBLE: 'the block would not come to rest inside the board',
    PlacementCode.FAILED: 'no block can be placed any more',
    PlacementCode.TRY_AGAIN: 'the order cannot be carried out now',
    PlacementCode.IN_PROGRESS: 'the order is being carried out',
}
"""The usual sentence of each code."""


@dataclass(frozen=True)
class PlacementOutcome:
    """The result of a :class:`PlaceBlock`.

    Attributes:
        trial_id: of the trial.
        sequence: of the state that the order referred to.
        placed: where a block landed; None if none did.
        reason: a sentence that says why; '' for the usual reason of the code.
        code: the outcome.
        progress: of an order that is being carried out, from 0 to 1.
    """

    trial_id: str
    sequence: int
    placed: Placed | None
    reason: str = ''
    code: PlacementCode = PlacementCode.PLACED
    progress: float = 0.0

    @property
    def failed(self) -> bool:
        """Whether the world cannot place any further block."""
        return self.code is PlacementCode.FAILED

    @property
    def sentence(self) -> str:
        """Why, in words."""
        return self.reason or PLACEMENT_REASONS[self.code]


@dataclass(frozen=True)
class Held:
    """Orders may be given in states before the one with number ``until``; None: in all."""

    trial_id: str
    until: int | None = None


@dataclass(frozen=True)
class ArmOrder:
    """An arm has to carry out an order; its :class:`ArmReport` comes back to the world.

    ``placed`` is where the block comes to rest if all goes well.
    """

    trial_id: str
    sequence: int
    placed: Placed

    def report(self, code: PlacementCode, **fields: Any) -> ArmReport:
        """What became of it."""
        return ArmReport(self.trial_id, self.sequence, self.placed.placement, code, **fields)


@dataclass(frozen=True)
class ArmReport:
    """What an arm did.

    Attributes:
        trial_id: of the trial.
        sequence: of the state that the order referred to.
        ordered: what it was to place.
        code: what became of the order.
        landed: blocks that stand now and did not before.
        gone: blocks that stood before and do not now.
        reason: a sentence that says why, '' for the usual one.
        progress: of an order that is being carried out, from 0 to 1.
    """

    trial_id: str
    sequence: int
    ordered: Placement
    code: PlacementCode
    landed: Blocks = ()
    gone: Blocks = ()
    reason: str = ''
    progress: float = 0.0


@dataclass(frozen=True)
class CancelTrial:
    """End the trial as it stands; ``reason`` is '' if a user asked for it."""

    trial_id: str
    reason: str = ''


@dataclass(frozen=True)
class TrialEnded:
    """The trial is over; every part stops working on it.

    ``record`` is its record; only the message of the scribe contains it.
    """

    trial_id: str
    status: TrialStatus
    reason: str = ''
    record: TrialRecord | None = None


@dataclass(frozen=True)
class Remind:
    """Repeat unanswered messages, because a message may have been lost.

    Not needed inside one process. A repeated request gets the same answer.
    """

    trial_id: str


Message: TypeAlias = (
    'TrialStarted | WorldState | SearchRequest | SearchAnswer | SubgoalChosen | Solve | '
    'ProposalMade | DecisionFailed | PlanMade | PlaceBlock | PlacementOutcome | ArmOrder | ArmReport | '
    'Held | CancelTrial | TrialEnded | Remind'
)
