"""The state of a participant's session, computed from its events in order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

from blocks_planning.board.geometry import Mask
from blocks_planning.study.events import Event, EventKind, proposal_of
from blocks_planning.study.plan import Step, StepKind
from blocks_planning.subgoals.drawn import Refused
from blocks_planning.subgoals.proposals import Proposal


class Status(str, Enum):
    """The status of a participant."""

    RUNNING = 'running'
    FINISHED = 'finished'
    """Reached the end of the last step."""
    STOPPED = 'stopped'
    """Stopped taking part."""
    DECLINED = 'declined'
    """Did not agree to take part."""


@dataclass(frozen=True)
class State:
    """The state of a session.

    Attributes:
        step: of the participant's steps, from 0; their number when the session is over.
        acts: number of acts of the participant so far.
        status: of the participant.
        is_closed: whether the experimenter closed the session.
        is_present: whether the participant's page is connected.
        is_begun: whether this step's trial has begun.
        parts: cells of each part that was marked in this step.
        proposals: in this trial.
        is_timed_out: whether the time limit of this step's trial was reached.
        is_ended: whether this step's trial has ended.
        shown_s: time for which this step was shown before ``since_s`` [s].
        since_s: time since which it is shown, on the steady clock [s]; None: it is not shown.
        last: the last event.
    """

    step: int = 0
    acts: int = 0
    status: Status = Status.RUNNING
    is_closed: bool = False
    is_present: bool = False
    is_begun: bool = False
    parts: tuple[Mask, ...] = ()
    proposals: tuple[Proposal, ...] = ()
    is_timed_out: bool = False
    is_ended: bool = False
    shown_s: float = 0.0
    since_s: float | None = None
    last: Event | None = None

    @property
    def marked(self) -> Mask:
        """The cells that belong to a part."""
        return sum(self.parts)

    def on_step_s(self, steady_s: float) -> float:
        """Time for which this step was shown up to a time of the steady clock [s]."""
        return self.shown_s + (0.0 if self.since_s is None else max(0.0, steady_s - self.since_s))


def state_after(state: State, event: Event, steps: Sequence[Step]) -> State:
    """The state after an event."""
    state = _after(state, event, steps)
    return replace(state, last=event)


def _after(state: State, event: Event, steps: Sequence[Step]) -> State:
    done = replace(state, acts=state.acts + 1)
    match event.kind:
        case EventKind.OPENED:
            # What interrupted the session before has no event of its own.
            last_s = state.last.steady_s if state.last else 0.0
            return replace(_away(state, last_s), is_closed=False)
        case EventKind.ARRIVED:
            return replace(_away(state, event.steady_s), is_present=True, since_s=event.steady_s)
        case EventKind.LEFT:
            return _away(state, event.steady_s)
        case EventKind.CLOSED:
            return replace(_away(state, event.steady_s), is_closed=True)
        case EventKind.AGREED | EventKind.WENT_ON:
            return _at(done, state.step + 1, event)
        case EventKind.FINISHED:
            is_first = state.status is Status.RUNNING
            over = _at(done, len(steps), event)
            return replace(over, status=Status.FINISHED) if is_first else over
        case EventKind.DECLINED:
            return replace(_at(done, len(steps), event), status=Status.DECLINED)
        case EventKind.STOPPED:
            return replace(_at(done, len(steps) - 1, event), status=Status.STOPPED)
        case EventKind.BEGAN:
            return replace(state, is_begun=True)
        case EventKind.PROPOSED:
            return replace(done, proposals=(*state.proposals, proposal_of(event)))
        case EventKind.MARKED:
            return replace(done, parts=(*state.parts, int(event.data['cells'], 16)))
        case EventKind.UNMARKED:
            return replace(done, parts=state.parts[:-1])
        case EventKind.TIMED_OUT:
            return replace(state, is_timed_out=True)
        case EventKind.ENDED:
            return replace(state, is_ended=True)
    return state


def _away(state: State, steady_s: float) -> State:
    """The state when the page disconnects."""
    return replace(state, is_present=False, shown_s=state.on_step_s(steady_s), since_s=None)


def _at(state: State, step: int, event: Event) -> State:
    """At the beginning of a step."""
    return replace(
        state,
        step=step,
        is_begun=False,
        parts=(),
        proposals=(),
        is_timed_out=False,
        is_ended=False,
        shown_s=0.0,
        since_s=event.steady_s if state.is_present else None,
    )


_GO_ON = {'next': EventKind.WENT_ON}
_MARKS = {'mark': EventKind.MARKED, 'unmark': EventKind.UNMARKED}
_MARKING = _MARKS | _GO_ON
_ACTS = {
    StepKind.CONSENT: {'agree': EventKind.AGREED, 'decline': EventKind.DECLINED},
    StepKind.TEXT: _GO_ON,
    StepKind.BREAK: _GO_ON,
    StepKind.DEBRIEF: {'next': EventKind.FINISHED},
}


def judge(state: State, steps: Sequence[Step], word: str) -> EventKind | Refused:
    """The event that an act causes in a state, or the reason to refuse it.

    Args:
        state: of the session.
        steps: of the participant.
        word: 'agree', 'decline', 'next' and 'stop'; any other is for the trial.
    """
    if state.is_closed or state.step >= len(steps):
        return Refused('over', 'the session is over')
    step = steps[state.step]
    if word == 'stop' and step.kind not in (StepKind.DEBRIEF, StepKind.CONSENT):
        return EventKind.STOPPED
    known = _ACTS.get(step.kind, _GO_ON if state.is_ended else {})
    if step.marks is not None:
        known = _MARKING if state.marked == step.marks.spec.task.silhouette else _MARKS
    if word in known:
        return known[word]
    if step.trial is not None and not state.is_ended and word in step.trial.condition.mode.wishes:
        return EventKind.PROPOSED
    return Refused('stale', 'this is not asked for now')
