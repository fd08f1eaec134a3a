"""Options that commands share, and the conversion of their values."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, TypeAlias, TypeVar

import click

from blocks_planning.board.blocks import PAPER_LIBRARY, format_library, parse_library
from blocks_planning.board.stimuli import Stimulus, find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.search.result import DEFAULT_BUDGET
from blocks_planning.trials.flat import FlatSetting, flat_settings, members_from
from blocks_planning.trials.spec import FAMILIES, TrialSpec

Command = TypeVar('Command', bound=Callable[..., Any])
Decorator: TypeAlias = Callable[[Any], Any]

stimuli_argument = click.argument('addresses', metavar='STIMULUS...', nargs=-1, required=True)
library_option = click.option(
    '--library',
    default=format_library(PAPER_LIBRARY),
    show_default=True,
    help='Blocks as WIDTHxHEIGHT, in the order in which searches generate children.',
)
json_option = click.option('--json', 'as_json', is_flag=True, help='One JSON object per line.')

DEFAULTS = {'strategy': 'scoping', 'search': 'bfs', 'world': 'simulated'}
_FAMILY_HELP = {
    'strategy': 'Subgoal planner.',
    'search': 'Action-level search.',
    'world': 'World that executes the orders.',
}
_TYPES: dict[type, Any] = {
    bool: click.BOOL,
    int: click.INT,
    float: click.FLOAT,
    str: click.STRING,
}


def _decides_alone(cls: type[Any]) -> bool:
    """Whether a member of a family needs no person and no other process."""
    asks_person = getattr(cls, 'asks_person', False)
    return not (asks_person or cls.is_external) and getattr(cls, 'simulates', True)


def planner_options(command: Command) -> Command:
    """Add the options for planner, world and seed; :func:`specs_of` reads them."""
    for option in reversed([*_family_options(), *_TRIAL_OPTIONS]):
        command = option(command)
    return command


def _family_options() -> Iterator[Decorator]:
    settings = flat_settings(_decides_alone)
    for family, registry in FAMILIES.items():
        names = [name for name, cls in registry.items() if _decides_alone(cls)]
        yield click.option(
            f'--{family}',
            type=click.Choice(names),
            default=DEFAULTS[family],
            show_default=True,
            help=_FAMILY_HELP[family],
        )
        for flat in settings:
            if flat.family == family:
                yield _setting_option(flat)


def _setting_option(flat: FlatSetting) -> Decorator:
    return click.option(
        f'--{flat.name.replace("_", "-")}',
        flat.name,
        type=click.Choice(flat.choices) if flat.choices else _TYPES[flat.kind],
        help=f'{flat.text}  [default: {flat.defaults}]',
    )


_TRIAL_OPTIONS: tuple[Decorator, ...] = (
    click.option(
        '--budget',
        type=int,
        default=DEFAULT_BUDGET,
        show_default=True,
        help='Number of evaluated states after which a solve starts no further attempt; 0: one attempt.',
    ),
    click.option('--seed', type=int, default=0, show_default=True, help='Seed for tie-breaking.'),
    library_option,
)


def find_all(addresses: tuple[str, ...]) -> list[Stimulus]:
    """The silhouettes of all addresses, in order."""
    return [stimulus for address in addresses for stimulus in find_stimuli(address)]


def task_of(stimulus: Stimulus, library: str) -> Task:
    """The task of a silhouette and the ``--library`` option."""
    return Task(stimulus.board, stimulus.silhouette, parse_library(library, '--library'))


def specs_of(addresses: tuple[str, ...], seeds: int, options: dict[str, Any]) -> list[TrialSpec]:
    """The trials of some stimuli, each with ``seeds`` seeds from ``--seed`` upwards.

    Raises:
        ConfigurationError: for a setting that the chosen planner or world does not have, or a value
            out of its range.
        StimulusError: for an address that names nothing.
    """
    names = {family: options[family] for family in FAMILIES}
    members = members_from(names, options, flat_settings(_decides_alone))
    first = options['seed']
    return [
        TrialSpec(
            stimulus=stimulus.name,
            task=task_of(stimulus, options['library']),
            seed=seed,
            budget=options['budget'],
            **members,
        )
        for stimulus in find_all(addresses)
        for seed in range(first, first + seeds)
    ]


def refuse_nan(_: click.Context, __: click.Parameter, number: float) -> float:
    """Refuse NaN, which passes every range check."""
    if number != number:
        raise click.BadParameter('expected a number of seconds, got nan')
    return number
