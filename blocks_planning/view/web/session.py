"""The state behind the page: the running trial, the finished trials, and a person's proposals.

A :class:`Session` is folded from the messages of the graph. It is immutable, so that the thread of
the server can read it while the next one is made.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from blocks_planning.board.geometry import Mask
from blocks_planning.search.result import SolveResult
from blocks_planning.subgoals.decision import Query
from blocks_planning.subgoals.proposals import (
    Proposal,
    ProposalKind,
    decisive,
    out_of_turn,
    proposed_at,
    target_of,
)
from blocks_planning.trials.execution import history
from blocks_planning.trials.messages import (
    Message,
    ProposalMade,
    SearchAnswer,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view.captions import shortlist
from blocks_planning.view.scene import Scene, first_scene, scene_after
from blocks_planning.worlds.observation import standing

MOST_PAST = 500
"""Number of finished trials that can be replayed; the oldest are dropped."""
MOST_CANDIDATES = 24
"""Number of candidates kept of a decision in a finished trial; the best are kept."""
MOST_LATE = 4
"""Number of last trials that messages may still arrive for: there is no order between topics."""


class Past(NamedTuple):
    """A finished trial; ``number`` counts them from 0."""

    number: int
    scene: Scene


class Turn(NamedTuple):
    """A turn of the person, in a state.

    Attributes:
        sequence: of the state.
        number: of the next proposal in it.
        built: the filled cells.
        is_waiting: whether the result of the last proposal, or its execution, is still open.
    """

    sequence: int
    number: int
    built: Mask
    is_waiting: bool


@dataclass(frozen=True)
class Session:
    """The trials and proposals so far.

    Attributes:
        scene: the running trial, or the last one; None before the first.
        state: the latest of that trial.
        past: the last finished trials, the oldest first.
        answers: to the queries of a person's proposals.
        proposals: of a person in that trial, in the order of their numbers in every state.
        told_again: how many proposals of the current state were known before this session.
    """

    scene: Scene | None = None
    state: WorldState | None = None
    past: tuple[Past, ...] = ()
    answers: Mapping[Query, SolveResult] = field(default_factory=dict)
    proposals: tuple[Proposal, ...] = ()
    told_again: int = 0

    @property
    def trial_id(self) -> str | None:
        """Id of the running trial, or of the last one."""
        return None if self.scene is None else self.scene.trial.trial_id

    @property
    def count(self) -> int:
        """Number of finished trials, including those that are no longer kept."""
        return self.past[-1].number + 1 if self.past else 0


Memory = Session


def step(memory: Session, message: Message) -> tuple[Session, tuple[Message, ...]]:
    """Update the session; no message is sent."""
    return session_after(memory, message), ()


def session_after(session: Session, message: Message) -> Session:
    """The session after a message; stale or repeated messages, or unknown trials, change nothing."""
    scene = session.scene
    if scene is None or message.trial_id != scene.trial.trial_id:
        if isinstance(message, TrialStarted):
            return Session(first_scene(message), past=_closed(session).past)
        return replace(session, past=_past_after(session.past, message))
    match message:
        case SearchAnswer():
            return _answered(session, scene.spec, message)
        case ProposalMade(_, proposal):
            return _proposed(session, scene.spec, proposal)
    after = scene_after(scene, message)
    if isinstance(message, WorldState) and _is_later(message, session.state):
        session = replace(session, state=message, told_again=0)
    if after is not scene:
        session = replace(session, scene=after, past=_past_after(session.past, message))
    return _closed(session) if isinstance(message, TrialEnded) else session


def _is_later(state: WorldState, than: WorldState | None) -> bool:
    return than is None or state.sequence > than.sequence


def _closed(session: Session) -> Session:
    """The session with the current trial added to the finished ones, if it is not there yet."""
    scene = session.scene
    if scene is None or any(p.scene.trial == scene.trial for p in session.past[-MOST_LATE:]):
        return session
    past = (*session.past, Past(session.count, _trimmed(scene)))
    return replace(session, past=past[-MOST_PAST:])


def _past_after(past: tuple[Past, ...], message: Message) -> tuple[Past, ...]:
    """The finished trials after a late message for one of them."""
    for index in range(len(past) - 1, max(len(past) - 1 - MOST_LATE, -1), -1):
        number, scene = past[index]
        if scene.trial.trial_id == message.trial_id:
            after = scene_after(scene, message)
            if after is not scene:
                late = Past(number, _trimmed(after))
                return (*past[:index], late, *past[index + 1 :])
    return past


def _trimmed(scene: Scene) -> Scene:
    """The scene, with at most ``MOST_CANDIDATES`` candidates per decision."""
    chosen = scene.chosen
    if chosen is None or all(
        len(entry.decision.candidates) <= MOST_CANDIDATES for entry in chosen.decisions
    ):
        return scene
    entries = []
    for entry in chosen.decisions:
        decision = entry.decision
        kept = shortlist(decision, MOST_CANDIDATES)
        trimmed = replace(
            decision,
            candidates=tuple(decision.candidates[index] for index in kept),
            chosen=None if decision.chosen is None else kept.index(decision.chosen),
        )
        entries.append(replace(entry, decision=trimmed))
    return replace(scene, chosen=replace(chosen, decisions=tuple(entries)))


def _answered(session: Session, spec: TrialSpec, message: SearchAnswer) -> Session:
    if not spec.strategy.asks_person:
        return session
    return replace(session, answers={**session.answers, message.query: message.result})


def _proposed(session: Session, spec: TrialSpec, proposal: Proposal) -> Session:
    """Accept a proposal as the selector does: in the order of the numbers."""
    if not spec.strategy.asks_person or out_of_turn(session.proposals, proposal):
        return session
    return replace(session, proposals=(*session.proposals, proposal))


def with_told_again(session: Session) -> Session:
    """The session, with all proposals of the current state marked as earlier than this session.

    Their answers may never arrive, so the turn does not wait for them.
    """
    sequence = 0 if session.state is None else session.state.sequence
    return replace(session, told_again=len(proposed_at(session.proposals, sequence)))


def turn_of(session: Session) -> Turn | None:
    """The turn of the person; None if it is not the person's turn."""
    scene, state = session.scene, session.state
    if (
        scene is None
        or state is None
        or not scene.spec.strategy.asks_person
        or scene.status is not TrialStatus.BUILDING
        or state.status is not TrialStatus.BUILDING
        or _is_executing(scene, state)
    ):
        return None
    made = proposed_at(session.proposals, state.sequence)
    asking = decisive(scene.task, state.built, made[session.told_again :])
    is_waiting = any(_decides(session, proposal, state.built) for proposal in asking)
    return Turn(state.sequence, len(made), state.built, is_waiting)


def _decides(session: Session, proposal: Proposal, built: Mask) -> bool:
    """Whether a proposal may end the person's turn: true unless it is known to be unsolved."""
    answer = answer_to(session, proposal, built)
    return proposal.kind is ProposalKind.GIVE_UP or answer is None or answer.solved


def answer_to(session: Session, proposal: Proposal, built: Mask) -> SolveResult | None:
    """The search result for a proposal that was made in a state; None if there is none yet."""
    scene, state = session.scene, session.state
    if scene is None or state is None:
        return None
    target = target_of(scene.task, built, proposal.region)
    blocks = standing(state.observations[: proposal.sequence + 1])
    return session.answers.get(scene.spec.query(built, target, blocks))


def _is_executing(scene: Scene, state: WorldState) -> bool:
    """Whether the last subgoal continues from a state, or the planner has given up."""
    chosen = scene.chosen
    if chosen is None:
        return False
    if chosen.subgoal is None:
        return True
    if chosen.sequence > state.sequence:
        return True
    seen = history(scene.task.board, state.observations)
    return chosen.progress(scene.spec, seen).is_open
