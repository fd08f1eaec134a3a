"""What the parts of a trial tell each other.

There are four parts, each a pure function ``step(memory, message) -> (memory, messages)``:

* :mod:`.world` owns the board,
* :mod:`.selector` owns which region comes next,
* :mod:`.searcher` owns how a region is filled,
* :mod:`.scribe` owns which trial runs and writes down what happened.

``Message`` lists everything that can be said. Every message carries the trial it belongs to and,
where it refers to a state, that state's sequence number; a part ignores what is stale, doubled or
foreign. :mod:`.local` carries the messages inside one process.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from blocks_planning.board import rules
from blocks_planning.board.blocks import Placed, Placement
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Decision, Query, Subgoal
from blocks_planning.subgoals.proposals import Proposal
from blocks_planning.trials.record import DecisionRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus


@dataclass(frozen=True)
class TrialStarted:
    """The trial that runs from now on. ``trial_id`` names this run of it."""

    trial_id: str
    spec: TrialSpec


@dataclass(frozen=True)
class WorldState:
    """The board. ``status`` is building, success or stuck; ``sequence`` counts placements."""

    trial_id: str
    sequence: int
    built: Mask
    placements: tuple[Placed, ...]
    status: TrialStatus


@dataclass(frozen=True)
class SearchRequest:
    """The selector wants to know what filling a region takes."""

    trial_id: str
    query: Query


@dataclass(frozen=True)
class SearchAnswer:
    """What filling a region takes."""

    trial_id: str
    query: Query
    result: SolveResult


@dataclass(frozen=True)
class ProposalMade:
    """A person has said what to build next, or not to."""

    trial_id: str
    proposal: Proposal


@dataclass(frozen=True)
class SubgoalChosen:
    """The subgoal to execute from the state with ``sequence`` on, or that the planner gives up.

    It carries all decisions of the trial so far, so that who missed one, or comes late, knows as
    much as all others. The subgoal is the last one begun of the last decision. ``proposals`` are
    those of a person that led to the decisions.
    """

    trial_id: str
    sequence: int
    decisions: tuple[DecisionRecord, ...]
    proposals: tuple[Proposal, ...] = ()

    @property
    def decision(self) -> Decision:
        """The last decision."""
        return self.decisions[-1].decision

    @property
    def index(self) -> int:
        """Which of its subgoals is to be executed."""
        return max(0, self.decisions[-1].executed - 1)

    @property
    def subgoal(self) -> Subgoal | None:
        """The subgoal to execute; None if the planner gives up."""
        return self.decision.subgoals[self.index] if self.decision.subgoals else None

    @property
    def built(self) -> Mask:
        """The state from which it is executed."""
        return self.decision.subgoals[self.index - 1].region if self.index else self.decision.built

    @property
    def end(self) -> int:
        """The sequence number of the state in which it has been executed."""
        return self.sequence + (self.subgoal.execute if self.subgoal else 0)

    def way(self, board: Board) -> list[Mask]:
        """The states that its execution leads through, from ``sequence`` to ``end``."""
        placements = self.subgoal.placements[: self.subgoal.execute] if self.subgoal else ()
        return rules.states_along(board, self.built, placements)


@dataclass(frozen=True)
class PlanMade:
    """The placements that are about to be carried out for a subgoal, for whoever watches."""

    trial_id: str
    sequence: int
    region: Mask
    execute: int
    placements: tuple[Placed, ...]


@dataclass(frozen=True)
class Solve:
    """The searcher has to solve a query; its :class:`SearchAnswer` comes back to it."""

    trial_id: str
    query: Query


@dataclass(frozen=True)
class PlaceBlock:
    """Drop a block on the board of the state with ``sequence``."""

    trial_id: str
    sequence: int
    placement: Placement


@dataclass(frozen=True)
class PlacementOutcome:
    """What became of a :class:`PlaceBlock`; ``reason`` says why it was not accepted.

    ``failed``: it is not the block; nothing can be placed on that state any more.
    """

    trial_id: str
    sequence: int
    placed: Placed | None
    reason: str = ''
    failed: bool = False


@dataclass(frozen=True)
class CancelTrial:
    """End the trial as it stands; ``reason`` says why if nobody asked for it."""

    trial_id: str
    reason: str = ''


@dataclass(frozen=True)
class TrialEnded:
    """The trial is over: nobody does anything more for it.

    ``reason`` says why it was cancelled, '' if somebody asked for it.
    """

    trial_id: str
    status: TrialStatus
    reason: str = ''


@dataclass(frozen=True)
class Remind:
    """Say again what nobody has answered; it may have been lost.

    Never needed inside a process. Every answer is the same when it is asked for twice.
    """

    trial_id: str


Message: TypeAlias = (
    'TrialStarted | WorldState | SearchRequest | SearchAnswer | SubgoalChosen | Solve | '
    'ProposalMade | PlanMade | PlaceBlock | PlacementOutcome | CancelTrial | TrialEnded | Remind'
)
