"""A participant's session: messages of the page become events, which change the state.

An event is written first. If the disk refuses it, the state does not change, and the page says so.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

from blocks_planning.board.geometry import Mask
from blocks_planning.errors import shown
from blocks_planning.study.events import EventKind, Moment, event_of
from blocks_planning.study.log import Log
from blocks_planning.study.machine import State, judge, state_after
from blocks_planning.study.modes import Fields
from blocks_planning.study.notes import read_note, read_seconds
from blocks_planning.study.plan import Step, Trial
from blocks_planning.subgoals.drawn import MalformedProposal, Refused, parse_region
from blocks_planning.subgoals.proposals import (
    MOST_PROPOSALS,
    Proposal,
    proposed_at,
)
from blocks_planning.trials.local import LocalTrial
from blocks_planning.trials.messages import CancelTrial, ProposalMade, TrialStarted
from blocks_planning.trials.record import TrialRecord, proposal_to_json
from blocks_planning.trials.status import TrialStatus

STOPPED = 'the participant stopped taking part'


def now() -> Moment:
    """The current moment."""
    return Moment(time.time(), time.monotonic())


class Participant(NamedTuple):
    """A participant: code, number in the study from 0, and id of the study."""

    code: str
    number: int
    study_id: str


class _Running(NamedTuple):
    """The trial of a step: its plan, and its execution."""

    trial: Trial
    local: LocalTrial

    def time_out(self) -> None:
        """End it at its time limit."""
        reason = f'time limit of {self.trial.condition.time_limit_s} s'
        self.local.say(CancelTrial(self.trial.spec.trial_id, reason))


class Session:
    """The session of a participant.

    Attributes:
        participant: its participant.
        steps: of the participant, in order.
        state: the current state.
    """

    def __init__(
        self,
        participant: Participant,
        steps: Sequence[Step],
        log: Log,
        clock: Callable[[], Moment] = now,
    ) -> None:
        """Open the session in the state in which its log ends.

        Raises:
            RecordError: if the log can't be read or written.
        """
        self.participant = participant
        self.steps = steps
        self.state = State()
        self._log = log
        self._clock = clock
        for event in log.events():
            self.state = state_after(self.state, event, steps)
        self._running = self._run()
        named = {'participant': participant.code, 'number': participant.number}
        self._keep(EventKind.OPENED, {'study_id': participant.study_id, **named})
        self._settle()

    @property
    def step(self) -> Step | None:
        """The step that the participant is at; None: the session is over."""
        return self.steps[self.state.step] if self.state.step < len(self.steps) else None

    @property
    def record(self) -> TrialRecord | None:
        """The record so far of the trial of this step; None if the step is not a trial."""
        return None if self._running is None else self._running.local.record()

    @property
    def shown_trial(self) -> Trial | None:
        """The trial whose silhouette this step shows; None: it shows none."""
        return (self.step.trial or self.step.marks) if self.step else None

    @property
    def shown_s(self) -> float:
        """Time for which this step has been shown [s]."""
        return self.state.on_step_s(self._clock().steady_s)

    @property
    def left_s(self) -> float | None:
        """Time left for the running trial [s]; None if it is not limited."""
        trial = self.step.trial if self.step else None
        if trial is None or not trial.condition.time_limit_s or self.state.is_ended:
            return None
        return max(0.0, trial.condition.time_limit_s - self.shown_s)

    def act(self, fields: Fields) -> Refused | None:
        """Execute an act of the participant.

        Args:
            fields: ``act``, the word; ``number``, how many acts there were before it; ``step``, to
                which it refers; and what a trial needs to know. A repeated act changes nothing.

        Returns:
            The reason to refuse it; None if it was done.

        Raises:
            MalformedProposal: if the fields are not those of an act.
            RecordError: if it could not be kept; then nothing has happened.
        """
        self._settle()
        word, number, step = (fields.get(key) for key in ('act', 'number', 'step'))
        if not isinstance(word, str) or type(number) is not int or type(step) is not int:
            raise MalformedProposal(f'expected act, number and step, got {shown(dict(fields))}')
        if number == self.state.acts - 1:
            return None
        if (number, step) != (self.state.acts, self.state.step):
            return Refused('stale', 'the page is not up to date')
        kind = judge(self.state, self.steps, word)
        if isinstance(kind, Refused):
            return kind
        if kind is EventKind.PROPOSED and self._running is not None:
            return self._propose(self._running, word, fields)
        if kind is EventKind.MARKED and self.shown_trial is not None:
            return self._mark(self.shown_trial, word, fields)
        self._keep(kind, self._cut_short(kind))
        self._running = self._run()
        self._settle()
        return None

    def note(self, fields: Fields) -> None:
        """Write down a note of the page; notes of another step are dropped.

        Raises:
            MalformedProposal: if it is not a note.
            RecordError: if it could not be kept.
        """
        trial = self.shown_trial
        board = None if trial is None else trial.spec.task.board
        if fields.get('step') == self.state.step:
            kind, data = read_note(fields, board)
            self._keep(kind, data)

    def arrive(self) -> None:
        """The page is connected."""
        self._settle()
        self._keep(EventKind.ARRIVED)

    def leave(self) -> None:
        """The page is gone."""
        if self.state.is_present:
            self._keep(EventKind.LEFT)

    def tick(self) -> bool:
        """End the trial if its time is over; return whether it was."""
        self._settle()
        if self.left_s != 0.0 or self._running is None:
            return False
        if not self.state.is_timed_out:
            self._keep(EventKind.TIMED_OUT)
        self._running.time_out()
        self._settle()
        return True

    def close(self) -> None:
        """The experimenter closes the session; it can be opened again."""
        if self.step is not None:
            self._keep(EventKind.CLOSED)
        self.release()

    def release(self) -> None:
        """Close the log; no event can be written after that."""
        self._log.close()

    def _propose(self, running: _Running, word: str, fields: Fields) -> Refused | None:
        trial, local = running
        record = local.record()
        wish = trial.condition.mode.wishes[word](trial.spec.task, record.built, fields)
        thinking_s = read_seconds(fields, 'thinking_s')
        sequence = len(record.observations) - 1
        number = len(proposed_at(self.state.proposals, sequence))
        refused = wish.refused
        if number >= MOST_PROPOSALS:
            refused = Refused('many', 'this was tried too often')
        if refused is not None:
            return self._refuse(word, wish.region, refused)
        proposal = Proposal(sequence, number, wish.kind, wish.region, thinking_s)
        self._keep(EventKind.PROPOSED, proposal_to_json(proposal))
        local.say(ProposalMade(trial.spec.trial_id, proposal))
        self._settle()
        return None

    def _mark(self, trial: Trial, word: str, fields: Fields) -> Refused | None:
        """Mark the cells of a region that belong to no part yet as a part."""
        task, marked = trial.spec.task, self.state.marked
        region = parse_region(fields.get('region'), task.board)
        thinking_s = read_seconds(fields, 'thinking_s')
        cells = region & task.silhouette & ~marked
        if not cells:
            refused = Refused('marked', 'no cell of it is without a part')
            return self._refuse(word, region, refused)
        named = {key: trial.to_json()[key] for key in ('phase', 'condition', 'tower')}
        drawn = {'region': hex(region), 'cells': hex(cells), 'thinking_s': thinking_s}
        self._keep(EventKind.MARKED, named | drawn)
        return None

    def _refuse(self, word: str, region: Mask, refused: Refused) -> Refused:
        data = {'wish': word, 'code': refused.code, 'region': hex(region)}
        self._keep(EventKind.REFUSED, data)
        return refused

    def _run(self) -> _Running | None:
        """The trial of this step, with its proposals so far."""
        trial = self.step.trial if self.step else None
        if trial is None:
            return None
        local = LocalTrial(trial.spec)
        local.say(TrialStarted(trial.spec.trial_id, trial.spec))
        for proposal in self.state.proposals:
            local.say(ProposalMade(trial.spec.trial_id, proposal))
        running = _Running(trial, local)
        if self.state.is_timed_out:
            running.time_out()
        return running

    def _settle(self) -> None:
        """Write the beginning and the end of the trial, if they are not written yet."""
        running = self._running
        if running is None:
            return
        if not self.state.is_begun:
            self._keep(EventKind.BEGAN, running.trial.to_json())
        if not running.local.waits and not self.state.is_ended:
            self._keep(EventKind.ENDED, {'record': running.local.record().to_json()})

    def _cut_short(self, kind: EventKind) -> dict[str, Any]:
        """The data of an event that may end a trial."""
        if kind is not EventKind.STOPPED:
            return {}
        if self._running is None or not self._running.local.waits:
            return {'record': None}
        record = self._running.local.record()
        cancelled = replace(record, status=TrialStatus.CANCELLED, reason=STOPPED)
        return {'record': cancelled.to_json()}

    def _keep(self, kind: EventKind, data: dict[str, Any] | None = None) -> None:
        event = event_of(kind, self.state.step, self._clock(), data or {})
        self._log.append(event)
        self.state = state_after(self.state, event, self.steps)
