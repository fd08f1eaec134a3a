"""The commands that serve a study, and make tables of it."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

import click

from blocks_planning.cli.sweeping import out_option

_PATH = click.Path(path_type=Path)
TOKEN_VARIABLE = 'BLOCKS_PLANNING_STUDY_TOKEN'
"""Every user of the machine could read a token in the arguments of a process."""


class _Study(click.Group):
    """A group that serves the file of a study, unless its first argument names a command."""

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        if args and args[0] not in (*self.commands, *ctx.help_option_names):
            args = ['serve', *args]
        return super().parse_args(ctx, args)


@click.group(
    cls=_Study,
    epilog='\b\nExamples:\n  blocks-planning study config/studies/example.yaml --out my_study\n'
    '  blocks-planning study export my_study --out tables',
)
def study() -> None:
    """Serve a study to participants, or make tables of what is kept of it.

    A STUDY.yaml instead of a command serves it: see blocks-planning study serve --help.
    """


@study.command(
    epilog='\b\nExamples:\n'
    '  blocks-planning study serve config/studies/example.yaml --out my_study\n'
    '  blocks-planning study serve study.yaml --out my_study --host 0.0.0.0 --port 8000'
)
@click.argument('file', metavar='STUDY.yaml', type=_PATH)
@out_option
@click.option(
    '--host',
    default='127.0.0.1',
    show_default=True,
    help="Address to serve the pages on; if it is not on this machine, the participant's page "
    'requires a token too.',
)
@click.option(
    '--port',
    type=click.IntRange(0, 65535),
    default=0,
    help='Port to serve the pages on.  [default: a free one]',
)
def serve(file: Path, out: Path, host: str, port: int) -> None:
    """Serve a study until Ctrl-C: a participant's page and an experimenter's page.

    What participants do is kept in the folder --out as it happens. The same command continues
    where it ended, for whatever reason. The experimenter's page requires a token; it is new at every
    start, unless BLOCKS_PLANNING_STUDY_TOKEN is set to 16 or more letters and digits.
    """
    from blocks_planning.study.desk import Desk
    from blocks_planning.study.spec import read_study
    from blocks_planning.view.study.server import StudyServer
    from blocks_planning.view.web.guards import address_of

    address = address_of(host, port)
    desk = Desk(read_study(file), out)
    server = StudyServer(address, desk, os.environ.get(TOKEN_VARIABLE, ''))
    for condition in desk.study.conditions:
        condition.mode.effort(desk.study.effort).prepare(desk.study.towers[0].task)
    ended = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: ended.set())
    server.start()
    click.echo(f"The participant's page: {server.address.url}")
    click.echo(f"The experimenter's page: {server.experimenter.url}")
    click.echo('Ctrl-C ends the study; nothing is lost.', err=True)
    ended.wait()
    server.stop()


@study.command(epilog='\b\nExample:\n  blocks-planning study export my_study --out tables')
@click.argument('folder', metavar='DIR', type=_PATH)
@out_option
def export(folder: Path, out: Path) -> None:
    """Write tables of a study.

    They are made of what is kept in the folder DIR, with a codebook, and the trial records. They are
    written as CSV, and as Parquet if pyarrow is installed. codebook.csv has the
    name, type, unit and meaning of every column. Sessions may run meanwhile.
    """
    from blocks_planning.study.export import export_study

    exported = export_study(folder, out)
    for name, count in exported.files.items():
        click.echo(f'{out / name}: {count:,} {"records" if name.endswith("jsonl") else "rows"}')
    click.echo('The tables are there as Parquet too.' if exported.has_parquet else 'No Parquet.')
