"""Nodes that are there twice, and processes that are stopped, and that die."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from graphs import NODES, local_lines, record_lines, write_script
from orchestrators import orchestrator
from part_nodes import HEARD, TRIAL_SPEC
from peers import Graph, Peer

from blocks_planning.errors import LimitExceeded
from blocks_planning.ros.nodes import subgoal_selector, world
from blocks_planning.ros.nodes.action_searcher import ActionSearcher
from blocks_planning.ros.runtime.process import stood_still
from blocks_planning.ros.runtime.single import claim_name
from blocks_planning.ros.wire.topics import SEARCH_REQUEST, STATE, TRIAL
from blocks_planning.trials.messages import SearchRequest, WorldState

# Nodes that are there twice


def test_two_of_each_change_no_record(graph: Graph, tmp_path: Path) -> None:
    """As it can be on two machines: what is said twice is the same, and counts once."""
    script = write_script(tmp_path, seeds=2)
    for make_node in (world.make_node, subgoal_selector.make_node, ActionSearcher):
        for _ in range(2):
            graph.add(make_node)
    node = orchestrator(graph, tmp_path, script=str(script), peer_timeout_s=20.0)
    graph.spin_until(node._stop.is_set)
    assert record_lines(tmp_path) == local_lines(script)


def test_name_is_claimed_once_in_a_domain() -> None:
    name = f'/test/{time.monotonic_ns()}'
    first = claim_name(7, name)
    assert first is not None
    other = claim_name(8, name, wait_s=0)
    with pytest.raises(LimitExceeded, match=rf'node {name} is already running in ROS domain 7'):
        claim_name(7, name, wait_s=0)
    first.close()
    for claim in (claim_name(7, name, wait_s=0), other):
        assert claim is not None
        claim.close()


@pytest.mark.long
def test_second_process_of_a_node_is_refused(graph: Graph) -> None:
    command = [sys.executable, '-m', NODES, 'subgoal_selector', '--ros-args']
    command += ['-r', f'__ns:={graph.namespace}']
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as first:
        try:
            assert first.stderr is not None
            # A node can be seen before it has claimed its name.
            assert any(line.endswith(': ready\n') for line in iter(first.stderr.readline, ''))
            second = subprocess.run(command, capture_output=True, text=True, timeout=60)
            assert second.returncode == 2
            assert f'node {graph.namespace}/subgoal_selector is already running' in second.stderr
            assert len(second.stderr.splitlines()) == 1
            assert first.poll() is None
        finally:
            first.terminate()


# Processes that are stopped, and that die


@pytest.mark.parametrize(
    ('passed_s', 'worked_s', 'stopped'),
    [(0.5, 0.0, False), (4.4, 0.0, False), (4.6, 0.0, True), (60.0, 0.3, True), (6.0, 5.9, False)],
)
def test_who_is_busy_did_not_stand_still(passed_s: float, worked_s: float, stopped: bool) -> None:
    assert stood_still(passed_s, worked_s) == stopped


@pytest.mark.long
def test_node_that_was_stopped_is_there_again(graph: Graph, tmp_path: Path) -> None:
    """After all others had taken it for dead; and it says what holds."""
    peer = graph.add(Peer, TRIAL_SPEC, (TRIAL, STATE), (SEARCH_REQUEST,))
    command = [sys.executable, '-m', NODES, 'subgoal_selector', '--ros-args']
    command += ['-r', f'__ns:={graph.namespace}']
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        try:
            graph.spin_until(lambda: peer.count_publishers('subgoal'))
            process.send_signal(signal.SIGSTOP)
            graph.spin_until(lambda: not peer.count_publishers('subgoal'))
            process.send_signal(signal.SIGCONT)
            peer.say(HEARD[0])
            peer.say(next(m for m in HEARD if isinstance(m, WorldState)))
            first = next(m for m in HEARD if isinstance(m, SearchRequest))
            graph.spin_until(lambda: first in peer.heard)
            assert process.poll() is None
        finally:
            process.terminate()
        assert process.stderr is not None
        assert re.search(r'was stopped for \d+\.\d s, and restarts', process.stderr.read())
