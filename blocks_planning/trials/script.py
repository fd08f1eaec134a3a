"""Trial scripts: which trials to run, as YAML.

::

    stimuli: [cogsci2021/5, my/towers.txt]   # addresses, as on the command line
    library: 1x2,2x1,2x2                     # optional; default: the paper's library
    seeds: 4                                 # number of seeds, from first_seed upwards
    pause_s: 5                               # optional: between trials [s]
    first_seed: 0                            # optional
    budget: 100000                           # optional [states]
    searches:
      - {name: bfs, depth: [2, 3]}
    strategies:
      - {name: none}
      - {name: scoping, lambda: {from: 0, to: 0.008, count: 5}}
    worlds:                                  # optional; default: every order is obeyed
      - {name: simulated}
    built: [[2, 1, 0, 0]]                    # optional: blocks that stand at the start, each
                                             # [width, height, column, row]

A setting may be a list, or evenly spaced numbers ``{from, to, count}`` with both ends. Then there
is one search, strategy or world for each value, or for each combination of values if there are
several lists. The trials are all combinations, in the order worlds, strategies, searches, stimuli,
seeds; the seed changes fastest. Paths of stimuli are relative to the working directory.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from itertools import product
from math import prod
from pathlib import Path
from typing import Any, NamedTuple

from blocks_planning.board.blocks import PAPER_LIBRARY, Library, Placed, parse_library
from blocks_planning.board.geometry import MAX_SIDE
from blocks_planning.board.stimuli import find_stimuli
from blocks_planning.board.task import Task
from blocks_planning.errors import ConfigurationError
from blocks_planning.located import Located, read_yaml
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.result import DEFAULT_BUDGET, MAX_BUDGET
from blocks_planning.search.searches import make_search
from blocks_planning.settings import check_whole
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.observation import Blocks
from blocks_planning.worlds.world import Simulated, World, make_world

MAX_SEEDS = 1_000_000
MAX_VALUES = 10_000
MAX_PAUSE_S = 86_400
MAX_PLANNERS = 100_000
MAX_TRIALS = 10_000_000


class Tower(NamedTuple):
    """A silhouette by its name, as a task."""

    name: str
    task: Task


class Script(NamedTuple):
    """Trials in order, and how long to wait between them [s]."""

    trials: list[TrialSpec]
    pause_s: float


def read_script(path: Path, participant: str = '') -> list[TrialSpec]:
    """The trials of a script; see :func:`read_session`."""
    return read_session(path, participant).trials


def read_session(path: Path, participant: str = '') -> Script:
    """A script.

    Args:
        path: of the file.
        participant: code of the person in all trials whose strategy asks a person; '': as in the
            script.

    Raises:
        ConfigurationError: naming file, line and key, for an unknown or missing key, a value
            out of range, a trial that is described twice, or more than ``MAX_TRIALS`` trials.
    """
    script = read_yaml(path)
    top = script.entries(
        'stimuli',
        'seeds',
        'searches',
        'strategies',
        optional=('library', 'first_seed', 'budget', 'pause_s', 'worlds', 'built'),
    )
    towers, seeds = read_towers(top), read_seeds(top)
    strategies = read_planners(top['strategies'], make_strategy)
    if participant:
        strategies = _with_participant(path, strategies, participant)
    searches = read_planners(top['searches'], make_search)
    budget, worlds, built = read_budget(top), read_worlds(top), _read_built(top)
    if prod(map(len, (towers, seeds, strategies, searches, worlds))) > MAX_TRIALS:
        raise script.fail(f'describes more than {MAX_TRIALS} trials')
    specs = [
        top['built' if built else 'stimuli'].check(
            partial(
                TrialSpec, tower.name, tower.task, strategy, search, seed, budget, world, built
            )
        )
        for world in worlds
        for strategy in strategies
        for search in searches
        for tower in towers
        for seed in seeds
    ]
    if len({spec.trial_id for spec in specs}) < len(specs):
        raise script.fail('describes a trial twice')
    return Script(specs, _read_pause(top))


def _with_participant(path: Path, strategies: list[Any], code: str) -> list[Any]:
    if not any(strategy.asks_person for strategy in strategies):
        raise ConfigurationError(
            f'{path}: participant {code!r} was given, but no strategy in the script asks a person'
        )
    return [
        replace(strategy, participant=code) if strategy.asks_person else strategy
        for strategy in strategies
    ]


def read_worlds(top: Mapping[str, Located]) -> list[World]:
    """The worlds of the key ``worlds``; by default one that obeys every order."""
    if 'worlds' not in top:
        return [Simulated()]
    return read_planners(top['worlds'], make_world)


def _read_built(top: Mapping[str, Located]) -> Blocks:
    """The blocks of the key ``built``, each [width, height, column, row]."""
    if 'built' not in top:
        return ()
    return tuple(_block(item) for item in top['built'].items())


def _block(item: Located) -> Placed:
    numbers = [read_whole(number, 'a block', 0, MAX_SIDE) for number in item.items()]
    if len(numbers) != 4 or not (numbers[0] and numbers[1]):
        raise item.fail(f'expected [width, height, column, row] of a block, got {numbers}')
    return Placed(*numbers)


def _read_pause(top: Mapping[str, Located]) -> float:
    if 'pause_s' not in top:
        return 0.0
    pause_s = _number(top['pause_s'])
    if not 0 <= pause_s <= MAX_PAUSE_S:
        raise top['pause_s'].fail(f'expected 0 to {MAX_PAUSE_S} s, got {pause_s}')
    return pause_s


def read_towers(top: Mapping[str, Located]) -> list[Tower]:
    """The towers of the keys ``stimuli`` and ``library``."""
    return list_towers(top['stimuli'], read_library(top))


def read_library(top: Mapping[str, Located]) -> Library:
    """The blocks of the key ``library``; the paper's if it is left out."""
    if 'library' not in top:
        return PAPER_LIBRARY
    blocks = read_text(top['library'])
    return top['library'].check(lambda: parse_library(blocks))


def list_towers(listed: Located, library: Library) -> list[Tower]:
    """The towers of a list of addresses."""
    return [tower for address in listed.items() for tower in _towers(address, library)]


def read_seeds(top: Mapping[str, Located]) -> tuple[int, ...]:
    """The seeds of the keys ``seeds`` and ``first_seed``."""
    count = read_whole(top['seeds'], 'seeds', 1, MAX_SEEDS)
    first = 0
    if 'first_seed' in top:
        first = read_whole(top['first_seed'], 'first_seed', 0, MAX_SEED)
    top['seeds'].check(lambda: check_whole('the last seed', first + count - 1, 0, MAX_SEED))
    return tuple(range(first, first + count))


def read_budget(top: Mapping[str, Located]) -> int:
    """The budget of the key ``budget`` [states]."""
    if 'budget' not in top:
        return DEFAULT_BUDGET
    return read_whole(top['budget'], 'budget', 0, MAX_BUDGET)


def _towers(address: Located, library: Library) -> list[Tower]:
    text = read_text(address)
    stimuli = address.check(lambda: find_stimuli(text))
    return [Tower(s.name, Task(s.board, s.silhouette, library)) for s in stimuli]


def read_planners(listed: Located, make: Callable[[object, Mapping[str, Any]], Any]) -> list[Any]:
    """The members of a family that a list of names and settings describes."""
    things = []
    for item in listed.items():
        entries = dict(item.mapping())
        if 'name' not in entries:
            raise item.fail("missing key 'name'")
        name = entries.pop('name')
        name.check(partial(make, name.plain(), {}))
        _check_each(entries, partial(make, name.plain()))
        ranges = [_values(value) for value in entries.values()]
        if prod(map(len, ranges)) > MAX_PLANNERS:
            raise item.fail(f'describes more than {MAX_PLANNERS} combinations of settings')
        for combination in product(*ranges):
            values = dict(zip(entries, combination, strict=True))
            things.append(item.check(partial(make, name.plain(), values)))
    return things


def _check_each(entries: Mapping[str, Located], make: Callable[[Mapping[str, Any]], Any]) -> None:
    """Check the first value of every setting at its own line.

    Words come first, because one of them (``regions``) can decide which other settings there are.
    """
    words: dict[str, Any] = {}
    firsts = {key: _values(value)[0] for key, value in entries.items()}
    for key in sorted(firsts, key=lambda key: not isinstance(firsts[key], str)):
        entries[key].check(partial(make, {**words, key: firsts[key]}))
        if isinstance(firsts[key], str):
            words[key] = firsts[key]


def _values(value: Located) -> list[Any]:
    """The values of a setting: a single one, those of a list, or evenly spaced ones."""
    if isinstance(value.content, list):
        return [item.plain() for item in value.items()]
    if not isinstance(value.content, dict):
        return [value.content]
    entries = value.entries('from', 'to', 'count')
    count = read_whole(entries['count'], 'count', 2, MAX_VALUES)
    first, last = _number(entries['from']), _number(entries['to'])
    steps = count - 1
    return [first + (last - first) * index / steps for index in range(steps)] + [last]


def read_whole(value: Located, name: str, least: int, most: int) -> int:
    """A whole number from ``least`` to ``most``."""
    value.check(lambda: check_whole(name, value.plain(), least, most))
    return int(value.content)


def _number(value: Located) -> float:
    if isinstance(value.content, bool) or not isinstance(value.content, (int, float)):
        raise value.fail(f'expected a number, got {value}')
    try:
        return float(value.content)
    except OverflowError:
        raise value.fail('expected a number, got one with hundreds of digits') from None


def read_text(value: Located) -> str:
    """Text that is not empty."""
    if not isinstance(value.content, str) or not value.content:
        raise value.fail(f'expected text, got {value}')
    return value.content
