"""Processes of nodes that die: which are started again, and which are given up."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from typing import Any

import pytest
from builders import CHAIR, spec
from graphs import NODES
from peers import Bench, Graph

from blocks_planning.ros.nodes import action_searcher
from blocks_planning.ros.runtime import process as process_module
from blocks_planning.ros.runtime import processes
from blocks_planning.ros.runtime.processes import (
    MOST_DEATHS,
    MOST_KILLS,
    READY_VARIABLE,
    STABLE_S,
    NodeProcess,
    tell_ready,
)
from blocks_planning.ros.wire.graph import ACTION_SEARCHER
from blocks_planning.search import warming
from blocks_planning.subgoals.decision import Query
from blocks_planning.trials.messages import SearchAnswer, SearchRequest, TrialStarted

SPEC = spec(CHAIR, depth=2)
CRASH, KILLED, ENDED = 3, -signal.SIGKILL, 0


class Dying:
    """Processes that end when the test says so, in a time of their own."""

    code: int | None

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now, self.code, self.started = 100.0, None, 0
        self.told = -1
        monkeypatch.setattr(processes.time, 'monotonic', lambda: self.now)
        monkeypatch.setattr(processes.subprocess, 'Popen', self.popen)

    def popen(self, *_: object, pass_fds: tuple[int, ...], **__: object) -> Dying:
        self.started += 1
        self.code = None
        if self.told >= 0:
            os.close(self.told)
        self.told = os.dup(pass_fds[0])
        return self

    def poll(self) -> int | None:
        return self.code

    @property
    def returncode(self) -> int | None:
        return self.code

    def get_ready(self) -> None:
        """Say that the node is ready, as it does itself."""
        os.environ[READY_VARIABLE] = str(os.dup(self.told))
        tell_ready()


@pytest.fixture
def dying(monkeypatch: pytest.MonkeyPatch) -> Dying:
    return Dying(monkeypatch)


def watch(process: NodeProcess, dying: Dying, seconds: float) -> bool:
    """Look after a process for some time; return whether it is not given up."""
    end = dying.now + seconds
    kept = True
    while kept and dying.now < end:
        dying.now += 0.05
        kept = process.keep_alive()
    return kept


def deaths_until_given_up(process: NodeProcess, dying: Dying, code: int, **life: Any) -> int:
    """How often a process may die; it is started again each time until it is given up."""
    process.start()
    for count in range(1, 10 * MOST_KILLS):
        if life.get('is_ready'):
            dying.get_ready()
        assert watch(process, dying, life.get('lives_s', 0.1))
        dying.code = code
        if not watch(process, dying, 4.0):
            return count
        assert dying.poll() is None
    return 0


@pytest.mark.parametrize(
    ('code', 'life', 'bound'),
    [
        (CRASH, {}, MOST_DEATHS),
        (-signal.SIGSEGV, {}, MOST_DEATHS),
        (CRASH, {'is_ready': True}, MOST_DEATHS),
        (CRASH, {'lives_s': STABLE_S + 1}, MOST_DEATHS),
        (KILLED, {}, MOST_KILLS),
        (ENDED, {'lives_s': STABLE_S + 1}, MOST_KILLS),
    ],
)
def test_process_that_dies_again_and_again_is_given_up(
    dying: Dying, code: int, life: dict[str, Any], bound: int
) -> None:
    process = NodeProcess('world', (), {})
    assert deaths_until_given_up(process, dying, code, **life) == bound + 1
    assert (process.restarts, dying.started) == (bound, bound + 1)


@pytest.mark.parametrize(
    ('code', 'life'),
    [
        (CRASH, {'is_ready': True, 'lives_s': STABLE_S + 1}),
        (KILLED, {'is_ready': True, 'lives_s': 0.1}),
        (-signal.SIGTERM, {'is_ready': True, 'lives_s': 0.1}),
    ],
)
def test_process_that_did_its_work_is_always_started_again(
    dying: Dying, code: int, life: dict[str, Any]
) -> None:
    assert deaths_until_given_up(NodeProcess('world', (), {}), dying, code, **life) == 0


def test_kills_are_no_crashes(dying: Dying) -> None:
    """However slow the start: what counts is not the time, but who ended the process."""
    process = NodeProcess('world', (), {})
    process.start()
    for _ in range(3 * MOST_DEATHS):
        dying.code = KILLED
        assert watch(process, dying, 4.0)
    assert process.deaths == 0


def test_pauses_grow_to_a_bound(dying: Dying) -> None:
    process = NodeProcess('world', (), {})
    process.start()
    pauses = []
    for _ in range(MOST_DEATHS):
        dying.code, died = CRASH, dying.now
        while dying.poll() is not None:
            assert watch(process, dying, 0.04)
        pauses.append(dying.now - died)
    assert pauses == sorted(pauses)
    assert pauses[0] < 0.3
    assert pauses[-1] < 4.0


def test_process_that_was_given_up_is_left_alone(dying: Dying) -> None:
    process = NodeProcess('bag_recorder', (), {})
    deaths_until_given_up(process, dying, CRASH)
    process.is_given_up = True
    started = dying.started
    assert watch(process, dying, 20.0)
    assert dying.started == started


def test_node_tells_that_it_is_ready() -> None:
    ready, told = os.pipe()
    environment = {**os.environ, READY_VARIABLE: str(told)}
    command = [sys.executable, '-m', NODES, 'world', '--ros-args', '--log-level', 'warn']
    with subprocess.Popen(command, env=environment, pass_fds=(told,)) as node:
        os.close(told)
        assert os.read(ready, 16) == b'ready'
        node.terminate()
    os.close(ready)
    assert node.returncode == 0


SLOW = """
import sys, threading
from blocks_planning.ros.runtime import process
from rclpy.node import Node

process.STOOD_STILL_S = 0.5
process._LOOK_FOR_PARENT_S = 0.1

def make_node(stop):
    print('made', flush=True)
    threading.Event().wait(1.5)
    stop.set()
    return Node('slow')

process.run(make_node, args=[])
"""


def test_node_that_is_made_slowly_counts_as_running() -> None:
    """It waits, and works little: it was not stopped."""
    done = subprocess.run(
        [sys.executable, '-c', SLOW], capture_output=True, text=True, timeout=100
    )
    assert (done.stdout, done.returncode) == ('made\n', 0)
    assert 'was stopped' not in done.stderr
    assert process_module.STOOD_STILL_S > 0.5


def test_node_joins_before_its_searches_are_compiled(
    graph: Graph, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """It says so, and is waited for."""
    may_end = threading.Event()
    begun = threading.Event()

    def compile_for(*_: object) -> None:
        begun.set()
        may_end.wait()

    monkeypatch.setattr(warming, 'compile_for', compile_for)
    node = graph.add(action_searcher.ActionSearcher)
    node.prepare(SPEC.search, SPEC.task.board)
    graph.spin_until(begun.is_set)
    on = Bench(graph, ACTION_SEARCHER, node, SPEC)
    assert node.health().state == 'compiling'
    started = TrialStarted(SPEC.trial_id, SPEC)
    on.tell(started, SearchRequest(SPEC.trial_id, (Query(0, SPEC.task.rows(2)),)))
    assert on.peer.only(SearchAnswer) == []
    may_end.set()
    assert on.hear(1, SearchAnswer)[0].query == Query(0, SPEC.task.rows(2))
    assert node.health().state == 'building'
    assert 'compiling bfs' in capfd.readouterr().err
