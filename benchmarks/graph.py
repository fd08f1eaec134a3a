"""The ROS graph: a hop against a bare echo, trials per second, and what long runs take."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from statistics import median
from typing import Any

import yaml

from benchmarks.measure import Figure
from benchmarks.processes import NODES, Taken, process, resources
from blocks_planning.board.blocks import Block, Placement
from blocks_planning.board.geometry import Board
from blocks_planning.board.task import Task
from blocks_planning.ros.runtime.domain import Domain
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials import world
from blocks_planning.trials.messages import PlaceBlock, TrialStarted, WorldState
from blocks_planning.trials.spec import TrialSpec

DEADLINE_S = 20.0
BOARD = Board(8, 8)
SPEC = TrialSpec(
    'echo',
    Task(BOARD, BOARD.full, (Block(2, 1),)),
    make_strategy('none', {}),
    make_search('random', {}),
)
PLACEMENTS = [Placement(Block(2, 1), 2 * (step % 4)) for step in range(31)]


def run(quick: bool) -> Iterator[Figure]:
    """Round trips between two processes, then whole bring-ups."""
    domain = Domain()
    os.environ.update(domain.environment(os.environ))
    echo_ms = 0.0
    for figure in _hops(20 if quick else 100):
        echo_ms = echo_ms or figure.value
        yield figure
    yield from _bring_up(domain.number, 5 if quick else 125, echo_ms)
    domain.release()


# Round trips: an action goes out, the state that it leads to comes back.


def _states() -> list[WorldState]:
    """The states that the actions lead through."""
    memory, (state, *_) = world.step(world.Memory(), TrialStarted('echo', SPEC))
    states = [state]
    for step, placement in enumerate(PLACEMENTS):
        memory, (_, state) = world.step(memory, PlaceBlock('echo', step, placement))
        states.append(state)
    return states  # type: ignore[return-value]


def echo() -> None:
    """A node of nothing but rclpy, which answers an action with a message made beforehand.

    It is spun by the default executor of rclpy, whatever spins the nodes of this package.
    """
    import rclpy
    from rclpy.executors import ExternalShutdownException
    from rclpy.node import Node

    from blocks_planning.ros.wire.topics import ACTION, STATE

    answers = [STATE.to_ros(BOARD, state) for state in _states()]
    rclpy.init(args=[])
    node = Node('world')
    outlet = node.create_publisher(STATE.ros_type, STATE.name, STATE.publisher_qos)

    def answer(message: Any) -> None:
        said = answers[message.sequence + 1]
        said.trial_id = message.trial_id
        outlet.publish(said)

    node.create_subscription(ACTION.ros_type, ACTION.name, answer, ACTION.subscription_qos)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


def _hops(rounds: int) -> Iterator[Figure]:
    bare = ['-c', 'from benchmarks.graph import echo; echo()']
    node = ['-m', NODES, 'world']
    times: dict[str, list[float]] = {'bare': [], 'node': []}
    for _ in range(2):  # in turns, so that both have the same machine
        for name, command in (('bare', bare), ('node', node)):
            times[name] += _round_trips(command, rounds)
    yield Figure('round trip, bare rclpy echo', 1000 * median(times['bare']), 'ms')
    yield Figure('round trip, world', 1000 * median(times['node']), 'ms')
    ratio = median(times['node']) / median(times['bare'])
    yield Figure('  world / bare echo', ratio, 'x', '< 1.5')


def _round_trips(command: list[str], rounds: int) -> list[float]:
    """Seconds from sending an action to having the state, 31 times for each round."""
    import rclpy
    from rclpy.executors import SingleThreadedExecutor
    from rclpy.node import Node

    from blocks_planning.ros.wire.topics import ACTION, STATE, TRIAL

    rclpy.init(args=[])
    caller = Node('caller')
    executor = SingleThreadedExecutor()
    executor.add_node(caller)
    trial, action = (
        caller.create_publisher(topic.ros_type, topic.name, topic.publisher_qos)
        for topic in (TRIAL, ACTION)
    )
    heard: list[Any] = []
    caller.create_subscription(STATE.ros_type, STATE.name, heard.append, STATE.subscription_qos)
    actions = [
        ACTION.to_ros(BOARD, PlaceBlock('echo', step, placement))
        for step, placement in enumerate(PLACEMENTS)
    ]

    def wait_for(condition: Callable[[], object]) -> None:
        end = time.monotonic() + DEADLINE_S
        while not condition():
            if time.monotonic() > end:
                raise TimeoutError(f'no answer from {command}')
            executor.spin_once(timeout_sec=0.1)

    found = []
    is_node = command[0] == '-m'
    with process([sys.executable, *command]):
        wait_for(lambda: action.get_subscription_count() and caller.count_publishers('state'))
        wait_for(lambda: trial.get_subscription_count() or not is_node)
        for number in range(rounds):
            trial_id = f'echo {number}'
            if is_node:
                heard.clear()
                trial.publish(TRIAL.to_ros(None, TrialStarted(trial_id, SPEC)))
                wait_for(lambda: heard)
            for message in actions:
                heard.clear()
                message.trial_id = trial_id
                start = time.perf_counter()
                action.publish(message)
                wait_for(lambda: heard)
                found.append(time.perf_counter() - start)
    executor.shutdown()
    rclpy.shutdown()
    return found[len(PLACEMENTS) :]


# Bring-ups


def _bring_up(domain: int, seeds: int, echo_ms: float) -> Iterator[Figure]:
    """Whole graphs; ``echo_ms`` is a round trip of the bare echo in the same run [ms]."""
    script = {
        'stimuli': ['cogsci2021'],
        'seeds': seeds,
        'searches': [{'name': 'bfs', 'depth': 3}],
        'strategies': [{'name': 'scoping', 'lambda': 0.002}],
    }
    total = 16 * seeds
    with tempfile.TemporaryDirectory() as folder:
        path, records = Path(folder, 'script.yaml'), Path(folder, 'trials.jsonl')
        path.write_text(yaml.safe_dump(script), encoding='utf-8')
        begun = time.perf_counter()
        command = [sys.executable, '-m', 'blocks_planning.cli', 'run', str(path)]
        with process([*command, '--out', folder, '--domain', str(domain)]) as running:
            first = _wait_for_records(running, records, 1) - begun
            yield Figure('start of the graph to the first record', first, 's', '< 3')
            start = time.perf_counter()
            taken: dict[str, dict[str, Taken]] = {}
            for moment, part in (('start', 0.05), ('middle', 0.5), ('end', 0.95)):
                count = max(2, int(part * total))
                last = _wait_for_records(running, records, count)
                taken[moment] = resources(running.pid)
            rate = (count - 1) / (last - start)
            yield Figure(
                f'trials per second, scoping, bfs (3), {total} trials', rate, '/s', '> 20'
            )
            yield Figure('  bare echoes per trial', 1000 / rate / echo_ms, '', '< 80')
            running.wait(10 * DEADLINE_S)  # it runs the last trials first
    for name in taken['start']:
        for moment, of_nodes in taken.items():
            found = of_nodes.get(name, Taken(0.0, 0, 0, 0.0))
            yield Figure(f'{name}, {moment}: {found.threads} threads, memory', found.memory, 'MB')


def _wait_for_records(running: subprocess.Popen[bytes], path: Path, count: int) -> float:
    """The time when there are so many records."""
    while not path.exists() or path.read_bytes().count(b'\n') < count:
        if running.poll() is not None:
            raise RuntimeError(f'the graph ended with {running.returncode}')
        time.sleep(0.02)
    return time.perf_counter()
