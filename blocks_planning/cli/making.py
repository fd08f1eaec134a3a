"""The command that makes towers with wanted properties."""

from __future__ import annotations

import re
from functools import partial
from pathlib import Path

import click

from blocks_planning.board.blocks import parse_library
from blocks_planning.board.geometry import Board
from blocks_planning.cli.importing import write_towers
from blocks_planning.cli.options import library_option
from blocks_planning.cli.progress import Job, each
from blocks_planning.errors import ConfigurationError, shown
from blocks_planning.search.gauge import Gauge
from blocks_planning.towers.ranges import Range, parse_range

_EXAMPLES = """\b
Examples:
  blocks-planning stimuli make --count 8 --want holes=1-2 --out holes.txt
  blocks-planning stimuli make --size 6x8 --unsolvable --out impossible.txt
  blocks-planning stimuli make --sets 2 --want cost=1000- --balance cells,cost --out set.txt
"""


@click.command('make', epilog=_EXAMPLES)
@click.option('--out', required=True, type=click.Path(path_type=Path), help='The .txt file.')
@click.option('--replace', is_flag=True, help='Overwrite existing files.')
@click.option(
    '--count',
    type=click.IntRange(1, 1_000),
    default=8,
    show_default=True,
    help='Number of towers, in each set.',
)
@click.option(
    '--size', default='8x8', show_default=True, help='Board size, as WIDTHxHEIGHT [cells].'
)
@click.option(
    '--drop', default='6-10', show_default=True, help='Number of blocks to drop, as a range.'
)
@click.option(
    '--solvable/--unsolvable',
    default=True,
    show_default=True,
    help='Whether the library must be able to rebuild the towers.',
)
@click.option(
    '--want',
    'wishes',
    multiple=True,
    metavar='NAME=RANGE',
    help='Wanted range of a measure: 3, 3-5, 3- or -5; may be given several times.',
)
@click.option(
    '--trials',
    type=click.IntRange(1, 10_000),
    default=8,
    show_default=True,
    help='Trials of scoping with bfs that measure cost and success, if these are used.',
)
@click.option(
    '--sets', type=click.IntRange(1, 100), default=1, show_default=True, help='Number of sets.'
)
@click.option('--balance', metavar='NAMES', help='Measures whose means are balanced across sets.')
@click.option(
    '--seed', type=click.IntRange(0), default=0, show_default=True, help='Seed of the generator.'
)
@click.option(
    '--tries',
    type=click.IntRange(1),
    default=2_000,
    show_default=True,
    help='Largest number of candidates to try per tower.',
)
@library_option
def make_command(
    out: Path,
    replace: bool,
    count: int,
    size: str,
    drop: str,
    solvable: bool,
    wishes: tuple[str, ...],
    trials: int,
    sets: int,
    balance: str | None,
    seed: int,
    tries: int,
    library: str,
) -> None:
    """Generate random towers with wanted properties.

    The towers are written as text pictures. A comment above every tower lists its measures. The
    same options give the same towers. With --sets, each set has its own file: NAME-1.txt,
    NAME-2.txt, ...

    Measures: cells, width, height, holes, hole_cells, overhangs, covered_cells, roughness; blocks,
    arrangements, optimal (exact); cost [states], success (of a planner).
    """
    from blocks_planning.towers.balancing import balanced_sets
    from blocks_planning.towers.difficulty import Planner
    from blocks_planning.towers.making import Recipe, make_towers
    from blocks_planning.towers.measures import DIFFICULTY, Instruments
    from blocks_planning.towers.writing import format_set

    wanted = dict(_wish(text) for text in wishes)
    names = [name.strip() for name in balance.split(',')] if balance else []
    needs_planner = bool(DIFFICULTY.keys() & {*wanted, *names})
    recipe = Recipe(
        board=_board(size),
        dropped=parse_range(drop, '--drop'),
        library=parse_library(library, '--library'),
        solvable=solvable,
        wanted=wanted,
        instruments=Instruments(Planner(seeds=trials) if needs_planner else None),
        tries=tries,
    )
    gauge = Gauge()
    pool = 2 * sets * count if sets > 1 else count
    job = Job(str(out), partial(make_towers, recipe, pool, seed, gauge=gauge), gauge)
    [outcome] = each('make', [job], 1)
    made = outcome.result or []
    chosen = balanced_sets(made, sets, count, names, seed) if sets > 1 else [made]
    recipe_said = f'made with --size {size} --drop {drop} --seed {seed}, ' + ', '.join(
        [f'library {library}', 'solvable' if solvable else 'unsolvable', *wishes]
    )
    for number, group in enumerate(chosen, start=1):
        path = out if sets == 1 else out.with_name(f'{out.stem}-{number}{out.suffix}')
        write_towers(path, replace, format_set('made', group, [recipe_said]))
        click.echo(f'{path}: {len(group)} towers written')


def _wish(text: str) -> tuple[str, Range]:
    name, equals, wanted = text.partition('=')
    if not equals:
        raise ConfigurationError(f'--want: expected NAME=RANGE, got {shown(text)}')
    return name.strip(), parse_range(wanted, f'--want {name.strip()}')


def _board(size: str) -> Board:
    match = re.fullmatch(r'([0-9]{1,3})x([0-9]{1,3})', size)
    if match is None:
        raise ConfigurationError(f'--size: expected WIDTHxHEIGHT, such as 8x8, got {shown(size)}')
    return Board(int(match[1]), int(match[2]))
