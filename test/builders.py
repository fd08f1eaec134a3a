"""Small towers, and the trials and records that tests are made of."""

from __future__ import annotations

import hashlib
import json
from itertools import product
from typing import Any

from blocks_planning.board.blocks import PAPER_LIBRARY, Placed, format_library, parse_library
from blocks_planning.board.geometry import Board, Mask
from blocks_planning.board.task import Task
from blocks_planning.search.result import DEFAULT_BUDGET, CancelToken
from blocks_planning.search.searches import make_search
from blocks_planning.subgoals.regions import Region, rows_label
from blocks_planning.subgoals.registry import make_strategy
from blocks_planning.trials.local import run_trial
from blocks_planning.trials.messages import Message, TrialEnded
from blocks_planning.trials.record import TrialRecord
from blocks_planning.trials.spec import TrialSpec
from blocks_planning.worlds.observation import Observation, Observations

# Towers for the paper's library, top row first.
SQUARE = '####/####/####/####'
ARCH = '####/####/#..#/#..#'
CHAIR = '#..#/#..#/####/####/#..#/#..#'
FRAME = '####/#..#/####/####'
"""Planners that look at its lower rows first may come to where they can't go on."""
ODD = '#.../##../####/####'
"""All but one cell can be filled."""
NEVER_SOLVED = '#../#../#.#'
"""Something fits, but there is no subgoal that can be filled."""
NOTHING_FITS = '.../#..'
EMPTY = '.../...'
TOWERS = [SQUARE, ARCH, CHAIR, FRAME, ODD, NEVER_SOLVED, NOTHING_FITS, EMPTY]

Settings = dict[str, Any]
_STRATEGIES: list[Settings] = [
    {'strategy': 'none'},
    {'strategy': 'scoping', 'commit': 'subgoal', 'lam': 0.01},
    {'strategy': 'scoping', 'commit': 'action', 'lam': 0.01},
    {'strategy': 'full', 'lam': 0.5},
]
_LOOKAHEAD: list[Settings] = [
    {'strategy': 'scoping', 'regions': 'rectangles', 'horizon': 2, 'max_sequences': 40},
    {'strategy': 'scoping', 'lam': 0.01, 'horizon': 3, 'max_sequences': 5, 'choice': 'softmax'},
]
_OF_STRATEGY = (
    *('commit', 'regions', 'min_cells', 'horizon', 'max_sequences'),
    *('choice', 'temperature', 'aggregate'),
)
_SEARCHES: list[Settings] = [
    {'search': 'bfs', 'depth': 1},
    {'search': 'bfs', 'depth': 3},
    {'search': 'astar', 'iterations': 16, 'divisor': 'smallest', 'execute': 'first'},
    {'search': 'astar', 'iterations': 16, 'divisor': 'mean', 'execute': 'path'},
    {'search': 'best_first', 'iterations': 9, 'execute': 'first'},
    {'search': 'random'},
    {'search': 'exact'},
]
_QUICK: list[Settings] = [{'search': 'bfs', 'depth': 1}, {'search': 'random'}]
PLANNERS = [
    {**strategy, **search}
    for strategy, search in [*product(_STRATEGIES, _SEARCHES), *product(_LOOKAHEAD, _QUICK)]
]
"""Settings for :func:`spec`: every strategy with every search, and lookahead with quick ones."""


def row_regions(*heights: int) -> tuple[Region, ...]:
    """Regions that are rows, without their cells."""
    return tuple(Region(rows_label(height), 0) for height in heights)


def as_ordered(*placements: Placed) -> Observations:
    """The observations of a trial in which these placements were ordered and carried out."""
    made = (Observation(placed.placement, (placed,)) for placed in placements)
    return (Observation(), *made)


def planner_id(settings: dict[str, Any]) -> str:
    """A readable name of the settings of a planner."""
    return '-'.join(map(str, settings.values()))


def picture(rows: str) -> tuple[Board, Mask]:
    """The board and mask of a picture whose rows, top row first, are divided by slashes."""
    lines = rows.split('/')
    board = Board(len(lines[0]), len(lines))
    return board, board.parse(lines)


def task(rows: str, library: str = format_library(PAPER_LIBRARY)) -> Task:
    """The task of a picture."""
    return Task(*picture(rows), parse_library(library))


def spec(
    rows: str = ARCH,
    *,
    library: str = format_library(PAPER_LIBRARY),
    strategy: str = 'scoping',
    search: str = 'bfs',
    seed: int = 0,
    budget: int = DEFAULT_BUDGET,
    stimulus: str = 'small',
    **settings: Any,
) -> TrialSpec:
    """A trial; ``lam`` and the settings of ``scoping`` go to the strategy, the others to the search."""
    of_strategy = {
        name: settings.pop(key)
        for key, name in (('lam', 'lambda'), *((name, name) for name in _OF_STRATEGY))
        if key in settings
    }
    return TrialSpec(
        stimulus=stimulus,
        task=task(rows, library),
        strategy=make_strategy(strategy, of_strategy),
        search=make_search(search, settings),
        seed=seed,
        budget=budget,
    )


def record(rows: str = ARCH, **settings: Any) -> TrialRecord:
    """The record of a trial; see :func:`spec`."""
    return run_trial(spec(rows, **settings))


def record_json(rows: str = ARCH, **settings: Any) -> dict[str, Any]:
    """A record as JSON of its own, which a test may change."""
    loaded: dict[str, Any] = json.loads(record(rows, **settings).to_line())
    return loaded


def remade(data: dict[str, Any]) -> dict[str, Any]:
    """A record as JSON, with sums and name made again from the parts that a test changed."""
    begun = [
        part for entry in data['decisions'] for part in entry['subgoals'][: entry['executed']]
    ]
    standing: list[Any] = []
    for seen in data['observations']:
        standing = [block for block in standing if block not in seen['gone']] + seen['landed']
    data['placements'] = standing
    data['blocks'] = len(standing)
    data['orders'] = sum(seen['ordered'] is not None for seen in data['observations'])
    data['surprises'] = sum(
        seen['ordered'] is None
        or bool(seen['gone'])
        or [[*block[:3]] for block in seen['landed']] != [seen['ordered']]
        for seen in data['observations'][1:]
    )
    data |= _measures(data)
    data['subgoals'] = sum(entry['executed'] for entry in data['decisions'])
    data['action_planning_cost'] = sum(part['planning_cost'] for part in begun)
    data['solution_cost'] = sum(part['solution_cost'] for part in begun)
    data['subgoal_planning_cost'] = sum(
        entry['subgoal_planning_cost'] for entry in data['decisions']
    )
    known_before = json.dumps({key: data[key] for key in spec().to_json()}, sort_keys=True)
    data['trial_id'] = hashlib.blake2b(known_before.encode(), digest_size=8).hexdigest()
    return data


def _measures(data: dict[str, Any]) -> dict[str, float]:
    rows = data['silhouette'][::-1]
    target = {(c, r) for r, row in enumerate(rows) for c, sign in enumerate(row) if sign == '#'}
    filled = {
        (c, r)
        for width, height, column, row in data['placements']
        for c in range(column, column + width)
        for r in range(row, row + height)
    }
    both = len(target & filled)

    def ratio(part: int, whole: int) -> float:
        return part / whole if whole else 1.0

    return {
        'recall': ratio(both, len(target)),
        'precision': ratio(both, len(filled)),
        'f1': ratio(2 * both, len(filled) + len(target)),
        'iou': ratio(both, len(filled | target)),
    }


def ended(trial_id: str, record: TrialRecord) -> TrialEnded:
    """The end of a trial, as the scribe says it."""
    return TrialEnded(trial_id, record.status, record.reason, record)


def cancelled_record(trial: TrialSpec, messages: int) -> TrialRecord:
    """The record of a trial that is cancelled when it has carried so many messages."""
    cancel = CancelToken()
    seen: list[Message] = []

    def observe(message: Message) -> None:
        seen.append(message)
        if len(seen) == messages:
            cancel.cancel()

    return run_trial(trial, cancel, observe)
