"""Options that commands share, and what they are turned into."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import click

from blocks_planning.board.blocks import PAPER_LIBRARY, format_library, parse_library
from blocks_planning.board.stimuli import Stimulus, find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.search.searches import DIVISORS, EXECUTIONS, SEARCHES, make_search
from blocks_planning.subgoals.registry import make_planner, planner_names
from blocks_planning.subgoals.scoping import COMMITS
from blocks_planning.trials.spec import TrialSpec

Command = TypeVar('Command', bound=Callable[..., Any])

stimuli_argument = click.argument('addresses', metavar='STIMULUS...', nargs=-1, required=True)
library_option = click.option(
    '--library',
    default=format_library(PAPER_LIBRARY),
    show_default=True,
    help='Blocks as WIDTHxHEIGHT, in the order in which searches try them.',
)
json_option = click.option('--json', 'as_json', is_flag=True, help='One JSON object per line.')

_STRATEGY_SETTINGS = ('lambda', 'commit')
_SEARCH_SETTINGS = ('depth', 'iterations', 'divisor', 'execute')

_PLANNER_OPTIONS = (
    click.option(
        '--strategy',
        type=click.Choice(planner_names()),
        default='scoping',
        show_default=True,
        help='How subgoals are chosen.',
    ),
    click.option(
        '--lambda',
        type=float,
        help='Cells that a state evaluated costs (scoping: 0.002; full: 1).',
    ),
    click.option(
        '--commit',
        type=click.Choice(COMMITS),
        help='What scoping executes before it looks again (subgoal).',
    ),
    click.option(
        '--search',
        type=click.Choice(list(SEARCHES)),
        default='bfs',
        show_default=True,
        help='How a region is filled.',
    ),
    click.option('--depth', type=int, help='Placements that bfs looks ahead (3).'),
    click.option('--iterations', type=int, help='Nodes that astar and best_first take (4096).'),
    click.option(
        '--divisor', type=click.Choice(DIVISORS), help="Block area in astar's h (smallest)."
    ),
    click.option(
        '--execute',
        type=click.Choice(EXECUTIONS),
        help='What of a path astar and best_first execute (first).',
    ),
    click.option(
        '--budget',
        type=int,
        default=DEFAULT_BUDGET,
        show_default=True,
        help='States after which a solve begins no further attempt; 0 for a single attempt.',
    ),
    click.option('--seed', type=int, default=0, show_default=True, help='Of every tie.'),
    library_option,
)


def planner_options(command: Command) -> Command:
    """Add the options that say who plans; :func:`specs_of` reads them."""
    for option in reversed(_PLANNER_OPTIONS):
        command = option(command)
    return command


def find_all(addresses: tuple[str, ...]) -> list[Stimulus]:
    """The silhouettes of all addresses, in order."""
    return [stimulus for address in addresses for stimulus in find_stimuli(address)]


def task_of(stimulus: Stimulus, library: str) -> Task:
    """The task of a silhouette and the ``--library`` option."""
    return Task(stimulus.board, stimulus.silhouette, parse_library(library, '--library'))


def specs_of(addresses: tuple[str, ...], seeds: int, options: dict[str, Any]) -> list[TrialSpec]:
    """The trials of some stimuli, each with so many seeds from ``--seed`` upwards.

    Raises:
        ConfigurationError: for a setting that the strategy or search does not have, or a value
            out of its range.
        StimulusError: for an address that names nothing.
    """
    strategy = make_planner(options['strategy'], _given(options, _STRATEGY_SETTINGS))
    search = make_search(options['search'], _given(options, _SEARCH_SETTINGS))
    first = options['seed']
    return [
        TrialSpec(
            stimulus=stimulus.name,
            task=task_of(stimulus, options['library']),
            strategy=strategy,
            search=search,
            seed=seed,
            budget=options['budget'],
        )
        for stimulus in find_all(addresses)
        for seed in range(first, first + seeds)
    ]


def _given(options: dict[str, Any], names: tuple[str, ...]) -> dict[str, Any]:
    return {name: options[name] for name in names if options[name] is not None}


def refuse_nan(_: click.Context, __: click.Parameter, number: float) -> float:
    """Refuse the number that no range of numbers leaves out."""
    if number != number:
        raise click.BadParameter('nan is not a number of seconds')
    return number
