"""Towers that are planned and not built."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest
from blocks_planning_msgs.action import PlanTower
from blocks_planning_msgs.msg import TrialOutcome
from builders import CHAIR, EMPTY, NEVER_SOLVED, spec
from carried import sent
from peers import Graph, Peer
from persons import human_spec
from rclpy.action.client import ActionClient, GoalStatus

from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.wire.conversions.cells import blocks_to_ros
from blocks_planning.ros.wire.conversions.trial import spec_to_ros
from blocks_planning.ros.wire.topics import ACTION, PLAN
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.world import Observed, Simulated

SPEC = spec(CHAIR, lam=0.2, depth=2)
RECORD = run_trial(SPEC)
LONG = spec('/'.join(['#' * 16] * 16), strategy='none', depth=12, budget=10**15)
"""A search that takes days."""
Ask = Callable[..., Any]


@pytest.fixture
def peer(graph: Graph) -> Peer:
    """Hears what is ordered; its node asks."""
    graph.add(ActionSearcher)
    return graph.add(Peer, SPEC, (), (ACTION, PLAN))


def ask(graph: Graph, peer: Peer, trial: TrialSpec, cancels: bool = False) -> tuple[Any, Any, Any]:
    """Status, result and feedback of a goal."""
    client = ActionClient(peer, PlanTower, 'plan_tower')
    graph.spin_until(client.server_is_ready)
    heard: list[Any] = []
    goal = PlanTower.Goal(trial=sent(spec_to_ros('', trial)))
    sending = client.send_goal_async(goal, lambda message: heard.append(message.feedback))
    graph.spin_until(sending.done)
    ending = sending.result().get_result_async()
    if cancels:
        graph.spin_until(lambda: heard)
        sending.result().cancel_goal_async()
    graph.spin_until(ending.done)
    assert peer.heard == []
    return ending.result().status, ending.result().result, heard


@pytest.mark.parametrize('world', [Simulated(), Simulated(slip=0.9), Observed()], ids=repr)
def test_plan_is_the_trial_in_a_world_that_obeys(graph: Graph, peer: Peer, world: Any) -> None:
    status, plan, heard = ask(graph, peer, replace(SPEC, world=world))
    assert (status, plan.code) == (GoalStatus.STATUS_SUCCEEDED, TrialOutcome.CODE_SUCCESS)
    assert plan.reason == 'the filled cells are the silhouette'
    assert plan.placements == blocks_to_ros(RECORD.placements)
    assert len(plan.decisions) == len(RECORD.decisions)
    for name in ('action_planning_cost', 'subgoal_planning_cost', 'solution_cost'):
        assert getattr(plan, name) == RECORD.summary()[name] > 0
    assert heard[-1].blocks <= len(plan.placements)


def test_plan_goes_on_from_what_is_built(graph: Graph, peer: Peer) -> None:
    built = RECORD.placements[:2]
    _, plan, _ = ask(graph, peer, replace(SPEC, built=built))
    assert plan.code == TrialOutcome.CODE_SUCCESS
    assert len(plan.placements) > 0
    assert not {(p.column, p.row) for p in plan.placements} & {(p.column, p.row) for p in built}


@pytest.mark.parametrize(
    ('trial', 'code', 'reason'),
    [
        (spec(NEVER_SOLVED), 'GAVE_UP', 'no subgoal could be solved'),
        (spec(NEVER_SOLVED, strategy='none'), 'STUCK', 'no legal placement is left'),
        (human_spec(CHAIR, depth=2), 'REFUSED', 'planner.strategy: human asks a person'),
    ],
    ids=['scoping', 'none', 'human'],
)
def test_what_cannot_be_planned_is_aborted(
    graph: Graph, peer: Peer, trial: TrialSpec, code: str, reason: str
) -> None:
    status, plan, _ = ask(graph, peer, trial)
    assert status == GoalStatus.STATUS_ABORTED
    assert plan.code == getattr(TrialOutcome, f'CODE_{code}')
    assert plan.reason.startswith(reason)


def test_empty_tower_needs_no_plan(graph: Graph, peer: Peer) -> None:
    status, plan, _ = ask(graph, peer, spec(EMPTY))
    assert (status, plan.placements) == (GoalStatus.STATUS_SUCCEEDED, [])


def test_long_plan_is_canceled_and_the_next_goal_is_planned(graph: Graph, peer: Peer) -> None:
    status, plan, _ = ask(graph, peer, LONG, cancels=True)
    assert (status, plan.code) == (GoalStatus.STATUS_CANCELED, TrialOutcome.CODE_CANCELLED)
    assert ask(graph, peer, SPEC)[0] == GoalStatus.STATUS_SUCCEEDED
