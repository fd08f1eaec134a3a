"""Starting and ending the process of a node.

rclpy's own signal handlers end one stop in ten with a traceback, and destroying a node can hang
in the middleware with the GIL held. So signals only set an event here; the node spins in a
thread; and a timer in C ends the process if shutting down takes too long. A process ends
within a second, with exit code 0, also during a search; BLOCKS_PLANNING_EXIT_BOUND_S gives it
more seconds.

A process that was stopped for so long that all others dropped it re-executes itself, with the same
process id, because Fast DDS does not restore all of its topics when the process continues.
"""

from __future__ import annotations

import faulthandler
import os
import re
import signal
import sys
import threading
import time
import traceback
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import NoReturn

import rclpy
import rclpy.utilities
from rclpy.context import Context
from rclpy.exceptions import NameValidationException, ParameterException
from rclpy.executors import Executor
from rclpy.logging import LoggingSeverity, set_logger_level
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from blocks_planning.errors import BlocksPlanningError, ConfigurationError
from blocks_planning.ros.runtime.executor import MessageExecutor
from blocks_planning.ros.runtime.processes import PARENT_VARIABLE, tell_ready
from blocks_planning.ros.runtime.single import claim_name

EXIT_BOUND_S = float(os.environ.get('BLOCKS_PLANNING_EXIT_BOUND_S', '0.9'))
_SPIN_S = 0.1
_DRAIN_STEP_S = 0.01
_LOOK_FOR_PARENT_S = 0.5
STOOD_STILL_S = 4.5
"""Less than the lease in config/loopback.xml, after which other nodes drop a silent node [s]."""
_MOST_WORK = 0.1
_AGAIN_VARIABLE = 'BLOCKS_PLANNING_STARTED_AGAIN'
BAD_INPUT = 2
CRASHED = 3


def prepare_environment() -> None:
    """Make ROS packages importable in a virtual environment, where no setup file was sourced."""
    os.environ.setdefault('AMENT_PREFIX_PATH', sys.prefix)
    if not os.environ.get('HOME'):
        os.environ.setdefault('ROS_LOG_DIR', str(Path.cwd() / 'log'))


def run(make_node: Callable[[threading.Event], Node], args: list[str] | None = None) -> None:
    """Make a node and spin it until SIGINT, SIGTERM, or its event is set; then exit.

    Args:
        make_node: called with the event that ends the process; a node sets it to end itself.
        args: of the command line; None for those of the process.
    """
    prepare_environment()
    stop = threading.Event()
    made: list[str] = []
    watching = threading.Thread(target=_watch, args=(stop, made), name='watch', daemon=True)
    watching.start()  # before any publisher or subscription exists that others could drop
    try:
        initialise(args)
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda received, _: _on_signal(stop, received))
        node = make_node(stop)
        made.append(node.get_fully_qualified_name())
        claim = claim_name(node.context.get_domain_id(), node.get_fully_qualified_name())
        node.get_logger().info('ready')
        tell_ready()
    except (BlocksPlanningError, ParameterException, NameValidationException) as error:
        sys.stderr.write(f'Error: {" ".join(str(error).split())}\n')
        _leave(BAD_INPUT)
    failures: list[BaseException] = []
    executor = MessageExecutor(node)
    spinning = threading.Thread(
        target=_spin,
        args=(executor, stop, failures, getattr(node, 'drain_s', 0.0)),
        name='spin',
        daemon=True,
    )
    spinning.start()
    _wait(stop)
    _arm_exit()
    spinning.join(EXIT_BOUND_S / 2)  # let a running callback finish
    if not spinning.is_alive():
        finish = getattr(node, 'finish', None)
        if finish is not None:
            finish()
        executor.shutdown(timeout_sec=_SPIN_S)
        node.destroy_node()
        rclpy.utilities.try_shutdown()
    if claim is not None:
        claim.close()
    for failure in failures:
        traceback.print_exception(failure)
    _leave(CRASHED if failures else getattr(node, 'exit_code', 0))


def initialise(args: list[str] | None, context: Context | None = None) -> None:
    """Initialise rclpy without its signal handlers.

    Raises:
        ConfigurationError: for ROS arguments, or a file of parameters, that it can't read.
    """
    set_logger_level('rcl', LoggingSeverity.FATAL)  # its own message is less clear
    try:
        rclpy.init(args=args, context=context, signal_handler_options=SignalHandlerOptions.NO)
    except RuntimeError as error:
        reason = re.sub(r',?\s+at /\S+|^failed to initialize rcl: ', '', str(error))
        raise ConfigurationError(f'ROS arguments: {" ".join(reason.split())}') from None
    finally:
        set_logger_level('rcl', LoggingSeverity.UNSET)


def leave_if_up(code: int) -> None:
    """End the process now if rclpy was initialised in it.

    Deleting a participant of Fast DDS after others have just left can block forever, with the GIL
    held (Fast DDS issue 6513). Ending the process avoids that.
    """
    if rclpy.utilities.ok():
        _leave(code)


def _leave(code: int) -> NoReturn:
    for stream in (sys.stdout, sys.stderr):
        if not stream.closed:
            stream.flush()
    os._exit(code)


def _wait(stop: threading.Event) -> None:
    """Wait for the end, or until the bring-up that started this process is gone."""
    parent = os.environ.get(PARENT_VARIABLE)
    while not stop.wait(_LOOK_FOR_PARENT_S):
        if parent is not None and os.getppid() != int(parent):
            stop.set()


def _watch(stop: threading.Event, made: list[str]) -> None:
    """Re-exec this process if it was stopped for longer than the lease.

    A separate thread checks the clocks, so that a node with a slow constructor counts as running.
    A constructor that never lets this thread run looks like a stop, so it is ignored the second
    time.

    Args:
        stop: is set when the process ends.
        made: the name of the node, once it is made.
    """
    looked = _look_at_clocks()
    while not stop.wait(_LOOK_FOR_PARENT_S):
        before, looked = looked, _look_at_clocks()
        passed_s, worked_s = looked[0] - before[0], looked[1] - before[1]
        if not stood_still(passed_s, worked_s):
            continue
        if not made and os.environ.get(_AGAIN_VARIABLE):
            continue
        if not made:
            os.environ[_AGAIN_VARIABLE] = '1'
        name = ''.join(made) or 'a node that was starting'
        sys.stderr.write(f'{name} was stopped for {passed_s:.1f} s, and restarts\n')
        _begin_anew()


def _look_at_clocks() -> tuple[float, float]:
    """(a steady clock, processor time of the process) [s]."""
    return time.monotonic(), time.process_time()


def stood_still(passed_s: float, worked_s: float) -> bool:
    """Whether a process was stopped, not just busy.

    Args:
        passed_s: time between two checks that should follow each other closely [s].
        worked_s: processor time of all threads of the process between them [s].
    """
    return passed_s > STOOD_STILL_S and worked_s < _MOST_WORK * passed_s


def _begin_anew() -> NoReturn:
    """Re-exec this process, as if it had been killed and started."""
    sys.stderr.flush()
    for name in os.listdir('/proc/self/fd'):  # noqa: PTH208  numbers, not paths
        if int(name) > 2:  # sockets of the middleware would stay open
            with suppress(OSError):
                os.set_inheritable(int(name), False)
    os.execv(sys.executable, [sys.executable, *sys.orig_argv[1:]])


def _spin(
    executor: Executor,
    stop: threading.Event,
    failures: list[BaseException],
    drain_s: float,
) -> None:
    """Spin until the end, and then for ``drain_s`` to handle messages that have already arrived."""
    try:
        while not stop.is_set():
            executor.spin_once(timeout_sec=_SPIN_S)
        end = time.monotonic() + drain_s
        while time.monotonic() < end:
            executor.spin_once(timeout_sec=_DRAIN_STEP_S)
    except BaseException as error:  # noqa: BLE001  reported by the main thread, which ends the process
        failures.append(error)
        stop.set()


def _on_signal(stop: threading.Event, received: int) -> None:
    if stop.is_set():
        os._exit(128 + received)
    stop.set()
    _arm_exit()


def _arm_exit() -> None:
    """Make sure that the process ends: a thread in C, which needs no GIL, ends it."""
    nowhere = open(os.devnull, 'w')  # noqa: PTH123, SIM115  for as long as the process lives
    faulthandler.dump_traceback_later(EXIT_BOUND_S, exit=True, file=nowhere)
