"""Orders by the action ``place``: an arm that does well, and those that do not."""

from __future__ import annotations

import importlib.util
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from blocks_planning_msgs.action import Place
from blocks_planning_msgs.msg import PlacementOutcome as Codes
from builders import CHAIR, spec
from peers import Graph, Peer
from rclpy.action.server import ActionServer, CancelResponse, GoalResponse
from rclpy.node import Node
from rclpy.parameter import Parameter
from source_imports import ROOT

from blocks_planning.board.blocks import Block, Placed
from blocks_planning.board.geometry import Board
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.runtime import arm as arm_module
from blocks_planning.ros.runtime.arm import Arm
from blocks_planning.ros.wire.conversions.place import order_to_ros
from blocks_planning.ros.wire.graph import TRIAL_ORCHESTRATOR
from blocks_planning.ros.wire.topics import ACTION_OUTCOME
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import ArmOrder, PlacementCode, PlacementOutcome
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.world import Observed

SPEC = replace(spec(CHAIR, lam=0.01, depth=2), world=Observed())
FAST = [Parameter('remind_period_s', value=0.1)]
NODES = ['world', 'subgoal_selector', 'action_searcher']


class Trial:
    """A trial whose world asks an arm."""

    def __init__(self, graph: Graph, folder: Path, **parameters: Any) -> None:
        self.graph = graph
        journal = Parameter('journal_dir', value=str(folder / 'journal'))
        self.world = graph.add(world.make_node, parameter_overrides=[*FAST, journal])
        graph.add(subgoal_selector.make_node, parameter_overrides=FAST)
        graph.add(ActionSearcher, parameter_overrides=FAST)
        values = {'out_dir': str(folder), 'wait_for': NODES, 'retries': 1, **parameters}
        overrides = [*FAST, *(Parameter(name, value=value) for name, value in values.items())]
        self.node = graph.add(
            lambda **options: TrialOrchestrator(
                threading.Event(), parameter_overrides=overrides, **options
            )
        )
        self.peer = graph.add(Peer, SPEC, (), (ACTION_OUTCOME, *TRIAL_ORCHESTRATOR.says))
        graph.spin_until(lambda: not self.node.peers.missing(NODES))
        graph.spin_until(lambda: self.peer.count_publishers('action/outcome'))

    def run(self) -> TrialRecord:
        """Run it to its end; the record holds."""
        self.node.start_trial(SPEC.trial_id, SPEC)
        self.graph.spin_until(lambda: not self.node.is_busy and not self.world.is_busy)
        for _ in range(20):  # a goal that was on its way is taken, or its coroutine is lost
            self.graph.spin_some()
        record: TrialRecord = self.node.memory.record()
        assert list(contradictions(record)) == []
        return record

    @property
    def outcomes(self) -> list[PlacementOutcome]:
        """What was said of orders."""
        return self.peer.only(PlacementOutcome)


def clumsy_arm(**options: Any) -> Any:
    """The example of the documentation."""
    path = ROOT / 'docs' / 'examples' / 'clumsy_arm.py'
    found = importlib.util.spec_from_file_location('clumsy_arm', path)
    assert found is not None
    assert found.loader is not None
    module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module.ClumsyArm(**options)


def add_clumsy_arm(graph: Graph, **parameters: int) -> Any:
    overrides = [Parameter(name, value=value) for name, value in parameters.items()]
    return graph.add(clumsy_arm, parameter_overrides=overrides)


def test_arm_builds_what_is_ordered(graph: Graph, tmp_path: Path) -> None:
    """The record is that of a world that obeys, but for the world."""
    add_clumsy_arm(graph)
    trial = Trial(graph, tmp_path, retries=1000)
    record = trial.run()
    simulated = run_trial(replace(SPEC, world=spec(CHAIR).world))
    assert record.observations == simulated.observations
    assert record.decisions == simulated.decisions
    assert record.status is TrialStatus.SUCCESS
    told = [outcome.code for outcome in trial.outcomes]
    assert PlacementCode.IN_PROGRESS in told
    assert told[-1] is PlacementCode.PLACED


@pytest.mark.parametrize(
    ('clumsy', 'code', 'ends'),
    [
        ({'slips_at': 1}, PlacementCode.SLIPPED, [TrialStatus.SUCCESS, TrialStatus.GAVE_UP]),
        ({'loses_at': 2}, PlacementCode.LOST, [TrialStatus.SUCCESS]),
        ({'topples_at': 2}, PlacementCode.COLLAPSED, [TrialStatus.COLLAPSED]),
    ],
)
def test_arm_that_slips_loses_or_topples(
    graph: Graph, tmp_path: Path, clumsy: dict[str, int], code: PlacementCode, ends: list[Any]
) -> None:
    add_clumsy_arm(graph, **clumsy)
    trial = Trial(graph, tmp_path, retries=1000)
    assert trial.run().status in ends
    graph.spin_until(lambda: code in [outcome.code for outcome in trial.outcomes])


class WrongArm(Node):
    """Answers every goal with the same result, or never."""

    def __init__(self, result: Place.Result | None, accepts: bool = True, **options: Any) -> None:
        super().__init__('wrong_arm', **options)
        self.result = result
        self.cancelled = False
        self.goals: list[Any] = []
        self.server = ActionServer(
            self,
            Place,
            'place',
            execute_callback=self._finish,
            goal_callback=lambda _: GoalResponse.ACCEPT if accepts else GoalResponse.REJECT,
            handle_accepted_callback=self._accept,
            cancel_callback=self._cancel,
        )

    def _accept(self, goal: Any) -> None:
        self.goals.append(goal)
        if self.result is not None:
            goal.execute()

    def _finish(self, goal: Any) -> Any:
        goal.succeed()
        return self.result

    def _cancel(self, goal: Any) -> Any:
        self.cancelled = True
        return CancelResponse.ACCEPT


def floats() -> Any:
    """A block that rests on nothing."""
    there = order_to_ros(ArmOrder('', 0, Placed(1, 1, 0, 3)), 1.0).placement
    return Place.Result(code=Codes.CODE_PLACED, landed=[there])


WRONG: dict[str, tuple[Callable[..., Any], str]] = {
    'nothing said': (lambda **o: WrongArm(Place.Result(), **o), 'result of the arm: code: exp'),
    'in progress': (
        lambda **o: WrongArm(Place.Result(code=Codes.CODE_IN_PROGRESS), **o),
        'result of the arm: code: expected',
    ),
    'floating': (lambda **o: WrongArm(floats(), **o), 'the arm reports what cannot be: block 1x1'),
    'failed': (
        lambda **o: WrongArm(Place.Result(code=Codes.CODE_FAILED, reason='no power'), **o),
        'no power',
    ),
    'rejected': (lambda **o: WrongArm(None, accepts=False, **o), 'the arm did not accept'),
    'no arm': (Node, 'no node serves the action place'),
}


@pytest.mark.parametrize('name', WRONG)
def test_trial_ends_with_what_is_wrong_with_the_arm(
    graph: Graph, tmp_path: Path, name: str
) -> None:
    make, reason = WRONG[name]
    graph.add(lambda **options: Node('no_arm', **options) if make is Node else make(**options))
    trial = Trial(graph, tmp_path, retries=20)
    record = trial.run()
    assert record.status is TrialStatus.CANCELLED
    assert reason in record.reason


def test_arm_is_stopped_when_its_trial_ends(graph: Graph, tmp_path: Path) -> None:
    arm = graph.add(lambda **options: WrongArm(None, **options))
    trial = Trial(graph, tmp_path, retries=1000)
    trial.node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: arm.goals)
    assert len(arm.goals) == 1
    trial.node.cancel_trial()
    graph.spin_until(lambda: arm.cancelled)


def test_order_that_is_repeated_is_one_goal(
    graph: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    orders: list[ArmOrder] = []
    carry_out = Arm.carry_out

    def counted(arm: Arm, order: ArmOrder, board: Board) -> None:
        orders.append(order)
        carry_out(arm, order, board)

    monkeypatch.setattr(Arm, 'carry_out', counted)
    arm = graph.add(lambda **options: WrongArm(None, **options))
    trial = Trial(graph, tmp_path, retries=1000)
    trial.node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: len(orders) >= 4)
    assert len(set(orders)) == 1
    graph.spin_until(lambda: arm.goals)
    assert len(arm.goals) == 1
    assert not arm.cancelled


def test_silent_arm_is_asked_again(
    graph: Graph, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may have been restarted, and know nothing of the order."""
    monkeypatch.setattr(arm_module, 'ASK_AGAIN_S', 0.2)
    arm = graph.add(lambda **options: WrongArm(None, **options))
    trial = Trial(graph, tmp_path, retries=1000)
    trial.node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: len(arm.goals) >= 2)
    first, second = (goal.request for goal in arm.goals[:2])
    assert (first.sequence, first.placement) == (second.sequence, second.placement)
    assert not arm.cancelled


def test_arm_that_was_restarted_is_asked_again(graph: Graph, tmp_path: Path) -> None:
    silent = graph.add(lambda **options: WrongArm(None, **options))
    trial = Trial(graph, tmp_path, retries=1000)
    trial.node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: silent.goals)
    graph.remove(silent)
    add_clumsy_arm(graph)
    graph.spin_until(lambda: not trial.node.is_busy)
    assert trial.node.memory.record().status is TrialStatus.SUCCESS


def test_world_that_was_killed_asks_for_the_same_order_again(graph: Graph, tmp_path: Path) -> None:
    """The arm carries it out once, and its observations are in the journal."""
    arm = add_clumsy_arm(graph, topples_at=3)
    trial = Trial(graph, tmp_path, retries=1000)
    trial.node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: arm.orders == 1)
    assert trial.world._journal is not None
    trial.world._journal.release()
    graph.remove(trial.world)
    journal = Parameter('journal_dir', value=str(tmp_path / 'journal'))
    graph.add(world.make_node, parameter_overrides=[*FAST, journal])
    graph.spin_until(lambda: not trial.node.is_busy)
    record = trial.node.memory.record()
    assert list(contradictions(record)) == []
    assert record.status is TrialStatus.COLLAPSED
    assert arm.orders == len(record.observations) - 1 == 3


def test_goal_is_in_metres_in_the_frame_of_the_board() -> None:
    goal = order_to_ros(ArmOrder('one', 3, Placed(2, 1, 3, 4)), 0.05)
    assert (goal.trial_id, goal.sequence, goal.cell_size) == ('one', 3, 0.05)
    assert (goal.placement.column, goal.placement.row) == (3, 4)
    assert (goal.placement.block.width, goal.placement.block.height) == Block(2, 1)
    at, size = goal.pose.position, goal.size
    assert [round(x, 9) for x in (at.x, at.y, at.z)] == [0.2, 0.025, 0.225]
    assert [round(x, 9) for x in (size.x, size.y, size.z)] == [0.1, 0.05, 0.05]
    assert goal.pose.orientation.w == 1.0
