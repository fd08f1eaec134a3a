"""Node ``trial_orchestrator``: which trial runs, and its record.

With a ``script`` it runs the script's trials in order, leaves out those whose records are in
``trials.jsonl`` already, and ends the process. Without, it waits for goals; one at a time.

| | |
|---|---|
| listens | `state`, `subgoal` (latched) |
| says | `trial`, `outcome` (latched) |
| action | `run_trial`: feedback with every state and subgoal; cancelling ends the trial |
| parameters | `remind_period_s`; `script`; `out_dir`: where `trials.jsonl` is; `wait_for`: nodes that must be there before a trial begins; `peer_timeout_s`: how long it waits for them |
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from blocks_planning_msgs.action import RunTrial
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.task import Future

from blocks_planning.errors import InvalidInput
from blocks_planning.ros.conversions.board import state_to_ros
from blocks_planning.ros.conversions.decisions import subgoal_to_ros
from blocks_planning.ros.conversions.trial import outcome_to_ros, spec_from_ros
from blocks_planning.ros.graph import TRIAL_ORCHESTRATOR
from blocks_planning.ros.parameters import Parameter
from blocks_planning.ros.part_node import PartNode
from blocks_planning.ros.peers import missing_peers
from blocks_planning.ros.runtime import run
from blocks_planning.ros.topics import OUTCOME
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
from blocks_planning.trials.script import read_script
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

RECORDS = 'trials.jsonl'
SCRIPT = Parameter('script', '', 'A trial script to run; none: wait for goals.')
OUT_DIR = Parameter('out_dir', '.', 'Folder of trials.jsonl.')
WAIT_FOR = Parameter(
    'wait_for',
    ['world', 'subgoal_selector', 'action_searcher'],
    'Nodes that must be there before a trial begins.',
)
PEER_TIMEOUT = Parameter('peer_timeout_s', 30.0, 'How long to wait for them [s].', (0.1, 86400.0))
PARAMETERS = (SCRIPT, OUT_DIR, WAIT_FOR, PEER_TIMEOUT)
_LOOK_PERIOD_S = 0.02


class TrialOrchestrator(PartNode):
    """The scribe, with trials to run."""

    def __init__(self, stop: threading.Event, **options: Any) -> None:
        """See :class:`PartNode`; ``stop`` is set when a script is done."""
        super().__init__(TRIAL_ORCHESTRATOR, scribe, PARAMETERS, **options)
        self.exit_code = 0
        self._stop = stop
        self._records = RecordFile(Path(self.values['out_dir']) / RECORDS)
        self._script: Iterator[TrialSpec] | None = None
        if self.values['script']:
            specs = read_script(Path(self.values['script']))
            self._script = (s for s in specs if s.trial_id not in self._records.finished)
        self._goal: Any = None
        self._done: Future | None = None
        self._failures = 0
        self._began_ns = self._now_ns()
        self._looking = self.create_timer(_LOOK_PERIOD_S, self._look_for_peers, clock=self.steady)
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
        record = self.memory.record()
        self._records.append(record)
        outcome = outcome_to_ros(message.trial_id, record)
        self.publish(OUTCOME, outcome)
        self._latched.clear()  # nobody is to begin again
        self._failures += record.status is not TrialStatus.SUCCESS
        if self._done is not None:
            self._done.set_result(outcome)
        elif self._script is not None:
            self._next_of_script()

    def _next_of_script(self) -> None:
        spec = next(self._script, None) if self._script is not None else None
        if spec is None:
            self.exit_code = int(self._failures > 0)
            self._stop.set()
        else:
            self.start_trial(spec.trial_id, spec)

    def _look_for_peers(self) -> None:
        """Begin the script as soon as everybody is there."""
        missing = missing_peers(self, self.values['wait_for'])
        waited_s = (self._now_ns() - self._began_ns) / 1e9
        if missing and waited_s < self.values['peer_timeout_s']:
            return
        self._looking.cancel()
        if missing and self._script is not None:
            self.get_logger().error(f'waited {waited_s:.0f} s for {", ".join(missing)}')
            self.exit_code = 1
            self._stop.set()
        elif self._script is not None:
            self._next_of_script()

    def _now_ns(self) -> int:
        return int(self.steady.now().nanoseconds)

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
        if outcome.status == TrialStatus.CANCELLED.value:
            goal.canceled()
        else:
            goal.succeed()
        return RunTrial.Result(outcome=outcome)


def main() -> None:
    """Run the node until its script is done, or SIGINT or SIGTERM."""
    run(TrialOrchestrator)


if __name__ == '__main__':
    main()
