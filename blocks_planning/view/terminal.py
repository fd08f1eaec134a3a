"""Watching a trial in a terminal."""

from __future__ import annotations

from time import monotonic, sleep

from rich.console import Console
from rich.live import Live
from rich.table import Table
from rich.text import Text

from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, PlaceBlock
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.view import palette
from blocks_planning.view.board import board_text, scale_for, size_at
from blocks_planning.view.captions import outcome_of
from blocks_planning.view.compact import compact_size, compact_text
from blocks_planning.view.palette import Signs
from blocks_planning.view.panel import MIN_WIDTH, panel
from blocks_planning.view.scene import Scene, last_scene, scene_after, scene_of

GAP = 3
"""Space between board and panel [characters]."""
PANEL_LINES = 8
"""Number of lines of the panel without a decision, if no setting needs an extra line."""
ROOM = 2
"""Lines below the frame for the cursor and the next output."""
PATIENCE_S = 0.02
"""Period at which a pause checks whether the trial was cancelled [s]."""


def watch_trial(
    spec: TrialSpec, console: Console, cancel: CancelToken, pause_s: float
) -> TrialRecord:
    """Run a trial and show its progress.

    In a terminal every decision and placement replaces the previous picture. Other outputs, such as
    a pipe or a terminal that can't move its cursor, get the last picture and a line about the end
    of the trial.

    Args:
        spec: the trial.
        console: where to draw.
        cancel: ends the trial, and a pause, from another thread or a signal handler.
        pause_s: duration of the display of each decision and placement [s]; only in a terminal.
    """
    if console.is_interactive and console.file.isatty():
        return _watch_live(spec, console, cancel, pause_s)
    record = run_trial(spec, cancel)
    print_outcome(record, console)
    return record


def print_outcome(record: TrialRecord, console: Console) -> None:
    """Print the last picture of a trial, and a line about its end."""
    scene = last_scene(record)
    board = scene.task.board
    scale = min(scale_for(board, console.width, console.height - ROOM), 2)
    signs = signs_for(console)
    fits = size_at(board, scale)[0] <= console.width
    picture = board_text(scene, scale, signs) if fits else compact_text(scene, signs)
    for text in picture, Text(outcome_of(scene, signs)):
        console.print(text, soft_wrap=True)


def frame(scene: Scene, width: int, height: int, signs: Signs = palette.UNICODE) -> Table:
    """The board and panel of a scene, side by side or, if that is too wide, one above the other.

    The board is drawn as large as ``width`` x ``height`` characters allow; in its compact form if
    no other form leaves room for ``PANEL_LINES`` lines of the panel. If the compact form is also
    too large, only its lowest rows are drawn, with a line that tells the required size.
    """
    board = scene.task.board
    scale = scale_for(board, width - GAP - MIN_WIDTH, height)
    wide, high = size_at(board, scale)
    picture = board_text(scene, scale, signs)
    if not _fits(wide, high, width, height):
        wide, high = compact_size(board)
        picture = _lowest_lines(compact_text(scene, signs), wide, high, width, height)
    grid = Table.grid(padding=(0, GAP, 0, 0))
    if width - GAP - wide >= MIN_WIDTH:
        grid.add_row(picture, panel(scene, width - GAP - wide, height, signs))
    else:
        grid.add_row(picture)
        if height > high:
            grid.add_row(panel(scene, width, height - high, signs))
    return grid


def _fits(wide: int, high: int, width: int, height: int) -> bool:
    """Whether there is room for a board and the most important lines of the panel."""
    if width - GAP - wide >= MIN_WIDTH:
        return high <= height
    return wide <= width and high + PANEL_LINES <= height


def _lowest_lines(picture: Text, wide: int, high: int, width: int, height: int) -> Text:
    """The lowest lines that fit of a picture of ``wide`` x ``high`` characters, with a note."""
    if high <= height and wide <= width:
        return picture
    note = Text(f'too small: needs {wide} x {high + ROOM}')
    kept = picture.split('\n')[-max(height - 1, 0) :] if height > 1 else []
    return Text('\n', no_wrap=True, overflow='crop').join([note, *kept])


def signs_for(console: Console) -> Signs:
    """The characters that a console can show."""
    return palette.ASCII if console.options.ascii_only else palette.UNICODE


def _watch_live(
    spec: TrialSpec, console: Console, cancel: CancelToken, pause_s: float
) -> TrialRecord:
    scene = scene_of(spec)

    def drawn() -> Table:
        height = max(console.height - ROOM, 1)
        return frame(scene, console.width, height, signs_for(console))

    with Live(drawn(), console=console, auto_refresh=False, vertical_overflow='crop') as live:

        def observe(message: Message) -> None:
            nonlocal scene
            if isinstance(message, PlaceBlock):
                wait(cancel, pause_s)
            after = scene_after(scene, message)
            if after is not scene:
                scene = after
                live.update(drawn(), refresh=True)

        record = run_trial(spec, cancel, observe)
        scene = last_scene(record)
        live.update(drawn(), refresh=True)
    return record


def wait(cancel: CancelToken, duration_s: float) -> None:
    """Wait for a duration [s], or until the token is cancelled."""
    end = monotonic() + duration_s
    while not cancel.cancelled and (left := end - monotonic()) > 0:
        sleep(min(left, PATIENCE_S))
