"""Trials through the graph while a plan of faults is carried out, and what must hold after."""

from __future__ import annotations

import random
import signal
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from graphs import write_script
from peers import Graph

from faults.judging import judge
from faults.plan import BRINGUP, Fault, make_plan
from faults.report import Report
from faults.subject import Observer, Subject, send

RECOVERY_BOUND_S = 120.0
_PHASE_BOUND_S = 2.0
_FILE_LOOK_S = 0.03
_TRIGGERS = {'idle': 'outcome', 'searching': 'search/request', 'placing': 'action'}
_STRATEGIES: list[dict[str, Any]] = [
    {'name': 'none'},
    {'name': 'scoping', 'lambda': 0.002},
    {'name': 'scoping', 'lambda': 0.01, 'commit': 'action'},
    {'name': 'full', 'lambda': 0.01},
]
_SEARCHES: list[dict[str, Any]] = [
    {'name': 'bfs', 'depth': 3},
    {'name': 'bfs', 'depth': 5},
    {'name': 'astar', 'iterations': 512},
]
_WORLDS: list[dict[str, Any]] = [
    {'name': 'simulated', 'slip': 0.1, 'loss': 0.1},
    {'name': 'simulated'},
    {'name': 'simulated', 'slip': 0.02, 'blocks': 'loose'},
]
"""Each script is built in one of them, in turn."""


class _Over(Exception):
    """The graph has ended."""


class Harness:
    """Runs scripts, one after the other, until a plan is done."""

    def __init__(self, folder: Path, seed: int, kills: int, trials: int, pace_s: float) -> None:
        """Prepare.

        Args:
            folder: where everything is written.
            seed: of the plan and the scripts.
            kills: number of them.
            trials: the least number of them.
            pace_s: how long placing a block takes [s].
        """
        self.report = Report()
        self._folder, self._trials, self._pace_s = folder, trials, pace_s
        self._chance = random.Random(seed)
        self._plan: Iterator[Fault] = make_plan(seed, kills)
        self._next: Fault | None = next(self._plan, None)
        self._graph = Graph()
        self._observer = self._graph.add(Observer)
        self._subject: Subject
        self._start_s = 1.0

    def run(self, per_script: int = 32, say: Callable[[str], None] = lambda _: None) -> Report:
        """Run scripts of so many trials until all kills are done and there were enough trials.

        Args:
            per_script: number of trials of a script.
            say: is told how far it is.
        """
        begun, number = time.monotonic(), 0
        while (
            self._next is not None or self.report.trials < self._trials
        ) and not self.report.complaints:
            number += 1
            folder = self._folder / f'script{number}'
            folder.mkdir(parents=True)
            world = _WORLDS[(number - 1) % len(_WORLDS)]
            self._run_script(self._script(folder, per_script, world), folder / 'out')
            say(
                f'script {number}: {self.report.trials} trials, {self.report.kills.total()} kills, '
                f'{time.monotonic() - begun:.0f} s'
            )
        self.report.seconds = time.monotonic() - begun
        return self.report

    def close(self) -> None:
        """End what is left."""
        self._subject.stop()
        self._graph.close()

    def _script(self, folder: Path, trials: int, world: dict[str, Any]) -> Path:
        towers = self._chance.sample(range(1, 17), max(1, trials // len(_STRATEGIES)))
        return write_script(
            folder,
            stimuli=[f'cogsci2021/{tower}' for tower in towers],
            searches=[self._chance.choice(_SEARCHES)],
            strategies=_STRATEGIES[:trials],
            worlds=[world],
            first_seed=self._chance.randrange(2**32),
        )

    def _run_script(self, script: Path, out: Path) -> None:
        self._subject = subject = Subject(script, out, self._graph.namespace, self._pace_s)
        begun, progress = time.monotonic(), self._observer.progress
        subject.start()
        try:
            # A script can be over before a node has started again; a kill while nodes start that
            # did not come in time comes while they start for the next script.
            if self._next is None or self._next.phase != 'starting':
                self._spin(lambda: self._observer.progress > progress, RECOVERY_BOUND_S)
                self._start_s = time.monotonic() - begun
            while self._next is not None:
                self._do(self._next)
                self._next = next(self._plan, None)
            self._spin(lambda: False, float('inf'))
        except _Over:
            pass
        finally:
            subject.stop()
        code = subject.exit_code()
        if code not in (0, 1):
            self._complain(f'the graph ended with {code}: see {subject.console}')
        judge(subject, self.report, script, out)

    # Faults

    def _do(self, fault: Fault) -> None:
        if fault.node == BRINGUP:
            self._kill_bringup(fault)
            return
        old = self._wait_for_node(fault)
        self._wait_for_phase(fault)
        old = self._subject.pids().get(fault.node, old)
        if fault.kind == 'copy':
            self._start_copy(fault, old)
        elif fault.kind == 'pause':
            self._pause(fault, old)
        else:
            self._kill(fault, old)

    def _kill(self, fault: Fault, pid: int) -> None:
        if fault.kind == 'late':
            send(self._subject.pid, signal.SIGSTOP)
        send(pid, signal.SIGKILL)
        killed = time.monotonic()
        self.report.add(fault)
        if fault.kind == 'late':
            self._spin(lambda: False, fault.hold_s)
            send(self._subject.pid, signal.SIGCONT)
            killed = time.monotonic()
        if not fault.at_once:
            self._wait_for_recovery(fault, pid, killed)

    def _pause(self, fault: Fault, pid: int) -> None:
        send(pid, signal.SIGSTOP)
        try:
            self.report.add(fault)
            self._spin(lambda: False, fault.hold_s)
        finally:
            send(pid, signal.SIGCONT)
        begun, progress = time.monotonic(), self._observer.progress
        self._expect(lambda: self._observer.progress > progress, fault)
        self.report.recoveries.append((time.monotonic() - begun, fault))

    def _start_copy(self, fault: Fault, pid: int) -> None:
        """A copy must be refused, in a sentence, whatever the first one does meanwhile.

        Unless that has ended, with its script or to be started again: then there was no copy.
        """
        copy = self._subject.copy(pid)
        if copy is not None:
            try:
                self._spin(lambda: copy.poll() is not None, RECOVERY_BOUND_S)
                said = copy.stdout.read() if copy.stdout else ''
            finally:
                copy.kill()
                copy.wait()
                if copy.stdout:
                    copy.stdout.close()
        if copy is None or self._subject.pids().get(fault.node) != pid:
            self._do(fault)
            return
        self.report.add(fault)
        if copy.returncode != 2 or said.count('Error: ') != 1 or 'Traceback' in said:
            self._complain(f'a copy of {fault.node} ended with {copy.returncode}: {said}')

    def _kill_bringup(self, fault: Fault) -> None:
        self._spin(lambda: False, fault.delay_s)
        send(self._subject.pid, signal.SIGKILL)
        killed, progress = time.monotonic(), self._observer.progress
        self.report.add(fault)
        self._subject.stop()
        self._subject.exit_code()
        self._subject.start()
        self._wait_for_node(fault._replace(node='trial_orchestrator'))
        progress = self._observer.progress
        self._expect(lambda: self._observer.progress > progress, fault)
        self.report.recoveries.append((time.monotonic() - killed, fault))

    # Waiting

    def _wait_for_node(self, fault: Fault) -> int:
        pids: dict[str, int] = {}

        def is_there() -> bool:
            pids.update(self._subject.pids())
            return fault.node in pids

        self._expect(is_there, fault)
        return pids[fault.node]

    def _wait_for_phase(self, fault: Fault) -> None:
        """Wait until a phase begins; it may not come while the graph recovers."""
        counts, subject = self._observer.counts, self._subject
        topic = _TRIGGERS.get(fault.phase, 'action')
        if fault.phase == 'record':
            before = subject.records_size()
            self._poll(lambda: subject.records_size() != before, _PHASE_BOUND_S)
        elif fault.phase in (*_TRIGGERS, 'journal'):
            said = counts[topic]
            self._spin(lambda: counts[topic] > said, _PHASE_BOUND_S)
        if fault.phase == 'journal':
            journal = subject.journal_size()
            self._poll(lambda: subject.journal_size() != journal, self._pace_s + _FILE_LOOK_S)
        if fault.phase == 'starting':
            self._spin(lambda: False, fault.delay_s * self._start_s)
        elif fault.phase == 'any':
            self._spin(lambda: False, fault.delay_s)
        elif fault.delay_s:
            time.sleep(fault.delay_s)

    def _wait_for_recovery(self, fault: Fault, pid: int, killed: float) -> None:
        """Until the node is there again and a trial goes on, or the bag does."""

        def has_new() -> bool:
            return self._subject.pids().get(fault.node, pid) != pid

        self._expect(has_new, fault)
        if fault.node == 'bag_recorder':
            size = self._subject.bag_size()
            self._expect(lambda: self._subject.bag_size() > size, fault)
        else:
            progress = self._observer.progress
            self._expect(lambda: self._observer.progress > progress, fault)
        self.report.recoveries.append((time.monotonic() - killed, fault))

    def _expect(self, condition: Callable[[], bool], fault: Fault) -> None:
        bound_s = max(RECOVERY_BOUND_S, 20 * self._start_s)
        if not self._spin(condition, bound_s):
            self._complain(f'no recovery in {bound_s:.0f} s from {fault}')
            raise _Over

    def _spin(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Hear what is said until a condition holds; return whether it does in time."""
        deadline = time.monotonic() + seconds
        looked = 0.0
        while not condition():
            now = time.monotonic()
            if now >= deadline:
                return False
            if now - looked > 0.1:
                looked = now
                if self._subject.exit_code() is not None:
                    raise _Over
            self._graph.spin_some()
        return True

    def _poll(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Look at files until a condition holds, as quick as possible."""
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() >= deadline:
                return False
            if self._subject.exit_code() is not None:
                raise _Over
        return True

    def _complain(self, sentence: str) -> None:
        self.report.complaints.append(sentence)
