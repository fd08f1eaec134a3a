"""Long work: what is shown of it, and that a limit of one tower does not end the others."""

from __future__ import annotations

import io
import re
import threading
from collections.abc import Callable
from functools import partial

import pytest
from rich.console import Console

from blocks_planning.cli import progress
from blocks_planning.cli.progress import Job, Progress, bar, each
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.result import CancelToken


class Clock:
    """Time that passes when it is told to."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now_s = 100.0
        monkeypatch.setattr(progress, 'monotonic', lambda: self.now_s)


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    return Clock(monkeypatch)


def a_log() -> Console:
    return Console(file=io.StringIO(), width=80, _environ={})


def a_terminal() -> Console:
    environment = {'TERM': 'xterm-256color'}
    return Console(file=io.StringIO(), width=80, force_terminal=True, _environ=environment)


def text_of(console: Console) -> str:
    assert isinstance(console.file, io.StringIO)
    return console.file.getvalue()


def lines_of(console: Console, clock: Clock, until_s: int) -> list[str]:
    """The lines that are shown when progress is offered every second."""
    shown = Progress(console)
    for second in range(until_s + 1):
        clock.now_s = 100.0 + second
        shown.show(partial('after {}'.format, second))
    return text_of(console).splitlines()


def test_a_log_gets_a_line_now_and_then(clock: Clock) -> None:
    lines = lines_of(a_log(), clock, 1100)
    seconds = [30, 60, 120, 240, 480, 780, 1080]
    assert lines == [f'after {second}' for second in seconds]


def test_a_terminal_sees_nothing_for_two_seconds_and_then_one_line(clock: Clock) -> None:
    console = a_terminal()
    shown = Progress(console)
    clock.now_s += 1.9
    shown.show(lambda: 'early')
    assert text_of(console) == ''
    for step in range(3):
        clock.now_s += 0.2
        shown.show(partial('step {}'.format, step))
    shown.show(lambda: 'too soon')
    shown.hide()
    words = re.findall(r'step \d|early|too soon', text_of(console))
    assert list(dict.fromkeys(words)) == ['step 0', 'step 1', 'step 2']
    assert text_of(console).count('\n') <= 2  # drawn over itself, then taken away
    assert text_of(console).rindex('\x1b[?25h') > text_of(console).rindex('\x1b[?25l')


def test_what_is_said_stays(clock: Clock) -> None:
    console = a_terminal()
    shown = Progress(console)
    clock.now_s += 3
    shown.show(lambda: 'at work')
    shown.say('a tower [is] done')
    assert text_of(console).endswith('a tower [is] done\n')


def at_once(result: object) -> Callable[[CancelToken], object]:
    return lambda _cancel: result


def too_large(_cancel: CancelToken) -> None:
    raise LimitExceeded('more than 9 states')


def until_cancelled(cancel: CancelToken) -> str:
    pause = threading.Event()
    while not cancel.cancelled:
        pause.wait(0.001)
    return 'as far as it came'


def test_a_limit_of_one_tower_does_not_end_the_others() -> None:
    jobs: list[Job[object]] = [Job('a', at_once(1)), Job('b', too_large), Job('c', at_once(3))]
    outcomes = list(each('work', jobs, 3, progress=Progress(a_log())))
    assert [outcome[:3] for outcome in outcomes] == [
        ('a', 1, ''),
        ('b', None, 'more than 9 states'),
        ('c', 3, ''),
    ]


def test_the_time_limit_holds_for_each_tower() -> None:
    jobs: list[Job[object]] = [
        Job('a', until_cancelled),
        Job('b', at_once(2)),
        Job('c', until_cancelled),
    ]
    outcomes = list(each('work', jobs, 3, 0.01, Progress(a_log())))
    problem = 'not finished within the time limit of 0.01 s'
    assert [outcome[:3] for outcome in outcomes] == [
        ('a', 'as far as it came', problem),
        ('b', 2, ''),
        ('c', 'as far as it came', problem),
    ]


def test_another_error_is_not_taken_for_a_limit() -> None:
    def wrong(_cancel: CancelToken) -> None:
        raise ConfigurationError('no such search')

    with pytest.raises(ConfigurationError):
        list(each('work', [Job('a', wrong)], 1, progress=Progress(a_log())))


class Interrupting(Progress):
    """Ctrl-C comes when progress is shown."""

    def show(self, describe: Callable[[], str]) -> None:
        assert re.fullmatch(r'work a \(1 of 2\): half, \d+ s', describe())
        raise KeyboardInterrupt


@pytest.mark.parametrize('result', ['partial', None])
def test_ctrl_c_ends_the_work_and_hands_out_what_there_is(result: str | None) -> None:
    def work(cancel: CancelToken) -> str | None:
        until_cancelled(cancel)
        return result

    found: list[str | None] = []
    outcomes = each('work', [Job('a', work, 'half')] * 2, 2, None, Interrupting(a_log()))
    with pytest.raises(KeyboardInterrupt):
        found.extend(outcome.result for outcome in outcomes)
    assert found == [result] * (result is not None)


@pytest.mark.parametrize('value', ['0', '-1', 'nan'])
def test_a_time_limit_is_above_zero(value: str) -> None:
    with pytest.raises(ConfigurationError, match='seconds above 0'):
        progress._check_time(None, None, float(value))


def test_a_sweep_in_a_log_says_how_far_it_is(
    clock: Clock, capsys: pytest.CaptureFixture[str]
) -> None:
    with bar('Trials') as report:
        report(1, 10)
        clock.now_s += 31
        report(5_000, 10_000)
    assert capsys.readouterr().err == 'Trials: 5,000 of 10,000\n'
