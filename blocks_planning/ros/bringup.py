"""The whole graph as processes: starts it for a script, keeps it alive, and stops it."""

from __future__ import annotations

import json
import os
import signal
import sys
import threading
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.signals import SignalHandlerOptions

from blocks_planning.errors import BlocksPlanningError
from blocks_planning.ros.nodes.trial_orchestrator import (
    PLACING_TIMEOUT,
    RECORDS,
    RETRIES,
    WAIT_FOR,
)
from blocks_planning.ros.nodes.trial_view import TOKEN_VARIABLE
from blocks_planning.ros.runtime.domain import Domain
from blocks_planning.ros.runtime.process import BAD_INPUT
from blocks_planning.ros.runtime.processes import NodeProcess, stop_all
from blocks_planning.ros.runtime.reserving import ReservedPort
from blocks_planning.ros.runtime.watcher import Watcher
from blocks_planning.ros.wire.graph import LISTENERS, ROBOT_ARM, TRIAL_VIEW, WATCHER
from blocks_planning.ros.wire.topics import TRIAL
from blocks_planning.view.scene import Scene
from blocks_planning.view.web.guards import Address, address_of

_SPIN_S = 0.05


@dataclass(frozen=True)
class BringupSpec:
    """The graph to start.

    Attributes:
        script: of the trials.
        out: folder of the records and logs.
        bag: folder of the bag; None for no bag.
        namespace: of all nodes, '' for none.
        domain: ROS domain; None for a free one.
        placing_s: duration of a placement [s].
        participant: code of the person who plans, '' for that of the script.
        markers: whether the tower is shown as markers, for RViz and Foxglove.
        view: host and port of the page, port 0 for a free one; None for no page.
        placing_timeout_s: how long the world may be silent when it has to answer [s].
        retries: how often an order is given again that the world cannot carry out.
        robot: settings of a simulated robot that carries out the orders; None for no robot.
        scenes: whether the scene follows the running trial. Otherwise the watcher hears only that
            trials begin, and leaves the processors to the other nodes.
    """

    script: Path
    out: Path
    bag: Path | None = None
    namespace: str = ''
    domain: int | None = None
    placing_s: float = 0.0
    participant: str = ''
    markers: bool = False
    view: tuple[str, int] | None = None
    placing_timeout_s: float = PLACING_TIMEOUT.default
    retries: int = RETRIES.default
    robot: Mapping[str, object] | None = None
    scenes: bool = True

    @property
    def records(self) -> Path:
        """The file of the records."""
        return self.out / RECORDS


class Bringup:
    """A graph of processes, and a node in this process that watches it."""

    def __init__(self, spec: BringupSpec) -> None:
        """Prepare; :meth:`run` starts the processes."""
        self._domain = Domain(spec.domain)
        self._environment = self._domain.environment(os.environ)
        self._environment.setdefault('ROS_LOG_DIR', str(spec.out / 'log'))
        self._spec = spec
        self._names = [name for name in WAIT_FOR.default if isinstance(name, str)]
        if spec.bag is not None:
            self._names.append('bag_recorder')
        if spec.markers:
            self._names.append('marker_publisher')
        if spec.robot is not None:
            self._names.append(ROBOT_ARM.name)
        self._port: ReservedPort | None = None
        self.page: Address | None = None
        if spec.view is not None:
            self._names.append(TRIAL_VIEW.name)
            self._port = ReservedPort(*spec.view)
            self.page = address_of(spec.view[0], self._port.number)
        self._others = [self._process(name) for name in self._names]
        self._orchestrator = self._process('trial_orchestrator')
        self.watcher: Watcher | None = None

    @property
    def look_in(self) -> str:
        """The command that lets another terminal join this graph."""
        names = sorted(self._domain.environment({}).keys() - {'AMENT_PREFIX_PATH'})
        return ' '.join(['export', *(f'{name}={self._environment[name]}' for name in names)])

    @property
    def restarts(self) -> dict[str, int]:
        """How often each node was started again."""
        return {process.name: process.restarts for process in self._processes}

    @property
    def _processes(self) -> list[NodeProcess]:
        return [*self._others, self._orchestrator]

    @property
    def _waited_for(self) -> list[str]:
        return [*self._names, WATCHER.name] if self._spec.scenes else self._names

    def _process(self, name: str) -> NodeProcess:
        arguments = []
        if self._spec.namespace:
            arguments += ['-r', f'__ns:=/{self._spec.namespace.strip("/")}']
        parameters: dict[str, object] = {}
        if name == 'world':
            parameters = {
                'journal_dir': self._spec.out / 'journal',
                'placing_s': float(self._spec.placing_s),
            }
            if self._spec.robot is not None:
                parameters['cell_size'] = self._spec.robot['cell_m']
        if name == ROBOT_ARM.name and self._spec.robot is not None:
            parameters = {'state_dir': self._spec.out / 'robot', **_as_yaml(self._spec.robot)}
        if name == 'bag_recorder':
            parameters = {'bag_dir': self._spec.bag}
        if name == 'trial_orchestrator':
            parameters = {
                'script': self._spec.script,
                'participant': repr(self._spec.participant),
                'out_dir': self._spec.out,
                'wait_for': f'[{", ".join(self._waited_for)}]',
                'placing_timeout_s': float(self._spec.placing_timeout_s),
                'retries': self._spec.retries,
            }
        environment = self._environment
        if name == TRIAL_VIEW.name and self.page is not None:
            parameters = {
                'host': self.page.host,
                'port': self.page.port,
                'script': self._spec.script,
                'participant': repr(self._spec.participant),
            }
            environment = {**environment, TOKEN_VARIABLE: self.page.token}
        for key, value in parameters.items():
            arguments += ['-p', f'{key}:={value}']
        return NodeProcess(name, arguments, environment)

    def run(self, on_tick: Callable[[Scene | None], None]) -> int:
        """Run the script to its end; always stop all processes.

        rclpy stays initialised in this process: see
        :func:`blocks_planning.ros.runtime.process.leave_if_up`.

        Args:
            on_tick: called several times a second with the current scene.

        Returns:
            The exit code of the orchestrator: 0 if every tower was rebuilt, 1 if not.

        Raises:
            BlocksPlanningError: if a node could not be kept alive, or refused its parameters.
            KeyboardInterrupt: on SIGINT or SIGTERM.
        """
        # An exception inside a conversion in C would be replaced by another one.
        interrupted = threading.Event()
        before = {
            number: signal.signal(number, lambda *_: interrupted.set())
            for number in (signal.SIGINT, signal.SIGTERM)
        }
        os.environ.update(self._environment)
        rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
        executor = SingleThreadedExecutor()
        try:
            for process in self._processes:
                process.start()
            topics = WATCHER if self._spec.scenes else WATCHER._replace(listens=(TRIAL,))
            self.watcher = Watcher(topics, namespace=self._spec.namespace)
            executor.add_node(self.watcher)
            while True:
                executor.spin_once(timeout_sec=_SPIN_S)
                if interrupted.is_set():
                    raise KeyboardInterrupt
                on_tick(self.watcher.scene)
                code = self._orchestrator.exit_code()
                if code in (0, 1):
                    return code
                self._keep_alive()
        finally:
            stop_all(self._processes)
            if self._port is not None:
                self._port.release()
            executor.shutdown(timeout_sec=_SPIN_S)
            for number, handler in before.items():
                signal.signal(number, handler)

    def _keep_alive(self) -> None:
        for process in self._processes:
            if process.exit_code() == BAD_INPUT:
                raise BlocksPlanningError(f'{process.name} did not start: see its message above')
            if process.keep_alive():
                continue
            said = (
                f'{process.name} ended {process.deaths + process.kills} times in a row soon after '
                f'its start; the last exit code was {process.exit_code()}'
            )
            if process.name not in LISTENERS:
                raise BlocksPlanningError(said)
            process.is_given_up = True
            sys.stderr.write(f'{said}; the trials continue without it\n')


def _as_yaml(settings: Mapping[str, object]) -> dict[str, str]:
    """Values as they are written in parameters."""
    return {name: json.dumps(value) for name, value in settings.items()}
