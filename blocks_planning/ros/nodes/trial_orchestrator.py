"""Node ``trial_orchestrator``: which trial runs, and its record.

With a ``script`` it runs the script's trials in order, leaves out those whose records are in
``trials.jsonl`` already, and ends the process. Without, it waits for goals; one at a time.

A trial that nobody can go on with ends with status ``cancelled``, and the reason is in its
outcome: a node is missing for too long, or a disk is full. A script ends with it, with exit code 1;
started again it goes on with that trial.

| | |
|---|---|
| listens | `state`, `subgoal` (latched), `action/outcome` (stream) |
| says | `trial`, `outcome` (latched) |
| action | `run_trial`: feedback with every state and subgoal; cancelling ends the trial |
| parameters | `remind_period_s`; `script`; `participant`: code of the person who scopes; `out_dir`: where `trials.jsonl` is; `wait_for`: nodes that must be there; `peer_timeout_s`: how long it waits for them, before a trial and during it |
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

from blocks_planning_msgs.action import RunTrial
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from blocks_planning.errors import InvalidInput, RecordError
from blocks_planning.ros.runtime.diagnostics import Health
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.peers import Attendance
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.wire.conversions.board import state_to_ros
from blocks_planning.ros.wire.conversions.decisions import subgoal_to_ros
from blocks_planning.ros.wire.conversions.trial import outcome_to_ros, spec_from_ros
from blocks_planning.ros.wire.graph import TRIAL_ORCHESTRATOR, VIEWERS
from blocks_planning.ros.wire.topics import OUTCOME
from blocks_planning.trials import scribe
from blocks_planning.trials.messages import (
    CancelTrial,
    Message,
    SubgoalChosen,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.recordfile import RecordFile
from blocks_planning.trials.script import read_session
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

RECORDS = 'trials.jsonl'
SCRIPT = Parameter('script', '', 'A trial script to run; none: wait for goals.')
PARTICIPANT = Parameter('participant', '', 'Code of the person who scopes; none: as scripted.')
OUT_DIR = Parameter('out_dir', '.', 'Folder of trials.jsonl.')
WAIT_FOR = Parameter(
    'wait_for',
    ['world', 'subgoal_selector', 'action_searcher'],
    'Nodes that must be there, before a trial and during it.',
)
PEER_TIMEOUT = Parameter(
    'peer_timeout_s', 30.0, 'How long to wait for one that is missing [s].', (0.1, 86400.0)
)
PARAMETERS = (SCRIPT, PARTICIPANT, OUT_DIR, WAIT_FOR, PEER_TIMEOUT)
_FIRST_LOOKS_S = 0.02
_LOOK_PERIOD_S = 1.0
_MOST_REASON = 300  # [characters] of what another node says


class TrialOrchestrator(PartNode):
    """The scribe, with trials to run."""

    def __init__(self, stop: threading.Event, **options: Any) -> None:
        """See :class:`PartNode`; ``stop`` is set when a script is done."""
        super().__init__(TRIAL_ORCHESTRATOR, scribe, PARAMETERS, **options)
        self.exit_code = 0
        self._stop = stop
        self._records = RecordFile(Path(self.values['out_dir']) / RECORDS)
        self._script: Iterator[TrialSpec] | None = None
        self._pausing: Any = None
        if self.values['script']:
            script = read_session(Path(self.values['script']), self.values['participant'])
            self._script = (s for s in script.trials if s.trial_id not in self._records.finished)
            self._pausing = self._make_pause(script.pause_s)
        self._goal: Any = None
        self._done: Future | None = None
        self._ended = self._failures = 0
        self._trouble = ''
        self._attendance = Attendance()
        self._began_s = self._now_s()
        self._first_looks = self.create_timer(_FIRST_LOOKS_S, self._look, clock=self.steady)
        self.create_timer(_LOOK_PERIOD_S, self._look, clock=self.steady)
        self._actions = ActionServer(
            self,
            RunTrial,
            'run_trial',
            execute_callback=self._execute,
            goal_callback=self._judge_goal,
            cancel_callback=self._cancel,
            handle_accepted_callback=self._accept,
            callback_group=ReentrantCallbackGroup(),
        )

    # Trials

    def start_trial(self, trial_id: str, spec: TrialSpec) -> None:
        """Announce a trial, and follow it."""
        self._began_s, self._trouble = self._now_s(), ''
        started = TrialStarted(trial_id, spec)
        self.say(started)
        self.take(started)

    def take(self, message: Message) -> None:
        """See :class:`PartNode`; whoever sent the goal hears of it."""
        before = self.memory
        super().take(message)
        is_news = self.memory is not before and isinstance(message, (WorldState, SubgoalChosen))
        if self._goal is not None and is_news:
            self._goal.publish_feedback(self._feedback())

    def _feedback(self) -> RunTrial.Feedback:
        memory, record = self.memory, self.memory.record()
        feedback = RunTrial.Feedback(
            action_planning_cost=record.action_planning_cost,
            subgoal_planning_cost=record.subgoal_planning_cost,
        )
        if memory.state is not None:
            feedback.state = state_to_ros(self.board, memory.state)
        if memory.chosen is not None:
            feedback.subgoal = subgoal_to_ros(self.board, memory.chosen)
        return feedback

    def say(self, message: Message) -> None:
        """See :class:`PartNode`; the end of a trial is said with its costs."""
        if not isinstance(message, TrialEnded):
            super().say(message)
            return
        record, reason = self.memory.record(), message.reason[:_MOST_REASON]
        try:
            self._records.append(record)
        except RecordError as error:
            reason = str(error)
        outcome = outcome_to_ros(message.trial_id, record, reason)
        self.publish(OUTCOME, outcome)
        self._latched.clear()  # nobody is to begin again
        self._ended += 1
        self._failures += record.status is not TrialStatus.SUCCESS
        self._trouble = reason
        if self._done is not None:
            self._done.set_result(outcome)
        elif reason:
            self._give_up(reason)
        elif self._pausing is not None:
            self._pausing.reset()
        elif self._script is not None:
            self._next_of_script()

    def _make_pause(self, pause_s: float) -> Any:
        """A timer that goes on with the script, once each time it is reset; None for no pause."""
        if pause_s <= 0:
            return None

        def go_on() -> None:
            timer.cancel()
            self._next_of_script()

        timer = self.create_timer(pause_s, go_on, clock=self.steady)
        timer.cancel()
        return timer

    def _next_of_script(self) -> None:
        spec = next(self._script, None) if self._script is not None else None
        if spec is None:
            self.exit_code = int(self._failures > 0)
            self._stop.set()
        else:
            self.start_trial(spec.trial_id, spec)

    def _give_up(self, reason: str) -> None:
        """End the script: what one trial wants for, the next would too."""
        self.get_logger().error(f'the script ends here: {reason}')
        self.exit_code = 1
        self._stop.set()

    # Who is there

    def _look(self) -> None:
        """Begin the script when everybody is there; end what has waited too long."""
        bound_s, now_s = self.values['peer_timeout_s'], self._now_s()
        wanted = self.values['wait_for']
        if self._first_looks.is_canceled():  # a trial does not need who only looks
            wanted = [name for name in wanted if name not in VIEWERS]
        gone = self._attendance.note(self.peers.missing(wanted), now_s)
        overdue = self._attendance.overdue(now_s, bound_s, self._began_s)
        if self._first_looks.is_canceled():
            if gone:
                self.get_logger().warning(f'missing: {", ".join(gone)}; waits {bound_s:g} s')
            if overdue and self.is_busy:
                self.take(CancelTrial(self.memory.trial.trial_id, overdue))
        elif self._script is None:
            self._first_looks.cancel()
        elif not self._attendance.missing:
            self._first_looks.cancel()
            self._next_of_script()
        elif overdue:
            self._first_looks.cancel()
            self._give_up(overdue)

    def _now_s(self) -> float:
        return float(self.steady.now().nanoseconds / 1e9)

    @property
    def is_busy(self) -> bool:
        """See :class:`PartNode`."""
        return self.memory.trial is not None and self.memory.status is TrialStatus.BUILDING

    def health(self) -> Health:
        """See :class:`PartNode`; the peers are those of ``wait_for``."""
        missing = self._attendance.missing
        present = [name for name in self.values['wait_for'] if name not in missing]
        values = {'trials_ended': self._ended, 'trials_not_rebuilt': self._failures}
        health = super().health()
        return replace(
            health,
            present=present,
            missing=missing,
            failure=self._trouble,
            values={**health.values, **values},
        )

    def finish(self) -> None:
        """Before the node is gone: see that the last outcome has arrived everywhere."""
        self.wait_until_heard(OUTCOME)
        self._records.close()

    # The action

    def _judge_goal(self, goal: RunTrial.Goal) -> GoalResponse:
        """Refuse a goal that can't be run, or that comes while a trial runs."""
        if self._done is not None or self._script is not None:
            self.refuse('a goal', 'a trial is running')
            return GoalResponse.REJECT
        try:
            spec_from_ros(goal.trial)
        except InvalidInput as error:
            self.refuse('a goal', error)
            return GoalResponse.REJECT
        return GoalResponse.ACCEPT

    def _accept(self, goal: Any) -> None:
        """Run a goal whose caller knows of it; one who has gone in between keeps nobody out."""
        self._done = Future()
        goal.execute()

    def _cancel(self, _: Any) -> CancelResponse:
        """End the trial of the goal, if it has begun; else :meth:`_execute` does."""
        if self._goal is not None and self.trial is not None:
            self.take(CancelTrial(self.trial.trial_id))
        return CancelResponse.ACCEPT

    async def _execute(self, goal: Any) -> RunTrial.Result:
        """Run the trial of a goal to its end."""
        self._goal, done = goal, self._done
        assert done is not None
        spec = spec_from_ros(goal.request.trial)
        self.start_trial(f'{spec.trial_id}-{bytes(goal.goal_id.uuid).hex()[:8]}', spec)
        if goal.is_cancel_requested:
            self.take(CancelTrial(self.memory.trial.trial_id))
        outcome = await done
        self._goal, self._done = None, None
        if self._trouble:
            goal.abort()
        elif outcome.status == TrialStatus.CANCELLED.value:
            goal.canceled()
        else:
            goal.succeed()
        return RunTrial.Result(outcome=outcome)


def main() -> None:
    """Run the node until its script is done, or SIGINT or SIGTERM."""
    run(TrialOrchestrator)


if __name__ == '__main__':
    main()
