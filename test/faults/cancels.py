"""Goals that are cancelled at any moment, one after the other, on a graph of processes.

``python -m faults.cancels COUNT SEED`` (in ``test/``) sends COUNT goals, most of them of searches
that take days, cancels each at a moment of its own, and looks how long the answer takes. The next
goal must be accepted, and every tenth is run to its end.
"""

from __future__ import annotations

import os
import random
import signal
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import Any

import peers
from blocks_planning_msgs.action import RunTrial
from builders import CHAIR, spec
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from blocks_planning.ros.runtime.processes import NodeProcess, stop_all
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.trials.local import run_trial

BOUND_S = 0.2
DEADLINE_S = 30.0
LONGEST_WAIT_S = 0.05
WHOLE = '/'.join(['#' * 16] * 16)
LONG = [
    spec(WHOLE, strategy='none', depth=12, budget=10**15),
    spec(WHOLE, strategy='scoping', lam=0.002, search='random', budget=10**15),
    spec(WHOLE, strategy='full', lam=0.5, search='astar', iterations=10**6, budget=10**15),
]
"""Searches that take days."""
SHORT = spec(CHAIR, lam=0.2, depth=2)


@contextmanager
def nodes(
    folder: Path, namespace: str, names: tuple[str, ...] = ()
) -> Iterator[dict[str, NodeProcess]]:
    """Nodes as processes, in the domain of this one; all of them if none is named."""
    environment = {**peers.DOMAIN.environment(os.environ), 'ROS_LOG_DIR': str(folder / 'log')}
    place = ['-r', f'__ns:={namespace}']
    arguments = {
        'world': ['-p', f'journal_dir:={folder / "journal"}'],
        'trial_orchestrator': ['-p', f'out_dir:={folder}'],
    }
    found = {
        name: NodeProcess(name, [*place, *arguments.get(name, [])], environment)
        for name in names or ('world', 'subgoal_selector', 'action_searcher', 'trial_orchestrator')
    }
    try:
        for process in found.values():
            process.start()
        yield found
    finally:
        stop_all(list(found.values()))


class Caller(Node):
    """Asks for trials, and cancels them."""

    def __init__(self, namespace: str) -> None:
        context = peers.context_of('peers')
        super().__init__('caller', namespace=namespace, context=context)
        self.client = ActionClient(self, RunTrial, 'run_trial')
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(self)

    def spin_until(self, condition: Callable[[], object]) -> None:
        """Spin until a condition holds."""
        end = time.monotonic() + DEADLINE_S
        while not condition():
            assert time.monotonic() < end, f'not within {DEADLINE_S} s'
            self._executor.spin_once(timeout_sec=0.01)

    def ask(self, trial: Any) -> Any:
        """A goal that was accepted."""
        sending = self.client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', trial)))
        self.spin_until(sending.done)
        assert sending.result().accepted, 'a goal was rejected'
        return sending.result()

    def cancel(self, goal: Any) -> tuple[float, int]:
        """Cancel a goal; return the seconds until its result is there, and its status."""
        result = goal.get_result_async()
        began = time.monotonic()
        goal.cancel_goal_async()
        self.spin_until(result.done)
        return time.monotonic() - began, result.result().status

    def finish(self, goal: Any) -> Any:
        """The outcome of a goal that is run to its end."""
        result = goal.get_result_async()
        self.spin_until(result.done)
        return result.result().result.outcome


def cancel_often(folder: Path, count: int, seed: int) -> tuple[list[float], Counter[int]]:
    """Cancel goals; return the time that each answer took [s], and the statuses."""
    chance = random.Random(seed)
    namespace = f'/cancels_{seed}'
    expected = run_trial(SHORT).action_planning_cost
    taken, statuses = [], Counter[int]()
    with nodes(folder, namespace):
        caller = Caller(namespace)
        caller.spin_until(caller.client.server_is_ready)
        assert caller.finish(caller.ask(SHORT)).status == 'success'
        for number in range(count):
            goal = caller.ask(SHORT if chance.random() < 0.2 else chance.choice(LONG))
            moment = time.monotonic() + chance.choice((0.0, chance.uniform(0, LONGEST_WAIT_S)))
            caller.spin_until(lambda moment=moment: time.monotonic() >= moment)  # type: ignore[misc]
            seconds, status = caller.cancel(goal)
            taken.append(seconds)
            statuses[status] += 1
            if number % 10 == 9:
                outcome = caller.finish(caller.ask(SHORT))
                assert (outcome.status, outcome.action_planning_cost) == ('success', expected)
    return taken, statuses


def main() -> int:
    """Print what came of it; return 1 if an answer took too long."""
    count, seed = (*map(int, sys.argv[1:]), *(1000, 0)[len(sys.argv) - 1 :])[:2]
    began = time.monotonic()
    with tempfile.TemporaryDirectory() as folder:
        taken, statuses = cancel_often(Path(folder), count, seed)
    taken.sort()
    late = sum(seconds > BOUND_S for seconds in taken)
    sys.stdout.write(
        f'cancelled: {statuses[GoalStatus.STATUS_CANCELED]} of {count} goals in '
        f'{time.monotonic() - began:.0f} s (seed {seed}), over before: '
        f'{statuses[GoalStatus.STATUS_SUCCEEDED]}\n'
        f'answer: median {1000 * median(taken):.1f} ms, 99 % within '
        f'{1000 * taken[int(0.99 * (count - 1))]:.1f} ms, slowest {1000 * taken[-1]:.1f} ms\n'
        f'later than {BOUND_S} s: {late}\n'
    )
    return int(late > 0 or sum(statuses.values()) != count)


if __name__ == '__main__':
    peers.exit_status = 1
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # take the nodes down first
    peers.exit_status = main()
