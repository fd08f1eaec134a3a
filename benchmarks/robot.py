"""Let the robot carry out the plans of trials: how often the tower is right, and what it takes.

python -m benchmarks.robot                                # 16 towers, glued, no noise
python -m benchmarks.robot --loose --grip-noise 0.001
python -m benchmarks.robot --tower 13 --film robot.gif    # arm and record side by side
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from statistics import mean

import click
from PIL import Image

from blocks_planning.board.stimuli import Stimulus, find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.robot.driving import carry_out_all, score
from blocks_planning.robot.film import Film
from blocks_planning.robot.robot import Robot
from blocks_planning.robot.settings import CAMERA, POSES, RobotSettings
from blocks_planning.search.searches import BreadthFirst
from blocks_planning.subgoals.scoping import Scoping
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view.picture import image_of
from blocks_planning.view.scene import scenes_of

SET = 'cogsci2021'


@dataclass(frozen=True)
class Row:
    """A tower that was built once.

    Attributes:
        surprises: acts after which something else was seen than expected.
        failures: reasons of the acts that failed.
        simulated: per block [s].
        computed: per block, by the clock of this machine [s].
    """

    tower: str
    seed: int
    blocks: int
    is_perfect: bool
    f1: float
    surprises: int
    failures: list[str]
    simulated: float
    computed: float


def planned(stimulus: Stimulus, seed: int) -> TrialRecord:
    """The trial whose placements are ordered."""
    task = Task(stimulus.board, stimulus.silhouette)
    return run_trial(TrialSpec(stimulus.name, task, Scoping(), BreadthFirst(depth=3), seed))


def build(
    stimulus: Stimulus, record: TrialRecord, settings: RobotSettings, film: Path | None
) -> Row:
    """Let the robot build what a trial has built."""
    seed = record.spec.seed
    robot = Robot(stimulus.board, settings, seed)
    camera = Film(robot) if film else None
    begun = time.perf_counter()
    orders = [placed.placement for placed in record.placements]
    acts = carry_out_all(robot, orders, camera.watch if camera else None)
    computed = time.perf_counter() - begun
    if camera and film:
        camera.save(film, list(pictures(record)))
        camera.close()
    result = score(stimulus.silhouette, robot.seen.built(robot.board))
    return Row(
        stimulus.name,
        seed,
        len(acts),
        result.is_perfect,
        result.f1,
        sum(act.is_surprise for act in acts),
        [act.report.reason.value for act in acts if act.report.reason],
        robot.time / len(acts),
        computed / len(acts),
    )


def pictures(record: TrialRecord) -> Iterator[Image.Image]:
    """The record after no block, one block, two blocks, ..."""
    last = {len(scene.placements): scene for scene in scenes_of(record)}
    return map(image_of, last.values())


@click.command()
@click.option('--tower', default='', help='Only this one, such as 13.')
@click.option('--seeds', default=1, show_default=True, type=click.IntRange(1))
@click.option('--loose', is_flag=True, help='Do not glue the blocks.')
@click.option('--pose-noise', default=0.0, show_default=True, help='In metres.')
@click.option('--grip-noise', default=0.0, show_default=True, help='In metres.')
@click.option('--camera', is_flag=True, help='See by a picture.')
@click.option('--film', type=click.Path(path_type=Path), help='GIF of the last tower.')
@click.option('--out', type=click.Path(path_type=Path), help='JSON lines, one per tower.')
def main(
    tower: str,
    seeds: int,
    loose: bool,
    pose_noise: float,
    grip_noise: float,
    camera: bool,
    film: Path | None,
    out: Path | None,
) -> None:
    """Build towers and say how it went."""
    settings = RobotSettings(
        glue=not loose,
        perception=CAMERA if camera else POSES,
        pose_noise_m=pose_noise,
        grip_noise_m=grip_noise,
    )
    rows = []
    for stimulus in find_stimuli(f'{SET}/{tower}' if tower else SET):
        for seed in range(seeds):
            row = build(stimulus, planned(stimulus, seed), settings, film)
            rows.append(row)
            words = 'perfect' if row.is_perfect else f'F1 {row.f1:.3f}'
            print(
                f'{row.tower:14} seed {seed}: {row.blocks:2} blocks, {words}, '
                f'{row.surprises} surprises, {row.simulated:.2f} s simulated and '
                f'{row.computed:.2f} s computed per block {" ".join(row.failures)}',
                flush=True,
            )
    if out:
        out.write_text(''.join(json.dumps(asdict(row)) + '\n' for row in rows), encoding='utf-8')
    print(
        f'{sum(row.is_perfect for row in rows)} of {len(rows)} perfect, '
        f'mean F1 {mean(row.f1 for row in rows):.3f}, '
        f'{mean(row.simulated for row in rows):.2f} s simulated and '
        f'{mean(row.computed for row in rows):.2f} s computed per block'
    )


if __name__ == '__main__':
    main()
