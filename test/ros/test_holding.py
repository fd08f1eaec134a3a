"""Pause, resume and step."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, spec
from peers import Graph, Peer
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.runtime.holding import Holding
from blocks_planning.ros.wire.topics import ACTION, HOLD
from blocks_planning.trials import searcher
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Held, Message, PlaceBlock

SPEC = spec(CHAIR, lam=0.2, depth=2)
HEARD: list[Message] = []
RECORD = run_trial(SPEC, observe=HEARD.append)
FAST = [Parameter('remind_period_s', value=0.1)]


def test_pause_holds_from_a_state_on() -> None:
    holding = Holding()
    assert holding.until is None
    assert holding.step(3) == ''
    assert holding.pause(3)
    assert holding.until == 3


def test_each_step_is_one_order() -> None:
    holding = Holding()
    holding.pause(3)
    holding.step(3)
    holding.step(3)  # before the first was carried out
    assert holding.until == 5
    holding.step(7)  # the board has changed by itself
    assert holding.until == 8


def test_pause_outlasts_its_trial_until_it_is_resumed() -> None:
    holding = Holding()
    holding.pause(3)
    seen = []
    for _ in range(2):
        holding.begin()
        seen.append((holding.until, holding.resume(0)))
    assert seen == [(0, 'resumed'), (None, 'was not paused')]


@pytest.mark.parametrize('until', [0, 1, 4])
def test_searcher_orders_up_to_the_state_that_is_held(until: int) -> None:
    memory = searcher.Memory()
    ordered = []
    for message in [HEARD[0], Held(SPEC.trial_id, until), *HEARD[1:]]:
        memory, said = searcher.step(memory, message)
        ordered += [one.sequence for one in said if isinstance(one, PlaceBlock)]
    assert ordered == list(range(until))


def test_searcher_orders_at_once_when_it_may_again() -> None:
    memory = searcher.Memory()
    before = HEARD[1 : next(i for i, one in enumerate(HEARD) if isinstance(one, PlaceBlock))]
    for message in [HEARD[0], Held(SPEC.trial_id, 0), *before]:
        memory, _ = searcher.step(memory, message)
    memory, said = searcher.step(memory, Held(SPEC.trial_id, 0))
    assert said == ()
    memory, said = searcher.step(memory, Held('another'))
    assert said == ()
    _, said = searcher.step(memory, Held(SPEC.trial_id))
    assert [one.sequence for one in said if isinstance(one, PlaceBlock)] == [0]


class Paused:
    """A graph whose orchestrator is asked."""

    def __init__(self, graph: Graph, folder: Path) -> None:
        self.graph = graph
        self.world = graph.add(world.make_node, parameter_overrides=FAST)
        graph.add(subgoal_selector.make_node, parameter_overrides=FAST)
        self.searcher = graph.add(ActionSearcher, parameter_overrides=FAST)
        self.folder = folder
        self.node = self.add_orchestrator()
        self.peer = graph.add(Peer, SPEC, (), (ACTION, HOLD))

    def add_orchestrator(self) -> TrialOrchestrator:
        """One that sees all others."""
        overrides = [*FAST, Parameter('out_dir', value=str(self.folder))]
        node = self.graph.add(
            lambda **options: TrialOrchestrator(
                threading.Event(), parameter_overrides=overrides, **options
            )
        )
        nodes = ['world', 'subgoal_selector', 'action_searcher']
        self.graph.spin_until(lambda: not node.peers.missing(nodes))
        return node

    def ask(self, name: str) -> Any:
        """Call a service."""
        client = self.peer.create_client(Trigger, name)
        self.graph.spin_until(client.service_is_ready)
        asking = client.call_async(Trigger.Request())
        self.graph.spin_until(asking.done)
        return asking.result()

    def is_at(self, sequence: int) -> None:
        """Wait until the searcher waits in a state, and for some reminders more."""
        self.graph.spin_until(lambda: self.searcher.memory.chosen is not None)
        self.graph.spin_until(lambda: self.world.memory.state.sequence == sequence)
        for _ in range(100):
            self.graph.spin_some()
        assert self.world.memory.state.sequence == sequence


def test_trial_goes_step_by_step_to_the_same_record(graph: Graph, tmp_path: Path) -> None:
    on = Paused(graph, tmp_path)
    refused = on.ask('step')
    assert (refused.success, refused.message.startswith('step needs a pause')) == (False, True)
    assert on.ask('pause').success
    on.node.start_trial(SPEC.trial_id, SPEC)
    on.is_at(0)
    for sequence in (1, 2):
        assert on.ask('step').success
        on.is_at(sequence)
    assert [*{order.sequence for order in on.peer.only(PlaceBlock)}] == [0, 1]
    assert on.node.health().values['paused'] is True
    assert on.ask('resume').message == 'resumed'
    graph.spin_until(lambda: not on.node.is_busy)
    assert on.node.memory.record().to_line() == RECORD.to_line()


def test_orchestrator_that_was_restarted_is_not_paused(graph: Graph, tmp_path: Path) -> None:
    """The searcher hears so, though it has been told otherwise in the same trial."""
    on = Paused(graph, tmp_path)
    on.ask('pause')
    on.node.start_trial(SPEC.trial_id, SPEC)
    on.is_at(0)
    graph.remove(on.node)
    node = on.add_orchestrator()
    node.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: not node.is_busy)
    assert node.memory.record().to_line() == RECORD.to_line()
