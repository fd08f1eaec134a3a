"""A graph that runs a script while somebody sends it everything that must not be said.

``python -m faults.fuzz_messages COUNT SEED`` (in ``test/``) sends COUNT messages, raw and typed,
one part of them at full speed, and then looks: every process is the one that was started, the
records are those of the undisturbed trials, memory is bounded, and warnings are few.
"""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any

import peers
from blocks_planning_msgs.action import RunTrial
from graphs import COMMAND, is_alive, node_processes, record_lines, write_script
from rcl_interfaces import msg as parameter_msgs
from rcl_interfaces.srv import SetParameters
from rclpy.action.client import ActionClient
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node

from blocks_planning.ros.wire.topics import TOPICS, Topic
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.script import read_script
from faults.hostile import Hostile

SEGMENT = 200
RATE_HZ = 2000
"""Nine segments of messages in ten are sent no faster than this, the tenth as fast as it goes."""
GOES_ON = 3
"""Trials that must be done after it is over."""
DEADLINE_S = 120.0
SAMPLES = 4
MORE_MB = 100.0
NODES = ('world', 'subgoal_selector', 'action_searcher', 'trial_orchestrator', 'bag_recorder')


class Fuzzer(Node):
    """Hears everything and says too much."""

    def __init__(self, seed: int, **options: Any) -> None:
        super().__init__('fuzzer', **options)
        self.hostile = Hostile(seed)
        self.sent: Counter[str] = Counter()
        self.outlets = {
            topic: self.create_publisher(topic.ros_type, topic.name, topic.publisher_qos)
            for topic in TOPICS
        }
        for topic in TOPICS:
            self.create_subscription(
                topic.ros_type,
                topic.name,
                partial(self._hear, topic),
                topic.subscription_qos,
                raw=True,
            )
        self.goals = ActionClient(self, RunTrial, 'run_trial')
        self.setters = [
            self.create_client(SetParameters, f'{name}/set_parameters') for name in NODES
        ]
        self._own: set[int] = set()

    def _hear(self, topic: Topic, data: bytes) -> None:
        if hash(data) not in self._own:  # what it says itself comes back
            self.hostile.hear(topic, data)

    def say(self, topic: Topic, data: bytes) -> None:
        """Say some bytes."""
        self._own.add(hash(data))
        self.outlets[topic].publish(data)
        self.sent[topic.name] += 1

    def ask(self) -> None:
        """Ask for a trial while another one runs, or set a parameter of a type that is none."""
        if self.hostile.chance.random() < 0.5:
            if self.goals.server_is_ready():
                self.goals.send_goal_async(RunTrial.Goal(trial=self.hostile.goal()))
                self.sent['run_trial'] += 1
            return
        client = self.hostile.chance.choice(self.setters)
        if client.service_is_ready():
            value = parameter_msgs.ParameterValue(type=self.hostile.chance.randrange(256))
            asked = [parameter_msgs.Parameter(name='workers', value=value)]
            client.call_async(SetParameters.Request(parameters=asked))
            self.sent['set_parameters'] += 1


@dataclass
class Report:
    """What came of it."""

    sent: Counter[str]
    refused: dict[str, int]
    warnings: int
    seconds: float
    trials: int
    changed: int
    restarted: list[str]
    exit_code: int | None
    memory_mb: dict[str, list[float]] = field(default_factory=dict)
    log: str = ''

    @property
    def failures(self) -> list[str]:
        """What must not be, a sentence each."""
        found = [f'{name} is not the process that was started' for name in self.restarted]
        if self.changed:
            found.append(f'{self.changed} records are not those of undisturbed trials')
        if self.exit_code != 130:
            found.append(f'the bring-up ended with {self.exit_code}')
        if 'Traceback' in self.log:
            found.append('a traceback was printed')
        idle = [name for name in NODES[:4] if not self.refused.get(name)]
        found += [f'{name} has refused nothing' for name in idle]
        if self.warnings > len(NODES) * (self.seconds + 5) + 10:
            found.append(f'{self.warnings} warnings in {self.seconds:.0f} s')
        for name, (before, *_, after) in self.memory_mb.items():
            if after - before > MORE_MB:
                found.append(f'{name} grew from {before:.0f} to {after:.0f} MB')
        return found


def fuzz(folder: Path, count: int, seed: int, interruptions: int = 0) -> Report:
    """Bring a graph up, send it so many messages, and take it down again."""
    script = write_script(
        folder,
        stimuli=['cogsci2021'],
        seeds=2_000,
        searches=[{'name': 'bfs', 'depth': 2}],
        strategies=[{'name': 'scoping', 'lambda': 0.002}],
        worlds=[{'name': 'simulated', 'slip': 0.1, 'loss': 0.1, 'blocks': 'loose'}],
    )
    out, log = folder / 'out', folder / 'log.txt'
    namespace = f'/fuzz_{seed}'
    fuzzer = Fuzzer(seed, namespace=namespace, context=peers.context_of('peers'))
    executor = SingleThreadedExecutor(context=peers.context_of('peers'))
    executor.add_node(fuzzer)
    place = ['--namespace', namespace, '--domain', str(peers.DOMAIN.number)]
    with log.open('w') as file:
        process = subprocess.Popen(
            [*COMMAND, str(script), '--out', str(out), '--bag', str(folder / 'bag'), *place],
            stdout=file,
            stderr=file,
            start_new_session=True,
        )
        try:
            _spin_until(executor, process, lambda: len(record_lines(out)) >= 2)
            pids = node_processes(process.pid)
            memory = _memory({**pids, 'bring-up': process.pid})
            began = time.monotonic()
            samples = [memory]
            for _ in range(SAMPLES):
                _send(fuzzer, executor, count // SAMPLES, interruptions // SAMPLES)
                samples.append(_memory({**pids, 'bring-up': process.pid}))
            seconds = time.monotonic() - began
            wanted = len(record_lines(out)) + GOES_ON
            _spin_until(executor, process, lambda: len(record_lines(out)) >= wanted)
            after = node_processes(process.pid)
        finally:
            process.terminate()
            process.wait(20)
            executor.remove_node(fuzzer)
    text = log.read_text(encoding='utf-8', errors='replace')
    found = record_lines(out)
    expected = [run_trial(spec).to_line() for spec in islice(read_script(script), len(found))]
    said = re.findall(r'\[([\w./]+)\]: refused .*\((\d+) refused so far\)', text)
    return Report(
        sent=fuzzer.sent,
        refused={name.rpartition('.')[2]: int(number) for name, number in said},
        warnings=len(said),
        seconds=seconds,
        trials=len(found),
        changed=sum(one != other for one, other in zip(found, expected, strict=True)),
        restarted=[name for name in pids if after.get(name) != pids[name]],
        exit_code=process.returncode,
        memory_mb={name: [sample[name] for sample in samples] for name in memory},
        log=text,
    )


def _send(
    fuzzer: Fuzzer, executor: SingleThreadedExecutor, count: int, interruptions: int
) -> None:
    every = count // (interruptions + 1) + 1
    began = time.monotonic()
    for number in range(1, count + 1):
        if number % every == 0:
            captured = fuzzer.hostile.interruption()
            if captured is not None:
                fuzzer.say(*captured)
                fuzzer.sent['interruptions'] += 1
        elif number % 100 == 0:
            fuzzer.ask()
        else:
            fuzzer.say(*fuzzer.hostile.message())
        if number % 10 == 0:
            executor.spin_once(timeout_sec=0)
        if number % SEGMENT == 0:
            due = number / RATE_HZ if number // SEGMENT % 10 else 0.0
            while time.monotonic() - began < due:
                executor.spin_once(timeout_sec=0.01)


def _spin_until(
    executor: SingleThreadedExecutor, process: subprocess.Popen[bytes], condition: Any
) -> None:
    end = time.monotonic() + DEADLINE_S
    while not condition():
        assert time.monotonic() < end, 'the graph does not go on'
        assert process.poll() is None, f'the graph ended with {process.returncode}'
        executor.spin_once(timeout_sec=0.02)


def _memory(pids: dict[str, int]) -> dict[str, float]:
    """Resident memory [MB]."""
    found = {}
    for name, pid in pids.items():
        text = Path(f'/proc/{pid}/status').read_text(encoding='utf-8') if is_alive(pid) else ''
        found[name] = sum(map(int, re.findall(r'VmRSS:\s+(\d+)', text))) / 1024
    return found


def main() -> int:
    """Print what came of it; return 1 if something must not be."""
    count, seed = (*map(int, sys.argv[1:]), *(100_000, 0)[len(sys.argv) - 1 :])[:2]
    with tempfile.TemporaryDirectory() as folder:
        report = fuzz(Path(folder), count, seed, interruptions=20)
        kept = Path(tempfile.gettempdir(), f'fuzz_messages_{seed}.log')
        kept.write_text(report.log, encoding='utf-8')
    lines = [
        f'messages sent: {report.sent.total()} in {report.seconds:.0f} s (seed {seed})',
        *(f'  {name}: {number}' for name, number in sorted(report.sent.items())),
        f'trials meanwhile: {report.trials}, changed: {report.changed}',
        f'restarted: {len(report.restarted)}',
        f'warnings: {report.warnings}',
    ]
    for name, samples in report.memory_mb.items():
        memory = ', '.join(f'{sample:.0f}' for sample in samples)
        lines.append(f'  {name}: refused {report.refused.get(name, 0)}, memory [MB] {memory}')
    lines += [f'FAILED: {failure}' for failure in report.failures]
    sys.stdout.write('\n'.join([*lines, f'log: {kept}', '']))
    return int(bool(report.failures))


if __name__ == '__main__':
    peers.exit_status = 1
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # take the graph down first
    peers.exit_status = main()
