"""A search of days ends as soon as it is told to, in a process of its own."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path
from statistics import median

from peers import DEADLINE_S, Graph, Peer
from rclpy.action.client import GoalStatus

from blocks_planning.ros.wire.topics import SEARCH_REQUEST, TRIAL
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.messages import SearchRequest, TrialStarted
from faults.cancels import BOUND_S, LONG, cancel_often, nodes

STOP_S = 1.0
CLOCK_TICKS = os.sysconf('SC_CLK_TCK')


def _worked_s(pid: int) -> float:
    """Processor time that a process has used [s]."""
    words = Path(f'/proc/{pid}/stat').read_text(encoding='utf-8').rpartition(')')[2].split()
    return (int(words[11]) + int(words[12])) / CLOCK_TICKS


def test_goal_is_cancelled_at_any_moment_and_the_next_one_works(tmp_path: Path) -> None:
    taken, statuses = cancel_often(tmp_path, 20, seed=1)
    assert sum(statuses.values()) == 20
    assert set(statuses) <= {GoalStatus.STATUS_CANCELED, GoalStatus.STATUS_SUCCEEDED}
    assert statuses[GoalStatus.STATUS_CANCELED] >= 10
    assert median(taken) < BOUND_S


def test_searcher_leaves_a_long_search_when_it_is_told_to(graph: Graph, tmp_path: Path) -> None:
    trial = LONG[0]
    peer = graph.add(Peer, trial, (TRIAL, SEARCH_REQUEST), ())
    with nodes(tmp_path, graph.namespace, ('action_searcher',)) as started:
        process = started['action_searcher']
        graph.spin_until(
            lambda: all(outlet.get_subscription_count() for outlet in peer.outlets.values())
        )
        before = _worked_s(process.pid)
        peer.say(TrialStarted(trial.trial_id, trial))
        peer.say(SearchRequest(trial.trial_id, (Query(0, trial.task.silhouette),)))
        graph.spin_until(lambda: _worked_s(process.pid) - before > 0.5)
        began = time.monotonic()
        process.signal(signal.SIGTERM)
        process.wait(began + DEADLINE_S)
        assert process.exit_code() == 0
        assert time.monotonic() - began < STOP_S
