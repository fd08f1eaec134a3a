"""The commands that serve a study, and make tables of it."""

from __future__ import annotations

from pathlib import Path

import click

from blocks_planning.cli.sweeping import out_option

_PATH = click.Path(path_type=Path)


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


@study.command()
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
