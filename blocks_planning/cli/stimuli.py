"""Commands that show, import and generate silhouettes."""

from __future__ import annotations

import click

from blocks_planning.board.pictures import read_file
from blocks_planning.board.stimuli import installed_sets
from blocks_planning.cli.importing import import_towers
from blocks_planning.cli.making import make_command
from blocks_planning.cli.options import find_all, stimuli_argument


@click.group(
    invoke_without_command=True,
    epilog='\b\nExamples:\n  blocks-planning stimuli\n  blocks-planning stimuli show cogsci2021/9',
)
@click.pass_context
def stimuli(context: click.Context) -> None:
    """List the sets of silhouettes that ship with the package."""
    if context.invoked_subcommand is None:
        for name, path in installed_sets().items():
            silhouettes = read_file(path)
            sizes = sorted({f'{board.width}x{board.height}' for board, _ in silhouettes.values()})
            click.echo(f'{name}: {len(silhouettes)} silhouettes, {", ".join(sizes)} cells')


@stimuli.command(epilog='\b\nExample:\n  blocks-planning stimuli show cogsci2021/9')
@stimuli_argument
def show(addresses: tuple[str, ...]) -> None:
    """Draw silhouettes."""
    for index, stimulus in enumerate(find_all(addresses)):
        click.echo('\n' * bool(index) + f'# {stimulus.name}\n\n{stimulus.draw()}')


stimuli.add_command(import_towers)
stimuli.add_command(make_command)
