"""Node ``trial_orchestrator``: runs the trials and writes their records.

With a ``script`` it runs the trials of the script in order, skips those that have a record in
``trials.jsonl``, and ends the process. Without a script it waits for goals, one at a time.

A trial that cannot continue ends with status ``cancelled`` and the reason in its outcome: a node is
missing for too long, the world is silent for too long or cannot carry out an order, or a disk is
full. The script then ends with exit code 1; after a new start it continues with that trial.

| | |
|---|---|
| subscribes | `state`, `subgoal` (latched), `action`, `action/outcome` (stream) |
| publishes | `trial`, `hold`, `outcome` (latched) |
| action | `run_trial`: feedback with every state and subgoal; cancelling ends the trial |
| services | `pause`, `resume`, `step`: when orders may be given |
| parameters | `remind_period_s`; `frame_id`; `script`; `participant`: code of the person who plans; `out_dir`: folder of `trials.jsonl`; `wait_for`: nodes that must be present; `peer_timeout_s`: how long to wait for a missing one, before a trial and during it; `placing_timeout_s`: how long the world may be silent; `retries`: how often an order is given again |
"""

from __future__ import annotations

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

from blocks_planning_msgs.action import RunTrial

from blocks_planning.errors import InvalidInput, RecordError
from blocks_planning.ros.runtime.attendance import Attendance
from blocks_planning.ros.runtime.diagnostics import Health
from blocks_planning.ros.runtime.goals import GoalServer
from blocks_planning.ros.runtime.holding import Holding, HoldServices
from blocks_planning.ros.runtime.parameters import Parameter
from blocks_planning.ros.runtime.part_node import PartNode
from blocks_planning.ros.runtime.patience import Patience
from blocks_planning.ros.runtime.process import run
from blocks_planning.ros.runtime.scripted import ScriptRun
from blocks_planning.ros.wire.graph import LISTENERS, TRIAL_ORCHESTRATOR
from blocks_planning.ros.wire.topics import OUTCOME, STATE, SUBGOAL, Topic
from blocks_planning.trials import scribe
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    CancelTrial,
    Held,
    Message,
    TrialEnded,
    TrialStarted,
    WorldState,
)
from blocks_planning.trials.recordfile import RecordFile
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

RECORDS = 'trials.jsonl'
SCRIPT = Parameter('script', '', 'A trial script to run; none: wait for goals.')
PARTICIPANT = Parameter('participant', '', 'Code of the person who plans; none: as scripted.')
OUT_DIR = Parameter('out_dir', '.', 'Folder of trials.jsonl.')
WAIT_FOR = Parameter(
    'wait_for',
    ['world', 'subgoal_selector', 'action_searcher'],
    'Nodes that must be present, before a trial and during it.',
)
PEER_TIMEOUT = Parameter(
    'peer_timeout_s', 30.0, 'How long to wait for a missing node [s].', (0.1, 86400.0)
)
PLACING_TIMEOUT = Parameter(
    'placing_timeout_s',
    30.0,
    'How long the world may be silent when a state or an answer is due [s].',
    (0.1, 86400.0),
)
RETRIES = Parameter(
    'retries', 10, 'How often an order is given again that the world cannot carry out.', (0, 10**6)
)
PARAMETERS = (SCRIPT, PARTICIPANT, OUT_DIR, WAIT_FOR, PEER_TIMEOUT, PLACING_TIMEOUT, RETRIES)
_FIRST_LOOKS_S = 0.02
_LOOK_PERIOD_S = 1.0


class TrialOrchestrator(PartNode):
    """The scribe, with trials to run: those of a script, or those of goals."""

    def __init__(self, stop: threading.Event, **options: Any) -> None:
        """See :class:`PartNode`; ``stop`` is set when a script is done."""
        super().__init__(TRIAL_ORCHESTRATOR, scribe, PARAMETERS, **options)
        self.exit_code = 0
        self._stop = stop
        self._records = RecordFile(Path(self.values['out_dir']) / RECORDS)
        self._script = self._read_script(self.values['script'])
        self._ended = self._failures = 0
        self._trouble = ''
        self._attendance = Attendance()
        self._patience = Patience(self.values['placing_timeout_s'], self.values['retries'])
        self._began_s = self.now_s
        self._first_looks = self.create_timer(_FIRST_LOOKS_S, self._look_first, clock=self.steady)
        self.create_timer(_LOOK_PERIOD_S, self._look, clock=self.steady)
        self._holding = Holding()
        HoldServices(self, self._holding, self._sequence, self._tell_hold)
        self._goals = GoalServer(self, is_open=lambda: self._script is None)

    def _read_script(self, path: str) -> ScriptRun | None:
        if not path:
            return None

        def make_timer(period_s: float, callback: Any) -> Any:
            return self.create_timer(period_s, callback, clock=self.steady)

        participant, finished = self.values['participant'], self._records.finished
        return ScriptRun(Path(path), participant, finished, make_timer, self._start_scripted)

    # Trials

    def start_trial(self, trial_id: str, spec: TrialSpec) -> None:
        """Announce a trial, and record it."""
        self._began_s, self._trouble = self.now_s, ''
        self.get_logger().info(
            f'trial {trial_id} begins: {spec.stimulus}, {spec.strategy.name}, '
            f'{spec.search.name}, {spec.world.name}, seed {spec.seed}'
        )
        started = TrialStarted(trial_id, spec)
        self.say(started)
        self.take(started)
        self._holding.begin()
        self._tell_hold()

    def _sequence(self) -> int:
        """Of the latest state; 0 before the first."""
        state = self.memory.state
        return state.sequence if self.is_busy and state is not None else 0

    def _tell_hold(self) -> None:
        if self.trial is not None and self.is_busy:
            self.say(Held(self.trial.trial_id, self._holding.until))

    def cancel_trial(self, reason: str = '') -> None:
        """End the running trial, if there is one; ``reason`` is '' if a user cancelled it."""
        if self.trial is not None:
            self.take(CancelTrial(self.trial.trial_id, reason))

    def take(self, message: Message) -> None:
        """See :class:`PartNode`; the client of a goal gets feedback."""
        reason = self._patience.hear(message, self.now_s)
        before = self.memory
        super().take(message)
        is_news = self.memory is not before and isinstance(message, (WorldState, SubgoalChosen))
        if is_news and self._goals.is_heard:
            self._goals.tell(self._feedback())
        if reason:
            self.cancel_trial(reason)

    def refuse_message(self, topic: Topic, error: InvalidInput) -> None:
        """See :class:`PartNode`."""
        super().refuse_message(topic, error)
        if topic is STATE:
            self._patience.refused(str(error))

    def start_over(self, trial: TrialStarted) -> None:
        """See :class:`PartNode`; a world may not go back for ever."""
        super().start_over(trial)
        self._holding.begin()
        self._tell_hold()
        reason = self._patience.set_back(self.now_s)
        if reason:
            self.cancel_trial(reason)

    def _feedback(self) -> RunTrial.Feedback:
        memory, record = self.memory, self.memory.record()
        feedback = RunTrial.Feedback(
            action_planning_cost=record.action_planning_cost,
            subgoal_planning_cost=record.subgoal_planning_cost,
        )
        if memory.state is not None:
            feedback.state = self.stamped(STATE.to_ros(self.board, memory.state))
        if memory.chosen is not None:
            feedback.subgoal = self.stamped(SUBGOAL.to_ros(self.board, memory.chosen))
        return feedback

    def say(self, message: Message) -> None:
        """See :class:`PartNode`; before the end of a trial is published, its record is written."""
        if not isinstance(message, TrialEnded):
            super().say(message)
            return
        ended = self._written(message)
        outcome = OUTCOME.to_ros(None, ended)
        self.publish(OUTCOME, outcome)
        self._latched.clear()  # no node must begin the trial again
        self._ended += 1
        self._failures += ended.status is not TrialStatus.SUCCESS
        self._trouble = ended.reason
        self.get_logger().info(f'trial {ended.trial_id} ended: {outcome.status}: {outcome.reason}')
        if self._goals.end(outcome):
            return
        if ended.reason:
            self._give_up(ended.reason)
        elif self._script is not None:
            self._script.go_on()

    def _written(self, ended: TrialEnded) -> TrialEnded:
        """The outcome after writing the record, or with the reason why it was not written."""
        assert ended.record is not None
        try:
            self._records.append(ended.record)
        except RecordError as error:
            return replace(ended, status=TrialStatus.CANCELLED, reason=str(error))
        return ended

    def _start_scripted(self, spec: TrialSpec | None) -> None:
        if spec is None:
            self.exit_code = int(self._failures > 0)
            self._stop.set()
        else:
            self.start_trial(spec.trial_id, spec)

    def _give_up(self, reason: str) -> None:
        """End the script: the next trial would fail for the same reason."""
        self.get_logger().error(f'the script ends: {reason}')
        self.exit_code = 1
        self._stop.set()

    # Which nodes are present

    def _look_first(self) -> None:
        """Begin the script as soon as all nodes are present."""
        self._note_missing(self.values['wait_for'])
        missing, overdue, script = self._attendance.missing, self._overdue, self._script
        if missing and script is not None and not overdue:
            return
        self._first_looks.cancel()
        if script is None:
            return
        if not set(missing) <= set(LISTENERS):
            self._give_up(overdue)
            return
        if missing:
            self.get_logger().warning(f'{overdue}; the script begins without them')
        script.begin()

    def _look(self) -> None:
        """End a trial that has waited too long for a node, or for what its world has to say."""
        if not self._first_looks.is_canceled():
            return
        # A trial does not need nodes that only record or show.
        wanted = [name for name in self.values['wait_for'] if name not in LISTENERS]
        gone = self._note_missing(wanted)
        if gone:
            bound_s = self.values['peer_timeout_s']
            self.get_logger().warning(f'missing: {", ".join(gone)}; waiting up to {bound_s:g} s')
        if self._attendance.missing:
            self._patience.excuse(self.now_s)
        late = self._overdue or self._patience.overdue(self.now_s)
        if late and self.is_busy:
            self.cancel_trial(late)

    def _note_missing(self, wanted: list[str]) -> list[str]:
        """Note which nodes are missing; return those that were present before."""
        return self._attendance.note(self.peers.missing(wanted), self.now_s)

    @property
    def _overdue(self) -> str:
        """Nodes that have been missing for too long, as a sentence; or ''."""
        bound_s = self.values['peer_timeout_s']
        return self._attendance.overdue(self.now_s, bound_s, self._began_s)

    @property
    def is_busy(self) -> bool:
        """See :class:`PartNode`."""
        return self.memory.trial is not None and self.memory.status is TrialStatus.BUILDING

    def health(self) -> Health:
        """See :class:`PartNode`; the peers are those of ``wait_for``."""
        missing = self._attendance.missing
        present = [name for name in self.values['wait_for'] if name not in missing]
        values = {
            'trials_ended': self._ended,
            'trials_not_rebuilt': self._failures,
            'paused': self._holding.until is not None,
        }
        health = super().health()
        return replace(
            health,
            present=present,
            missing=missing,
            failure=self._trouble,
            values={**health.values, **values},
        )

    def finish(self) -> None:
        """Before shutdown: wait until all nodes have received the last outcome."""
        self.wait_until_heard(OUTCOME)
        self._records.close()


def main() -> None:
    """Run the node until its script is done, or SIGINT or SIGTERM."""
    run(TrialOrchestrator)


if __name__ == '__main__':
    main()
