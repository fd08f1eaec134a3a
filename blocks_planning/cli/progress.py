"""Long work on the command line: progress, time limits, and towers that outgrow a limit.

After 2 s of work a terminal shows on stderr, on one line that is drawn again and again, what is
being worked on and how far it is. Anything else, such as a log file, gets a line after 30 s, 1, 2
and 4 minutes, and then every 5 minutes.

A tower that reaches a limit (of states, of memory, or of time) does not end the others: its row
says what happened, and the command ends with exit code ``LIMIT_REACHED``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING, Any, Generic, NamedTuple, TypeVar

import click

from blocks_planning.cli.interrupt import supervised
from blocks_planning.errors import ConfigurationError, LimitExceeded
from blocks_planning.search.result import CancelToken

if TYPE_CHECKING:  # rich is imported where it is used: --help has to come at once
    from rich.console import Console
    from rich.live import Live

T = TypeVar('T')

LIMIT_REACHED = 3
"""Exit code of a command in which a tower reached a limit."""
QUIET_S = 2.0
"""How long work is done in a terminal without showing progress [s]."""
FIRST_LINE_S = 30.0
"""How long work is done without a line on progress where stderr is no terminal [s]."""
_REDRAW_S = 0.1
_LONGEST_SILENCE_S = 300.0


def _check_time(_context: object, _option: object, value: float | None) -> float | None:
    if value is not None and not value > 0:
        raise ConfigurationError(f'--time-limit: expected seconds above 0, got {value}')
    return value


time_limit_option = click.option(
    '--time-limit',
    'time_limit_s',
    type=float,
    metavar='SECONDS',
    callback=_check_time,
    help='Most time for each tower; what is not finished by then is reported, and the next begins.',
)


class Progress:
    """Shows how far work is, once it takes longer than 2 s."""

    def __init__(self, console: Console | None = None) -> None:
        """Nothing is shown yet; the clock starts."""
        from rich.console import Console

        self._console = console or Console(stderr=True)
        self._began = self._drawn = monotonic()
        self._next_line_s = FIRST_LINE_S
        self._live: Live | None = None

    def show(self, describe: Callable[[], str]) -> None:
        """Show a line if it is time for one; ``describe`` is called only then."""
        now = monotonic()
        passed = now - self._began
        if not (self._console.is_terminal and self._console.is_interactive):
            if passed >= self._next_line_s:
                self._next_line_s += min(self._next_line_s, _LONGEST_SILENCE_S)
                self._say(describe())
        elif passed >= QUIET_S and now - self._drawn >= _REDRAW_S:
            self._drawn = now
            self._draw(describe())

    def hide(self) -> None:
        """Take the line away, so that something else can be printed."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def say(self, line: str) -> None:
        """Print a line that stays."""
        self.hide()
        self._say(line)

    def _say(self, line: str) -> None:
        from rich.text import Text

        self._console.print(Text(line), soft_wrap=True)

    def _draw(self, line: str) -> None:
        from rich.live import Live
        from rich.text import Text

        text = Text(line, no_wrap=True, overflow='ellipsis')
        if self._live is None:
            self._live = Live(
                text,
                console=self._console,
                auto_refresh=False,
                transient=True,
                redirect_stdout=False,
                redirect_stderr=False,
            )
            self._live.start()
        self._live.update(text, refresh=True)


@dataclass(frozen=True)
class Job(Generic[T]):
    """A piece of work on one tower.

    Attributes:
        name: of the tower.
        work: does it; given a token that ends it early.
        gauge: its text says how far the work is.
    """

    name: str
    work: Callable[[CancelToken], T]
    gauge: object = ''


class Outcome(NamedTuple, Generic[T]):
    """What became of a job.

    Attributes:
        name: of the tower.
        result: of the work; None if it outgrew a limit.
        problem: the limit that it reached; '' if it was finished.
        took_s: time that it took [s].
    """

    name: str
    result: T | None
    problem: str
    took_s: float


def each(
    what: str,
    jobs: Iterable[Job[T]],
    total: int,
    time_limit_s: float | None = None,
    progress: Progress | None = None,
) -> Iterator[Outcome[T]]:
    """Do jobs one after the other and hand out each outcome as soon as it is there.

    Args:
        what: is being done, for the line of progress.
        jobs: in order.
        total: their number.
        time_limit_s: most time for each [s].
        progress: where it is shown; made if left out.

    Raises:
        KeyboardInterrupt: on Ctrl-C, after the outcome of the job that it ended if it has a result.
    """
    progress = progress or Progress()
    try:
        for number, job in enumerate(jobs, start=1):
            began = monotonic()
            describe = _Description(what, number, total, job, began)
            outcome, interrupted = _outcome(job, began, progress, describe, time_limit_s)
            if not interrupted:
                progress.show(describe)
            progress.hide()
            if outcome.result is not None or not interrupted:
                yield outcome
            if interrupted:
                raise KeyboardInterrupt
    finally:
        progress.hide()


@dataclass(frozen=True)
class _Description:
    """The line of progress of a job."""

    what: str
    number: int
    total: int
    job: Job[Any]
    began: float

    def __call__(self) -> str:
        place = f' ({self.number:,} of {self.total:,})' if self.total > 1 else ''
        gauge = str(self.job.gauge)
        passed = f'{monotonic() - self.began:,.0f} s'
        return f'{self.what} {self.job.name}{place}: {", ".join(filter(None, (gauge, passed)))}'


def _outcome(
    job: Job[T],
    began: float,
    progress: Progress,
    describe: Callable[[], str],
    time_limit_s: float | None,
) -> tuple[Outcome[T], bool]:
    """What becomes of a job, and whether it was interrupted."""
    try:
        ended = supervised(job.work, lambda: progress.show(describe), time_limit_s)
    except LimitExceeded as error:
        return Outcome(job.name, None, str(error), monotonic() - began), False
    problem = (
        f'not finished within the time limit of {time_limit_s:g} s' if ended.timed_out else ''
    )
    return Outcome(job.name, ended.result, problem, monotonic() - began), ended.interrupted


@contextmanager
def bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar on stderr with rate and time left, if it is a terminal; yields its setter.

    Elsewhere a line is printed now and then, as :class:`Progress` does.
    """
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        MofNCompleteColumn,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bar

    console = Console(stderr=True)
    if not console.is_terminal:
        progress = Progress(console)
        yield lambda done, total: progress.show(lambda: f'{what}: {done:,} of {total:,}')
        return
    columns = (
        TextColumn('{task.description}'),
        BarColumn(),
        MofNCompleteColumn(),
        TextColumn('{task.fields[rate]}'),
        TimeElapsedColumn(),
        TextColumn('left'),
        TimeRemainingColumn(),
    )
    with Bar(*columns, console=console, transient=True) as shown:
        task = shown.add_task(what, total=None, rate='')

        def report(done: int, total: int) -> None:
            shown.update(task, completed=done, total=total)
            speed = shown.tasks[0].speed
            shown.update(task, rate=f'{speed:,.0f}/s' if speed else '')

        yield report
