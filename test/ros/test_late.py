"""Messages that come late, from an earlier run of a trial, and boards that are set back."""

from __future__ import annotations

import threading
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, ended, spec
from peers import Bench, Graph
from rclpy.parameter import Parameter

from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.nodes.trial_orchestrator import TrialOrchestrator
from blocks_planning.ros.wire.graph import ACTION_SEARCHER
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, PlaceBlock, TrialStarted, WorldState

SPEC, OTHER = spec(CHAIR, lam=0.2, depth=2), spec(CHAIR, lam=0.2, depth=2, seed=1)
HEARD: list[Message] = []
RECORD = run_trial(SPEC, observe=HEARD.append)
STATES = [message for message in HEARD if isinstance(message, WorldState)]
FIRST = next(message for message in HEARD if isinstance(message, SubgoalChosen))
STARTED, FOREIGN = (TrialStarted(one.trial_id, one) for one in (SPEC, OTHER))
END, FOREIGN_END = (ended(one.trial_id, RECORD) for one in (SPEC, OTHER))


def searcher(graph: Graph, remind_period_s: float) -> Bench:
    """A searcher, with its peer."""
    overrides = [Parameter('remind_period_s', value=remind_period_s)]
    node = graph.add(ActionSearcher, parameter_overrides=overrides)
    return Bench(graph, ACTION_SEARCHER, node, SPEC)


@pytest.mark.parametrize('late', [STATES[-1], FIRST.begun(3, 1)], ids=['state', 'subgoal'])
def test_late_message_is_not_kept_for_the_next_run_of_its_trial(graph: Graph, late: Any) -> None:
    """The same script, run again by another orchestrator, has the same trials."""
    on = searcher(graph, 3600.0)
    on.tell(STARTED, END, FOREIGN, late, FOREIGN_END, STARTED)
    assert on.node.memory.state is None
    assert on.node.memory.chosen is None
    on.tell(STATES[0], FIRST)
    assert on.hear(1, PlaceBlock)[0].sequence == 0


def test_first_state_may_come_before_the_trial_is_announced_again(graph: Graph) -> None:
    on = searcher(graph, 3600.0)
    on.tell(STARTED, END, FOREIGN, STATES[0], FOREIGN_END, STARTED)
    graph.spin_until(lambda: on.node.memory.state == STATES[0])


def test_node_starts_over_when_the_board_was_set_back(
    graph: Graph, capfd: pytest.CaptureFixture[str]
) -> None:
    """What it took for the latest state was of an earlier run, or the world lost its board."""
    on = searcher(graph, 0.05)
    on.tell(STARTED, FIRST, STATES[-1])
    on.tell(STATES[0], STATES[0])
    graph.spin_until(lambda: on.node.memory.state is None)
    on.tell(STATES[0], FIRST)
    graph.spin_until(lambda: any(order.sequence == 0 for order in on.peer.only(PlaceBlock)))
    assert 'the board was reset' in capfd.readouterr().err


def test_one_state_that_was_overtaken_changes_nothing(graph: Graph) -> None:
    on = searcher(graph, 0.05)
    on.tell(STARTED, STATES[-1], STATES[0])
    reminded: list[None] = []
    on.node.create_timer(0.06, lambda: reminded.append(None), clock=on.node.steady)
    graph.spin_until(lambda: len(reminded) > 5)
    assert on.node.memory.state == STATES[-1]


def test_a_trial_that_runs_again_may_go_another_way(graph: Graph) -> None:
    """In a world that does not obey; what was observed in the first run is void."""
    on = searcher(graph, 3600.0)
    on.tell(STARTED, *STATES[:3], END, STARTED)
    other = next(
        state
        for seed in range(1, 20)
        for state in _states_of(seed)
        if state.sequence == 1 and state.placements != STATES[1].placements
    )
    refused = on.node.refused
    changed = WorldState(SPEC.trial_id, *list(vars(other).values())[1:])
    on.peer.say(changed)
    graph.spin_until(lambda: on.node.memory.state == changed)
    assert on.node.refused == refused


def _states_of(seed: int) -> list[WorldState]:
    heard: list[Message] = []
    run_trial(spec(CHAIR, lam=0.2, depth=2, seed=seed), observe=heard.append)
    return [message for message in heard if isinstance(message, WorldState)]


def test_trial_starts_over_when_a_world_without_journal_was_killed(
    graph: Graph, tmp_path: Path
) -> None:
    placing = {'parameter_overrides': [Parameter('placing_s', value=0.1)]}
    first = graph.add(world.make_node, **placing)
    graph.add(subgoal_selector.make_node)
    graph.add(ActionSearcher)
    overrides = [Parameter('out_dir', value=str(tmp_path)), Parameter('wait_for', value=['world'])]
    orchestrator = graph.add(
        lambda **options: TrialOrchestrator(
            threading.Event(), parameter_overrides=overrides, **options
        )
    )
    orchestrator.start_trial(SPEC.trial_id, SPEC)
    graph.spin_until(lambda: orchestrator.memory.state and orchestrator.memory.state.sequence > 1)
    graph.remove(first)
    graph.add(world.make_node)
    graph.spin_until(lambda: not orchestrator.is_busy)
    assert (tmp_path / 'trials.jsonl').read_text(encoding='utf-8') == RECORD.to_line() + '\n'
