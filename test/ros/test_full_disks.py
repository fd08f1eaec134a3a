"""Disks that are full, and journals that cannot be right."""

from __future__ import annotations

from pathlib import Path

import pytest
from builders import ended
from disks import disk_of
from graphs import local_lines, record_lines, write_script
from orchestrators import Listener, orchestrator
from part_nodes import HEARD, RECORD, TRIAL_SPEC
from peers import Bench, Graph
from rclpy.parameter import Parameter

from blocks_planning.board.blocks import Placed
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.runtime.journal import Journal
from blocks_planning.ros.wire.graph import TRIAL_ORCHESTRATOR, WORLD
from blocks_planning.ros.wire.topics import OUTCOME
from blocks_planning.trials.execution import SubgoalChosen
from blocks_planning.trials.messages import (
    PlaceBlock,
    PlacementCode,
    PlacementOutcome,
    TrialStarted,
    WorldState,
)
from blocks_planning.worlds.observation import Observation


def world_with(graph: Graph, folder: Path) -> Bench:
    """A world with a journal, and its peer."""
    overrides = [Parameter('journal_dir', value=str(folder))]
    return Bench(
        graph, WORLD, graph.add(world.make_node, parameter_overrides=overrides), TRIAL_SPEC
    )


def placing(sequence: int) -> PlaceBlock:
    """An action of the trial."""
    return PlaceBlock(TRIAL_SPEC.trial_id, sequence, RECORD.placements[sequence].placement)


def test_world_that_can_not_write_its_journal_places_nothing(graph: Graph, tmp_path: Path) -> None:
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(TRIAL_SPEC.trial_id, TRIAL_SPEC), placing(0))
    (journal,) = tmp_path.glob('*.journal')
    before = journal.read_bytes()
    on.hear(2, WorldState)
    with disk_of(len(before) + 3):
        on.peer.say(placing(1))
        graph.spin_until(lambda: len(on.peer.only(PlacementOutcome)) == 2)
    failed = on.peer.only(PlacementOutcome)[-1]
    assert failed.failed
    assert failed.sequence == 1
    assert failed.reason == f'{journal}: cannot be written: File too large'
    assert journal.read_bytes() == before
    assert on.node.memory.state.sequence == 1
    on.tell(placing(1))  # there is room again
    assert on.hear(3, WorldState)[-1].placements == RECORD.placements[:2]


@pytest.mark.parametrize(
    'wrong', [Placed(1, 2, 0, 5), Placed(9, 9, 0, 0), Placed(4, 2, 15, 0)], ids=str
)
def test_journal_that_contradicts_the_task_is_set_aside(
    graph: Graph, tmp_path: Path, wrong: Placed
) -> None:
    """What others know of the board is more than the world does: it says so."""
    journal = Journal(tmp_path)
    journal.begin(TRIAL_SPEC.trial_id)
    for placed in (*RECORD.placements[:1], wrong):
        journal.append(Observation(placed.placement, (placed,)))
    journal.release()
    (path,) = tmp_path.glob('*.journal')
    content = path.read_bytes()
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(TRIAL_SPEC.trial_id, TRIAL_SPEC))
    assert on.hear(1, WorldState)[0].sequence == 0
    (aside,) = tmp_path.glob('*.aside-*')
    assert aside.read_bytes() == content
    on.tell(placing(2))
    (failed,) = on.hear(1, PlacementOutcome)
    assert failed.failed
    assert failed.reason.endswith(f'it was renamed to {aside.name}')
    on.tell(placing(0))
    assert on.hear(2, WorldState)[-1].placements == RECORD.placements[:1]
    on.peer.outlets[OUTCOME].publish(OUTCOME.to_ros(None, ended(TRIAL_SPEC.trial_id, RECORD)))
    graph.spin_until(lambda: not on.node.is_busy)
    on.tell(placing(2))
    assert len(on.peer.only(PlacementOutcome)) == 2


def test_world_with_its_journal_does_not_mind_what_is_to_come(
    graph: Graph, tmp_path: Path
) -> None:
    on = world_with(graph, tmp_path)
    on.tell(TrialStarted(TRIAL_SPEC.trial_id, TRIAL_SPEC), placing(2))
    on.tell(placing(0))
    assert [outcome.failed for outcome in on.hear(1, PlacementOutcome)] == [False]


def test_trial_ends_when_nothing_can_be_placed(graph: Graph, tmp_path: Path) -> None:
    """With what the world says; but not for what is stale."""
    node = orchestrator(graph, tmp_path, 'peer')
    listener = graph.add(Listener)
    on = Bench(graph, TRIAL_ORCHESTRATOR, node, TRIAL_SPEC)
    node.start_trial(TRIAL_SPEC.trial_id, TRIAL_SPEC)
    on.tell(*[m for m in HEARD if isinstance(m, (WorldState, SubgoalChosen))][:3])
    at = node.memory.state.sequence
    assert at == 1
    for sequence in (at - 1, at + 1):
        on.tell(
            PlacementOutcome(TRIAL_SPEC.trial_id, sequence, None, 'stale', PlacementCode.FAILED)
        )
    on.tell(
        PlacementOutcome(
            TRIAL_SPEC.trial_id, at, None, 'that block is impossible', PlacementCode.IMPOSSIBLE
        )
    )
    assert node.is_busy
    on.tell(
        PlacementOutcome(TRIAL_SPEC.trial_id, at, None, 'the arm is broken', PlacementCode.FAILED)
    )
    graph.spin_until(lambda: listener.outcomes)
    assert listener.outcomes[0].status == 'cancelled'
    assert listener.outcomes[0].reason == 'the arm is broken'


def test_script_ends_when_a_record_can_not_be_written(graph: Graph, tmp_path: Path) -> None:
    """What was written stays readable, and a second start goes on with that trial."""
    script, out = write_script(tmp_path, seeds=3), tmp_path / 'out'
    expected = local_lines(script)
    listener = graph.add(Listener)
    for make_node in (world.make_node, subgoal_selector.make_node, ActionSearcher):
        graph.add(make_node)
    node = orchestrator(graph, out, script=str(script), peer_timeout_s=20.0)
    with disk_of(len(expected[0]) + 1 + len(expected[1]) // 2):
        graph.spin_until(node._stop.is_set)
    assert node.exit_code == 1
    assert record_lines(out) == expected[:1]
    graph.spin_until(lambda: len(listener.outcomes) == 2)
    reason = f'{out / "trials.jsonl"}: cannot be written: File too large'
    assert [outcome.reason == reason for outcome in listener.outcomes] == [False, True]
    graph.spin_until(lambda: any(status.message == reason for status in listener.health))
    graph.remove(node)
    again = orchestrator(graph, out, script=str(script), peer_timeout_s=20.0)
    graph.spin_until(again._stop.is_set)
    assert again.exit_code == 0
    assert record_lines(out) == expected
