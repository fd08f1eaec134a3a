"""The command that brings up the ROS graph."""

from __future__ import annotations

import os
import signal
import sys
import time
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

import click

from blocks_planning.cli.browser import open_when_served
from blocks_planning.cli.options import refuse_nan
from blocks_planning.cli.robot import robot_for
from blocks_planning.errors import BlocksPlanningError
from blocks_planning.extras import MissingExtra
from blocks_planning.trials.reading import RecordTail, read_records
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.recordfile import RecordFile
from blocks_planning.trials.script import read_script
from blocks_planning.trials.status import TrialStatus

if TYPE_CHECKING:
    from rich.console import Console
    from rich.live import Live

    from blocks_planning.view.scene import Scene

_EXAMPLES = """\b
Examples:
  blocks-planning run config/trials/demo.yaml
  blocks-planning run my_trials.yaml --out results --bag results/bag
  blocks-planning run config/trials/demo.yaml --view --pace 0.3
"""
_PATH = click.Path(path_type=Path)
_FRAMES_PER_S = 8
_MOST_PICTURES = 16
"""Pictures are drawn by default if a script has at most this many trials."""


@click.command(epilog=_EXAMPLES)
@click.argument('script', type=_PATH)
@click.option(
    '--out',
    default='trials',
    show_default=True,
    type=_PATH,
    help='Folder to which records are written.',
)
@click.option(
    '--bag', type=_PATH, help='Folder in which to record all topics as a bag; must not exist.'
)
@click.option('--namespace', default='', help='Namespace of all nodes.')
@click.option('--domain', type=int, help='ROS domain, 0 to 100.  [default: a free one]')
@click.option(
    '--pace',
    type=click.FloatRange(0, 60),
    default=0.0,
    callback=refuse_nan,
    help='Duration of a placement in seconds, to watch the trials.  [default: 0]',
)
@click.option(
    '--placing-timeout',
    type=click.FloatRange(0.1, 86400),
    default=30.0,
    show_default=True,
    callback=refuse_nan,
    help='Seconds that the world may be silent when it has to answer, before its trial ends.',
)
@click.option(
    '--retries',
    type=click.IntRange(0, 10**6),
    default=10,
    show_default=True,
    help='How often an order is given again that the world cannot carry out.',
)
@click.option(
    '--robot', is_flag=True, help='Have a simulated robot carry out the orders (world observed).'
)
@click.option(
    '--robot-setting',
    'robot_settings',
    multiple=True,
    metavar='NAME=VALUE',
    help='Setting of the robot, such as glue=false; see docs/robot.md.',
)
@click.option('--view', is_flag=True, help='Serve a web page that shows the trials live.')
@click.option(
    '--view-host',
    default='127.0.0.1',
    show_default=True,
    help='Address on which to serve the page; an address outside this machine requires a token.',
)
@click.option(
    '--view-port',
    type=click.IntRange(0, 65535),
    default=0,
    help='Port on which to serve the page.  [default: a free one]',
)
@click.option('--participant', default='', help='Code of the person who plans in this session.')
@click.option('--markers', is_flag=True, help='Publish markers for RViz and Foxglove.')
@click.option(
    '--pictures/--no-pictures',
    default=None,
    help=f'Draw the first {_MOST_PICTURES} trials.  [default: only if the script has at most '
    f'{_MOST_PICTURES}]',
)
def run(
    script: Path,
    out: Path,
    bag: Path | None,
    namespace: str,
    domain: int | None,
    pace: float,
    placing_timeout: float,
    retries: int,
    robot: bool,
    robot_settings: tuple[str, ...],
    view: bool,
    view_host: str,
    view_port: int,
    participant: str,
    markers: bool,
    pictures: bool | None,
) -> int:
    """Run the trials of a script through the ROS graph.

    The command writes records to trials.jsonl in the folder --out, and pictures of trials to its
    subfolder pictures. Trials that have a record there are not run again. The exit code is 1 if a
    tower was not rebuilt perfectly.
    """
    specs = read_script(script, participant)
    try:
        from blocks_planning.ros.bringup import Bringup, BringupSpec
    except ImportError as error:
        raise BlocksPlanningError(
            f'ROS 2 is not installed in this Python environment: {error}'
        ) from None
    if view:
        import_module('blocks_planning.view.web.server')  # report a missing extra before the start
    draw = _drawing(pictures, len(specs))
    page = (view_host, view_port) if view else None
    spec = BringupSpec(
        script,
        out,
        bag,
        namespace,
        domain,
        placing_s=pace,
        participant=participant,
        markers=markers,
        view=page,
        placing_timeout_s=placing_timeout,
        retries=retries,
        robot=robot_for(specs, script, robot, robot_settings),
        scenes=_is_terminal(),
    )
    records = RecordFile(spec.records)
    wanted = {trial.trial_id for trial in specs}
    done = len(wanted & records.finished)
    records.close()
    progress = _Progress(RecordTail(spec.records), len(specs), done, spec.scenes)
    bringup = Bringup(spec)
    click.echo(f'To join the graph: {bringup.look_in}', err=True)
    if bringup.page is not None:
        click.echo(f'The page: {bringup.page.url}', err=True)
        if sys.stdin.isatty() and (os.environ.get('DISPLAY') or os.environ.get('WAYLAND_DISPLAY')):
            place = (bringup.page.host, bringup.page.port)
            open_when_served(bringup.page.url, place)
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    ended: list[TrialRecord] = []
    try:
        with progress:
            bringup.run(progress.on_tick)
            progress.on_tick(None)
    finally:
        ended = _summarise(spec.records, wanted)
    if draw is not None:
        draw(ended, out / 'pictures')
    successes = sum(record.status is TrialStatus.SUCCESS for record in ended)
    return int(successes < len(specs))


def _summarise(path: Path, wanted: set[str]) -> list[TrialRecord]:
    """Print the results of the wanted trials; return their records."""
    from blocks_planning.view.tables import print_proposals, print_summaries

    records = read_records(path) if path.stat().st_size else []
    records = [record for record in records if record.spec.trial_id in wanted]
    if records:
        print_summaries(records)
        print_proposals(records)
        click.echo(f'Records: {path}')
    return records


def _drawing(wanted: bool | None, trials: int) -> Callable[[list[TrialRecord], Path], None] | None:
    """A function that draws the first trials into a folder; None if no pictures are wanted.

    Raises:
        MissingExtra: if pictures were requested and the extra that draws them is not installed.
    """
    if wanted is False or (wanted is None and trials > _MOST_PICTURES):
        return None
    try:
        from blocks_planning.view.gallery import print_gallery, save_gallery
    except MissingExtra as error:
        if wanted:
            raise
        click.echo(f'No pictures: {error}', err=True)
        return None

    def draw(records: list[TrialRecord], folder: Path) -> None:
        if records:
            print_gallery(save_gallery(records, folder, _MOST_PICTURES))

    return draw


def _is_terminal() -> bool:
    """Whether towers can be drawn on stderr while trials run."""
    from rich.console import Console

    console = Console(stderr=True)
    return console.is_interactive and console.file.isatty()


class _Progress:
    """Progress on stderr while trials run: the tower in a terminal, otherwise a line per trial."""

    def __init__(self, tail: RecordTail, total: int, done: int, is_drawn: bool) -> None:
        from rich.console import Console

        self._console: Console = Console(stderr=True)
        self._tail = tail
        self._is_drawn = is_drawn
        self._total = total
        self._first = self._done = done
        self._began: float | None = None
        self._drawn = 0.0
        self._live: Live | None = None

    def __enter__(self) -> None:
        from rich.live import Live

        if self._is_drawn:
            self._live = Live(console=self._console, auto_refresh=False, transient=True)
            self._live.start()

    def __exit__(self, *_: object) -> None:
        if self._live is not None:
            self._live.stop()

    def on_tick(self, scene: Scene | None) -> None:
        """Read new records, and draw if enough time has passed since the last frame."""
        now = time.monotonic()
        if scene is not None and self._began is None:
            self._began = now
        for record in self._tail.read():
            self._done += 1
            if self._live is None:
                self._print(record)
        if self._live is None or now - self._drawn < 1 / _FRAMES_PER_S:
            return
        from rich.console import Group

        from blocks_planning.view.terminal import ROOM, frame, signs_for

        self._drawn = now
        size = self._console.size
        trial = min(self._done + 1, self._total)
        heading = self._heading(trial) if scene is not None else 'waiting for the nodes'
        pictures = [heading]
        if scene is not None:
            room = max(size.height - ROOM - 1, 1)
            pictures.append(frame(scene, size.width, room, signs_for(self._console)))  # type: ignore[arg-type]
        self._live.update(Group(*pictures), refresh=True)

    def _print(self, record: TrialRecord) -> None:
        from blocks_planning.view.captions import outcome_of
        from blocks_planning.view.scene import last_scene
        from blocks_planning.view.terminal import signs_for

        outcome = outcome_of(last_scene(record), signs_for(self._console))
        click.echo(f'{self._heading(self._done)}: {outcome}', err=True)

    def _heading(self, trial: int) -> str:
        elapsed = time.monotonic() - (self._began or time.monotonic())
        rate = (self._done - self._first) / elapsed if elapsed > 0 else 0.0
        return f'trial {trial} of {self._total}, {rate:.1f} per second'
