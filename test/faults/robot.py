"""A robot that is cancelled, and one whose node is killed, at any moment.

``python -m faults.robot --cancels 100 --kills 50 --seed 0`` (in ``test/``). Cancels happen in this
process, because the graph adds nothing to them; kills happen to the node of a graph of processes.
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import click
from graphs import COMMAND, is_alive, node_processes, write_script

from blocks_planning.board.blocks import Placed
from blocks_planning.board.geometry import Board
from blocks_planning.errors import RecordError
from blocks_planning.robot.robot import TICK
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.robot.trial import Conditions, RobotTrial
from blocks_planning.trials.messages import ArmOrder, ArmReport, PlacementCode
from blocks_planning.trials.reading import read_records
from blocks_planning.trials.status import TrialStatus
from blocks_planning.trials.verify import contradictions

STOP_S, STILL = 0.2, 0.005
"""Bounds of a stop: simulated time [s], and speed of a joint half a second later [m/s]."""
ACT_S = 4.0
"""About how long an act takes, in simulated time [s]."""
RECOVERY_S = 120.0
LONGEST_WAIT_S = 2.0
STARTING = 0.15
"""Share of kills that come before the restarted robot has done anything."""
FIRST, SECOND = Placed(2, 1, 0, 0), Placed(1, 2, 3, 0)


@dataclass
class Report:
    """What came of it.

    Attributes:
        cancels: by the phase in which they came.
        kills: number of kills.
        slowest_stop_s: in simulated time [s].
        ends: of trials whose robot was killed.
        complaints: what did not hold.
    """

    cancels: Counter[str] = field(default_factory=Counter)
    kills: int = 0
    slowest_stop_s: float = 0.0
    ends: Counter[str] = field(default_factory=Counter)
    complaints: list[str] = field(default_factory=list)


# --- cancels ------------------------------------------------------------------------------------


def cancel_often(report: Report, count: int, seed: int) -> None:
    """Cancel ``count`` orders. After each, the arm stops, and the next order and trial work."""
    chance = random.Random(seed)
    for number in range(count):
        settings = RobotSettings(glue=chance.random() < 0.5)
        for complaint in _cancel(report, settings, number, chance.uniform(0, ACT_S)):
            report.complaints.append(f'cancel {number}: {complaint}')


def _cancel(report: Report, settings: RobotSettings, seed: int, after_s: float) -> Iterator[str]:
    conditions = Conditions(Board(4, 4), settings, seed)
    trial = RobotTrial('cancelled', conditions)
    robot = trial.robot
    trial.take(ArmOrder('cancelled', 0, FIRST))
    phase = ''
    while trial.is_busy and robot.time < after_s:
        phase = trial.step()[0].phase.value
    began, held = robot.time, robot.held
    trial.stop()
    report.cancels[phase] += 1
    report.slowest_stop_s = max(report.slowest_stop_s, robot.time - began)
    if robot.time - began > STOP_S or robot.is_moving:
        yield f'the arm needs {robot.time - began:.2f} s to stop in {phase}'
    for _ in range(round(0.5 / TICK)):
        robot.step()
    if abs(robot.simulation.speeds).max() > STILL:
        yield f'the arm moves after a stop in {phase}'
    if robot.held != held:
        yield f'the arm held block {held} before, and {robot.held} after a stop in {phase}'
    sequence = 0 if trial.take(ArmOrder('cancelled', 0, SECOND)) is None else 1
    after = _carry_out(trial, ArmOrder('cancelled', sequence, SECOND))
    if SECOND not in after.landed:
        yield f'the next order after a stop in {phase}: {after}'
    next_trial = _carry_out(RobotTrial('next', conditions), ArmOrder('next', 0, FIRST))
    if next_trial.code is not PlacementCode.PLACED:
        yield f'the next trial: {next_trial}'


def _carry_out(trial: RobotTrial, order: ArmOrder) -> ArmReport:
    report = trial.take(order)
    while report is None:
        _, report = trial.step()
    return report


# --- kills --------------------------------------------------------------------------------------


def kill_often(report: Report, folder: Path, count: int, seed: int) -> None:
    """Kill the node of the robot so often while scripts run.

    Every trial must be finished or have a reason, and every record must hold.
    """
    chance = random.Random(seed)
    number = 0
    while report.kills < count and not report.complaints:
        number += 1
        place = folder / f'script{number}'
        place.mkdir(parents=True)
        _run_script(report, place, count, chance)


def _run_script(report: Report, folder: Path, count: int, chance: random.Random) -> None:
    towers = folder / 'towers.txt'
    towers.write_text('tower one\n##\n##\n##\n\ntower two\n####\n####\n', encoding='utf-8')
    seeds = max(1, min(5, (count - report.kills) // 2))
    script = write_script(
        folder,
        stimuli=[str(towers)],
        library='2x1,1x2',
        worlds=[{'name': 'observed'}],
        seeds=seeds,
        first_seed=chance.randrange(2**32),
    )
    out, console = folder / 'out', folder / 'console'
    glue = chance.choice(('true', 'false'))
    command = [*COMMAND, str(script), '--out', str(out), '--robot']
    with console.open('wb') as said:
        graph = subprocess.Popen(
            [*command, '--robot-setting', f'glue={glue}'],
            stdout=said,
            stderr=said,
            start_new_session=True,
        )
        try:
            _kill_until_it_ends(report, graph, out, count, chance)
        finally:
            graph.terminate()
            graph.wait()
    text = console.read_text(encoding='utf-8', errors='replace')
    if graph.returncode not in (0, 1) or 'Traceback' in text:
        report.complaints.append(f'the graph ended with {graph.returncode}: see {console}')
    _judge(report, out, expected=2 * seeds)


def _kill_until_it_ends(
    report: Report,
    graph: subprocess.Popen[bytes],
    out: Path,
    count: int,
    chance: random.Random,
) -> None:
    last = 0

    def robot() -> int:
        pid = node_processes(graph.pid).get('robot_arm', 0)
        return pid if pid != last and is_alive(pid) else 0

    while report.kills < count and _wait(graph, robot, RECOVERY_S):
        before = _progress(out)
        if chance.random() >= STARTING:
            _wait(graph, lambda before=before: _progress(out) != before, RECOVERY_S)  # type: ignore[misc]
        _wait(graph, lambda: False, chance.uniform(0, LONGEST_WAIT_S))
        pid = robot()
        if pid:
            with suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)
                report.kills += 1
            last = pid
    if not _wait(graph, lambda: False, RECOVERY_S) and graph.poll() is None:
        report.complaints.append(f'the graph has not ended {RECOVERY_S:.0f} s after the last kill')


def _progress(out: Path) -> list[tuple[str, int]]:
    """Something else after every act and every trial."""
    found = []
    for path in (out / 'trials.jsonl', *(out / 'robot').glob('*.robot')):
        with suppress(OSError):
            found.append((path.name, path.stat().st_mtime_ns))
    return sorted(found)


def _wait(graph: subprocess.Popen[bytes], condition: Callable[[], object], seconds: float) -> bool:
    """Wait until a condition holds; False if the graph ends first, or it takes too long."""
    deadline = time.monotonic() + seconds
    while graph.poll() is None and time.monotonic() < deadline:
        if condition():
            return True
        with suppress(subprocess.TimeoutExpired):
            graph.wait(0.02)
    return False


def _judge(report: Report, out: Path, expected: int) -> None:
    try:
        records = list(read_records(out / 'trials.jsonl'))
    except RecordError as error:
        report.complaints.append(str(error))
        return
    if len(records) != expected:
        report.complaints.append(f'{out} has {len(records)} records, expected {expected}')
    for record in records:
        report.ends[record.status.value] += 1
        name = f'{out}: trial {record.spec.trial_id}'
        report.complaints += [f'{name}: {wrong}' for wrong in contradictions(record)]
        if record.status is TrialStatus.CANCELLED and not record.reason:
            report.complaints.append(f'{name} was cancelled without a reason')


@click.command()
@click.option('--cancels', default=100, show_default=True, type=click.IntRange(0))
@click.option('--kills', default=50, show_default=True, type=click.IntRange(0))
@click.option('--seed', default=0, show_default=True)
def main(cancels: int, kills: int, seed: int) -> None:
    """Cancel and kill the robot; the exit code is 1 if something did not hold."""
    report, began = Report(), time.monotonic()
    folder = Path(tempfile.mkdtemp(prefix='robot-faults-'))
    cancel_often(report, cancels, seed)
    click.echo(
        f'{report.cancels.total()} cancels in {time.monotonic() - began:.0f} s, slowest stop '
        f'{report.slowest_stop_s:.2f} s simulated; by phase: {dict(report.cancels)}'
    )
    began = time.monotonic()
    kill_often(report, folder, kills, seed)
    click.echo(
        f'{report.kills} kills in {time.monotonic() - began:.0f} s; '
        f'ends of {report.ends.total()} trials: {dict(report.ends)}'
    )
    if report.complaints:
        click.echo('\n'.join([*report.complaints, f'Everything is in {folder}']))
        sys.exit(1)
    shutil.rmtree(folder)


if __name__ == '__main__':
    main()
