"""Long work on the command line: progress, time limits, and towers that reach a limit.

After 2 s of work a terminal shows the current job and its progress on stderr, on one line that is
redrawn. If stderr is not a terminal (a log file, say), a line is printed after 30 s, 1, 2 and 4
minutes, and then every 5 minutes.

A tower that reaches a limit (of states, memory or time) does not end the others: its row names the
limit, and the command ends with exit code ``LIMIT_REACHED``.
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

if TYPE_CHECKING:  # rich is imported where it is used, so that --help is fast
    from rich.console import Console
    from rich.live import Live

T = TypeVar('T')

LIMIT_REACHED = 3
"""Exit code of a command in which a tower reached a limit."""
QUIET_S = 2.0
"""Duration of work before a terminal shows progress [s]."""
FIRST_LINE_S = 30.0
"""Duration of work before the first line of progress if stderr is not a terminal [s]."""
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
    help='Time limit for each tower; an unfinished tower is reported, and the next one begins.',
)


class Progress:
    """Shows the progress of work that takes longer than 2 s."""

    def __init__(self, console: Console | None = None) -> None:
        """Start the clock; show nothing yet."""
        from rich.console import Console

        self._console = console or Console(stderr=True)
        self._began = self._drawn = monotonic()
        self._next_line_s = FIRST_LINE_S
        self._live: Live | None = None

    @property
    def patience_s(self) -> float:
        """Duration of work that is not reported [s]."""
        return QUIET_S if self._is_redrawn else FIRST_LINE_S

    @property
    def _is_redrawn(self) -> bool:
        return self._console.is_terminal and self._console.is_interactive

    def show(self, describe: Callable[[], str]) -> None:
        """Show a line if one is due; ``describe`` is called only then."""
        now = monotonic()
        passed = now - self._began
        if not self._is_redrawn:
            if passed >= self._next_line_s:
                self._next_line_s += min(self._next_line_s, _LONGEST_SILENCE_S)
                self._say(describe())
        elif passed >= QUIET_S and now - self._drawn >= _REDRAW_S:
            self._drawn = now
            self._draw(describe())

    def hide(self) -> None:
        """Remove the line, so that other output can be printed."""
        if self._live is not None:
            self._live.stop()
            self._live = None

    def say(self, line: str) -> None:
        """Print a permanent line."""
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
        work: function that does it; its argument is a token that ends it early.
        gauge: its text is the progress of the work.
    """

    name: str
    work: Callable[[CancelToken], T]
    gauge: object = ''


class Outcome(NamedTuple, Generic[T]):
    """The outcome of a job.

    Attributes:
        name: of the tower.
        result: of the work; None if it exceeded a limit.
        problem: the limit that it reached; '' if it was finished.
        took_s: duration [s].
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
    """Run jobs one after the other and yield each outcome as soon as it is known.

    Args:
        what: name of the activity, for the line of progress.
        jobs: in order.
        total: their number.
        time_limit_s: time limit of each job [s].
        progress: display of the progress; a new one by default.

    Raises:
        KeyboardInterrupt: on Ctrl-C, after the outcome of the interrupted job if it has a result.
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
    """The outcome of a job, and whether it was interrupted."""
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

    Otherwise lines are printed as by :class:`Progress`.
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
