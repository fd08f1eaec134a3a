"""The study of noise: the same towers and planners, built by robots that err more or less.

Each trial runs in this or another process, and becomes one row of a file; a run that was
interrupted continues behind the last row. Rows contain no durations by the clock, so they are the
same in every run on one machine.
"""

from __future__ import annotations

import json
import multiprocessing
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.robot.building import build
from blocks_planning.robot.settings import RobotSettings
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.decision import Strategy
from blocks_planning.subgoals.full import FullSubgoals
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.linefile import LineFile
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.verify import contradictions
from blocks_planning.worlds.world import Observed

ROWS = 'trials.jsonl'
"""Name of the file of rows."""

ROBOTS = {
    'glued, exact': RobotSettings(),
    'glued, grip 4 mm': RobotSettings(grip_noise_m=0.004),
    'glued, pose 8 mm': RobotSettings(pose_noise_m=0.008),
    'loose, exact': RobotSettings(glue=False),
    'loose, grip 2 mm': RobotSettings(glue=False, grip_noise_m=0.002),
}
"""Robots of the study by what they are called: glue, and the standard deviation of the noise."""
PLANNERS: dict[str, Strategy] = {
    'scoping subgoal': Scoping(),
    'full replan': FullSubgoals(),
    'full blind': FullSubgoals(surprise='blind'),
}
"""Planners of the study by what they are called."""


TOWERS = tuple(f'cogsci2021/{number}' for number in range(1, 17, 2))
"""Towers of the study: every second one."""


@dataclass(frozen=True)
class Study:
    """The trials of a study: every tower, seed, robot and planner.

    Attributes:
        stimuli: towers, as in a script.
        seeds: of the planners and of the noise.
        robots: names of :data:`ROBOTS`.
        planners: names of :data:`PLANNERS`.
    """

    stimuli: tuple[str, ...] = TOWERS
    seeds: tuple[int, ...] = (0,)
    robots: tuple[str, ...] = tuple(ROBOTS)
    planners: tuple[str, ...] = tuple(PLANNERS)

    def cases(self) -> Iterator[Case]:
        """Every trial, in a fixed order."""
        for text in self.stimuli:
            for stimulus in find_stimuli(text):
                for seed in self.seeds:
                    for robot in self.robots:
                        for planner in self.planners:
                            yield Case(robot, planner, stimulus.name, seed)


QUICK = Study(('cogsci2021/13',), robots=('glued, exact', 'glued, pose 8 mm'))


@dataclass(frozen=True)
class Case:
    """A trial of a study: names of :data:`ROBOTS`, :data:`PLANNERS` and a tower, and its seed."""

    robot: str
    planner: str
    stimulus: str
    seed: int


def run_study(
    study: Study, folder: Path, workers: int, report: Callable[[int, int], None]
) -> list[dict[str, Any]]:
    """Run the trials that are not in the file yet; return the rows of all, in order.

    Args:
        study: which trials.
        folder: of the file :data:`ROWS`.
        workers: number of processes.
        report: called with the numbers of finished and of all trials.

    Raises:
        RecordError: if the file cannot be written.
    """
    cases = list(study.cases())
    file = LineFile(folder / ROWS)
    try:
        rows = {case_of(row): row for row in map(json.loads, file.lines())}
        missing = [case for case in cases if case not in rows]
        report(len(cases) - len(missing), len(cases))
        for number, row in enumerate(_run(missing, workers), start=1):
            file.append(json.dumps(row).encode())
            rows[case_of(row)] = row
            report(len(cases) - len(missing) + number, len(cases))
    finally:
        file.close()
    return [rows[case] for case in cases]


def case_of(row: dict[str, Any]) -> Case:
    """The trial of a row."""
    return Case(**{one.name: row[one.name] for one in fields(Case)})


def _run(cases: Iterable[Case], workers: int) -> Iterator[dict[str, Any]]:
    if workers == 1:
        yield from map(run_case, cases)
        return
    # A forked process would share the kernels of this one, and their threads.
    with multiprocessing.get_context('spawn').Pool(workers) as pool:
        yield from pool.imap(run_case, cases)


def run_case(case: Case) -> dict[str, Any]:
    """Let a robot build a tower; return the row of the trial.

    ``success`` and ``f1`` are those of the real board; ``status`` is that of the record, which
    knows only what was perceived. ``states`` counts the evaluated states [states].
    """
    [stimulus] = find_stimuli(case.stimulus)
    task = Task(stimulus.board, stimulus.silhouette)
    planner, search = PLANNERS[case.planner], BreadthFirst(depth=3)
    spec = TrialSpec(stimulus.name, task, planner, search, case.seed, world=Observed())
    built = build(spec, ROBOTS[case.robot])
    record, score = built.record, built.score
    return {
        **{one.name: getattr(case, one.name) for one in fields(Case)},
        'status': record.status.value,
        'reason': record.reason,
        'success': score.is_perfect,
        'f1': score.f1,
        'blocks': record.blocks,
        'surprises': record.surprises,
        'acts': sum(built.codes.values()),
        'codes': {code.name.lower(): count for code, count in sorted(built.codes.items())},
        'failures': {reason.value: count for reason, count in sorted(built.reasons.items())},
        'states': record.subgoal_planning_cost,
        'simulated_s': built.robot.robot.time,
        'contradictions': list(contradictions(record)),
    }
