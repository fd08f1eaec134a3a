from __future__ import annotations

import re
import subprocess
import sys
from dataclasses import replace
from io import BytesIO, StringIO, TextIOWrapper
from typing import IO, Any

import pytest
from rich.console import Console

from blocks_planning.errors import LimitExceeded
from blocks_planning.search.result import CancelToken
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.trials.status import TrialStatus
from blocks_planning.view import palette, terminal
from blocks_planning.view.board import board_text
from blocks_planning.view.captions import outcome_of
from blocks_planning.view.scene import last_scene, scene_of, scenes_of
from blocks_planning.view.terminal import frame, print_outcome, wait, watch_trial

COLOUR = re.compile(r'\x1b\[[0-9;]*[34]8;[0-9;]*m')


class Terminal(StringIO):
    """Text that is written to a terminal."""

    def isatty(self) -> bool:
        return True


def console_on(file: IO[str], width: int = 80, **environment: str) -> Console:
    usual = {'TERM': 'xterm-256color', 'COLORTERM': 'truecolor'}
    return Console(file=file, width=width, height=24, _environ={**usual, **environment})


def written(spec: TrialSpec, file: StringIO, **environment: str) -> str:
    watch_trial(spec, console_on(file, 80, **environment), CancelToken(), 0)
    return file.getvalue()


def without_codes(text: str) -> str:
    return re.sub(r'\x1b\[[0-9;?]*[A-Za-z]', '', text)


@pytest.mark.parametrize('file', [StringIO, Terminal])
def test_the_record_is_that_of_an_unwatched_trial(tower_spec, file):
    spec = tower_spec()
    record = watch_trial(spec, console_on(file()), CancelToken(), 0)
    assert record == run_trial(spec)


def test_a_pipe_gets_the_last_picture_and_a_line(tower_spec, recorded):
    spec = tower_spec()
    scene = last_scene(recorded(spec))
    assert written(spec, StringIO()) == f'{board_text(scene, 2).plain}\n{outcome_of(scene)}\n'


def test_a_dumb_terminal_gets_no_control_codes(tower_spec):
    spec = tower_spec()
    assert written(spec, Terminal(), TERM='dumb') == written(spec, StringIO())


def test_forcing_colours_into_a_pipe_does_not_move_its_cursor(tower_spec):
    text = written(tower_spec(), StringIO(), FORCE_COLOR='1')
    assert COLOUR.search(text)
    assert set(re.findall(r'\x1b\[[0-9;?]*([A-Za-z])', text)) == {'m'}


def test_a_terminal_sees_every_scene(tower_spec, recorded):
    spec = tower_spec()
    text = without_codes(written(spec, Terminal()))
    assert COLOUR.search(written(spec, Terminal()))
    for scene in scenes_of(recorded(spec)):
        for line in board_text(scene, 2).plain.split('\n'):
            assert line.rstrip() in text
    for blocks in range(len(scene.blocks) + 1):
        assert f'blocks     {blocks}' in text
    last = text[text.rindex('cogsci2021/9') :]
    assert 'status     success' in last


def test_no_color_leaves_no_colour(tower_spec):
    text = written(tower_spec(), Terminal(), NO_COLOR='1')
    assert not COLOUR.search(text)
    assert '═' in text


@pytest.mark.parametrize('file', [StringIO, Terminal])
def test_a_cancelled_trial_says_so(tower_spec, monkeypatch, file):
    def run_and_cancel(*arguments: Any) -> TrialRecord:
        return replace(run_trial(*arguments), status=TrialStatus.CANCELLED)

    monkeypatch.setattr(terminal, 'run_trial', run_and_cancel)
    stream = file()
    watch_trial(tower_spec(), console_on(stream), CancelToken(), 0)
    assert 'cancelled' in stream.getvalue()


def test_there_is_a_pause_before_every_placement(tower_spec, monkeypatch):
    pauses: list[float] = []
    monkeypatch.setattr(terminal, 'wait', lambda _, pause_s: pauses.append(pause_s))
    record = watch_trial(tower_spec(), console_on(Terminal()), CancelToken(), 0.25)
    assert pauses == [0.25] * record.blocks


def test_cancelled_in_a_pause_it_stands_as_it_was_shown(tower_spec, monkeypatch):
    pauses: list[float] = []

    def pause(cancel: CancelToken, pause_s: float) -> None:
        pauses.append(pause_s)
        if len(pauses) == 4:
            cancel.cancel()

    monkeypatch.setattr(terminal, 'wait', pause)
    stream = Terminal()
    record = watch_trial(tower_spec(), console_on(stream), CancelToken(), 1)
    assert (record.status, record.blocks, len(pauses)) == (TrialStatus.CANCELLED, 3, 4)
    text = without_codes(stream.getvalue())
    assert 'blocks     4' not in text
    assert 'blocks     3' in text[text.rindex('status     cancelled') :]


class Clock:
    """Time that passes by sleeping only."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 100.0
        self.naps_s: list[float] = []
        self.token = CancelToken()
        self.cancel_after = 1000
        monkeypatch.setattr(terminal, 'monotonic', lambda: self.now_s)
        monkeypatch.setattr(terminal, 'sleep', self.sleep)

    def sleep(self, duration_s: float) -> None:
        assert 0 < duration_s <= terminal.PATIENCE_S
        assert not self.token.cancelled
        self.naps_s.append(duration_s)
        self.now_s += duration_s
        if len(self.naps_s) == self.cancel_after:
            self.token.cancel()


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    return Clock(monkeypatch)


def test_a_pause_lasts_as_long_as_it_should(clock):
    wait(clock.token, 0.25)
    assert sum(clock.naps_s) == pytest.approx(0.25)


@pytest.mark.parametrize('pause_s', [0.0, -1.0, float('nan')])
def test_no_pause(clock, pause_s):
    wait(clock.token, pause_s)
    assert clock.naps_s == []


@pytest.mark.parametrize('naps', [1, 3])
def test_cancelling_ends_a_pause_at_once(clock, naps):
    clock.cancel_after = naps
    wait(clock.token, float('inf'))
    assert len(clock.naps_s) == naps


@pytest.mark.parametrize('board', [(8, 8), (3, 3), (16, 16), (1, 16), (16, 1), (1, 1)])
@pytest.mark.parametrize('size', [(80, 22), (100, 28), (200, 48)])
@pytest.mark.parametrize('strategy', ['none', 'scoping'])
def test_frames_fit_into_usual_terminals(filled_spec, recorded, board, size, strategy):
    scenes = list(scenes_of(recorded(filled_spec(*board, strategy))))
    for scene in (*scenes[:3], scenes[-1]):
        console = console_on(StringIO())
        lines = console.render_lines(
            frame(scene, *size), console.options.update_width(size[0]), pad=False
        )
        text = [''.join(segment.text for segment in line) for line in lines]
        assert len(text) <= size[1]
        assert max(map(len, text)) <= size[0]
        assert any(line.startswith(' 1 ') for line in text)
        assert sum('planning cost' in line for line in text) == 2


def test_a_narrow_terminal_gets_the_panel_below(tower_spec):
    console = console_on(StringIO(), width=40)
    console.print(frame(scene_of(tower_spec()), 40, 30))
    assert isinstance(console.file, StringIO)
    lines = [line.rstrip() for line in console.file.getvalue().split('\n')]
    assert lines.index('cogsci2021/9') == 9


def test_ascii_only(tower_spec, recorded):
    record = recorded(tower_spec(name='türme'))
    stream = TextIOWrapper(BytesIO(), encoding='ascii')
    console = console_on(stream)
    assert terminal.signs_for(console) is palette.ASCII
    print_outcome(record, console)
    stream.seek(0)
    assert 't?rme: success' in stream.read()


def test_a_limit_is_reported_and_the_cursor_is_shown_again(tower_spec, monkeypatch):
    def refuse(*_: object) -> None:
        raise LimitExceeded('too large')

    monkeypatch.setattr(terminal, 'run_trial', refuse)
    stream = Terminal()
    with pytest.raises(LimitExceeded):
        watch_trial(tower_spec(), console_on(stream), CancelToken(), 0)
    assert stream.getvalue().rindex('\x1b[?25h') > stream.getvalue().rindex('\x1b[?25l')


def test_importing_it_does_not_import_matplotlib():
    code = 'import sys, blocks_planning.view.terminal; print("matplotlib" in sys.modules)'
    done = subprocess.run([sys.executable, '-c', code], capture_output=True, text=True, check=True)
    assert done.stdout == 'False\n'
