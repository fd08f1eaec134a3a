"""The orchestrator: goals, their feedback and results, and how they are cancelled."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from blocks_planning_msgs.action import RunTrial
from builders import EMPTY, NEVER_SOLVED, spec
from carried import sent
from part_nodes import FOREIGN, HEARD, RECORD, TRIAL_SPEC, by_topic, foreign
from peers import Bench, Graph
from rclpy.action.client import ActionClient, GoalStatus
from rclpy.node import Node
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.graph import TRIAL_ORCHESTRATOR
from blocks_planning.ros.wire.topics import STATE, SUBGOAL
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import CancelTrial, TrialEnded, TrialStarted, WorldState
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus

LONG = spec('/'.join(['#' * 16] * 16), strategy='none', depth=12, budget=10**15)
"""A search that takes days."""


def make_orchestrator(folder: Path, **options: Any) -> TrialOrchestrator:
    """The orchestrator, with its records in a folder."""
    overrides = [Parameter('out_dir', value=str(folder)), Parameter('wait_for', value=['peer'])]
    return TrialOrchestrator(threading.Event(), parameter_overrides=overrides, **options)


def test_orchestrator_gives_feedback_and_a_result(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    feedback: list[Any] = []
    sending = client.send_goal_async(
        RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)), feedback_callback=feedback.append
    )
    graph.spin_until(sending.done)
    (trial,) = on.hear(1, TrialStarted)
    assert trial.spec == TRIAL_SPEC
    assert trial.trial_id.startswith(TRIAL_SPEC.trial_id)
    followed = [m for m in HEARD if isinstance(m, (WorldState, SubgoalChosen))]
    for message in followed:
        on.peer.say(replace(message, trial_id=trial.trial_id))
    result = sending.result().get_result_async()
    graph.spin_until(result.done)
    assert result.result().status == GoalStatus.STATUS_SUCCEEDED
    outcome = result.result().result.outcome
    assert outcome.status == 'success'
    assert outcome.action_planning_cost == RECORD.action_planning_cost
    assert outcome.subgoal_planning_cost == RECORD.subgoal_planning_cost
    graph.spin_until(lambda: len(feedback) >= len(followed) - 1)
    costs = [f.feedback.action_planning_cost for f in feedback]
    assert costs == sorted(costs)
    assert on.hear(1, TrialEnded) == [TrialEnded(trial.trial_id, TrialStatus.SUCCESS)]
    assert (tmp_path / 'trials.jsonl').read_text() == RECORD.to_line() + '\n'


def test_goal_that_cannot_be_run_is_aborted_with_the_reason(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    changes: list[tuple[Callable[[Any], None], str]] = [
        (lambda trial: setattr(trial.silhouette, 'width', 0), 'silhouette.width: '),
        (lambda trial: setattr(trial.planner, 'strategy', 'luck'), 'planner.strategy: '),
        (
            lambda trial: setattr(
                trial.planner.strategy_settings[0], 'double_value', float('nan')
            ),
            'planner.strategy: lambda must be ',
        ),
        (lambda trial: setattr(trial, 'library', []), 'library: '),
    ]
    for count, (change, reason) in enumerate(changes, start=1):
        trial = sent(spec_to_ros('', TRIAL_SPEC))
        change(trial)
        ended = end_of(graph, client, trial)
        assert ended.status == GoalStatus.STATUS_ABORTED
        outcome = ended.result.outcome
        assert (outcome.status, outcome.code) == ('refused', outcome.CODE_REFUSED)
        assert outcome.reason.startswith(reason)
        assert on.node.refused == count
    assert on.peer.only(TrialStarted) == []


def test_orchestrator_runs_one_goal_at_a_time(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    first = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
    graph.spin_until(first.done)
    second = end_of(graph, client, spec_to_ros('', FOREIGN))
    assert second.status == GoalStatus.STATUS_ABORTED
    assert second.result.outcome.reason == 'a trial is running'
    assert len(on.hear(1, TrialStarted)) == 1
    first.result().cancel_goal_async()
    ended = first.result().get_result_async()
    graph.spin_until(ended.done)
    assert ended.result().status == GoalStatus.STATUS_CANCELED


def test_orchestrator_ignores_what_is_stale_or_foreign(graph: Graph, tmp_path: Path) -> None:
    on, client = with_client(graph, tmp_path)
    sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
    graph.spin_until(sending.done)
    (trial,) = on.hear(1, TrialStarted)
    states = [replace(m, trial_id=trial.trial_id) for m in by_topic(HEARD)[WorldState]]
    on.peer.say(states[1])
    on.peer.say(states[0])
    on.peer.say(foreign(states[2]))
    on.peer.outlets[STATE].publish(STATE.ros_type(trial_id=trial.trial_id))
    graph.spin_until(lambda: on.node.refused == 1)
    assert on.node.memory.state == states[1]
    on.peer.outlets[SUBGOAL].publish(SUBGOAL.ros_type(trial_id=trial.trial_id))
    graph.spin_until(lambda: on.node.refused == 2)
    assert on.node.memory.chosen is None


def test_orchestrator_ends_a_trial_that_needs_nothing(graph: Graph, tmp_path: Path) -> None:
    """The target is complete before anything is decided."""
    everybody(graph, tmp_path)
    client = graph.add(Caller).client
    graph.spin_until(client.server_is_ready)
    assert outcome_of(graph, client, spec(EMPTY)).status == 'success'
    ended = end_of(graph, client, spec_to_ros('', spec(NEVER_SOLVED)))
    assert ended.status == GoalStatus.STATUS_ABORTED  # its tower was not built
    outcome = ended.result.outcome
    assert (outcome.status, outcome.code) == ('gave_up', outcome.CODE_GAVE_UP)
    assert outcome.reason == 'no subgoal could be solved'
    assert outcome_of(graph, client, TRIAL_SPEC).status == 'success'


def test_cancel_ends_a_long_search_at_once(graph: Graph, tmp_path: Path) -> None:
    """And everything is usable again."""
    _, searching = everybody(graph, tmp_path)
    client = graph.add(Caller).client
    graph.spin_until(client.server_is_ready)
    for _ in range(2):
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', LONG)))
        graph.spin_until(sending.done)
        graph.spin_until(lambda: searching.memory.solving)
        cancelling = sending.result().cancel_goal_async()
        result = sending.result().get_result_async()
        graph.spin_until(result.done, deadline_s=2.0)
        graph.spin_until(cancelling.done)
        assert len(cancelling.result().goals_canceling) == 1
        assert result.result().status == GoalStatus.STATUS_CANCELED
        assert result.result().result.outcome.status == 'cancelled'
        assert outcome_of(graph, client, TRIAL_SPEC).status == 'success'
    statuses = [
        re.search(r'"status":"(\w+)"', line)[1]  # type: ignore[index]
        for line in (tmp_path / 'trials.jsonl').read_text().splitlines()
    ]
    assert statuses == ['cancelled', 'success'] * 2


def test_orchestrator_cancels_a_goal_that_nobody_works_on(graph: Graph, tmp_path: Path) -> None:
    _, client = with_client(graph, tmp_path)
    for _ in range(3):
        sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
        graph.spin_until(sending.done)
        assert sending.result().accepted
        result = sending.result().get_result_async()
        sending.result().cancel_goal_async()
        graph.spin_until(result.done, deadline_s=2.0)
        assert result.result().status == GoalStatus.STATUS_CANCELED


def test_goal_whose_trial_cannot_go_on_is_aborted_with_the_reason(
    graph: Graph, tmp_path: Path
) -> None:
    """Its caller did not cancel it."""
    on, client = with_client(graph, tmp_path)
    sending = client.send_goal_async(RunTrial.Goal(trial=spec_to_ros('', TRIAL_SPEC)))
    graph.spin_until(sending.done)
    (trial,) = on.hear(1, TrialStarted)
    on.node.take(CancelTrial(trial.trial_id, 'the world is on fire'))
    result = sending.result().get_result_async()
    graph.spin_until(result.done)
    assert result.result().status == GoalStatus.STATUS_ABORTED
    outcome = result.result().result.outcome
    assert (outcome.status, outcome.reason) == ('cancelled', 'the world is on fire')


class Caller(Node):
    """A node that asks for trials."""

    def __init__(self, **options: Any) -> None:
        super().__init__('caller', **options)
        self.client = ActionClient(self, RunTrial, 'run_trial')


def everybody(graph: Graph, folder: Path) -> tuple[TrialOrchestrator, ActionSearcher]:
    """All nodes of the graph."""
    for make_node in (world.make_node, subgoal_selector.make_node):
        graph.add(make_node)
    searching = graph.add(ActionSearcher)
    return graph.add(make_orchestrator, folder), searching


def with_client(graph: Graph, folder: Path) -> tuple[Bench, ActionClient]:
    """The orchestrator with its peer, and somebody who asks for trials."""
    on = Bench(graph, TRIAL_ORCHESTRATOR, graph.add(make_orchestrator, folder), TRIAL_SPEC)
    client = ActionClient(on.peer, RunTrial, 'run_trial')
    graph.spin_until(client.server_is_ready)
    return on, client


def end_of(graph: Graph, client: ActionClient, trial: Any) -> Any:
    """Status and result of a goal."""
    sending = client.send_goal_async(RunTrial.Goal(trial=trial))
    graph.spin_until(sending.done)
    assert sending.result().accepted
    ending = sending.result().get_result_async()
    graph.spin_until(ending.done)
    return ending.result()


def outcome_of(graph: Graph, client: ActionClient, trial: TrialSpec) -> Any:
    """The outcome of a goal."""
    return end_of(graph, client, spec_to_ros('', trial)).result.outcome
