"""The file of a study: what a lab writes down once, as YAML.

::

    title: Rebuilding towers
    consent: |                     # texts are Markdown, see docs/study.md
      You will rebuild towers ...
    instructions: [...]            # optional: pages, before anything else
    conditions:
      - name: scoping              # a word of your own
        mode: scoping              # or building
        instructions: [...]        # optional: pages, before its first tower
        practice: [cogsci2021/16]  # optional: towers to begin with, as they are listed
        time_limit_s: 120          # optional: of a tower [s]
        mark_parts: true           # optional: mark the parts of each tower before it
    towers: [cogsci2021/5, ...]    # addresses, as on the command line
    library: 1x2,2x1,2x2           # optional: the paper's library if left out
    order: latin square            # or fixed, or shuffled
    conditions_per_person: all     # optional: or one
    seed: 1                        # optional: 0 if left out
    break_every: 4                 # optional: towers between two breaks
    break_text: ...                # optional
    debrief: |
      Thank you ...
    search: {name: bfs, depth: 3}  # optional: finds out whether a region can be filled
    budget: 100000                 # optional [states]
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any, TypeVar

from blocks_planning.board.blocks import Library, format_library
from blocks_planning.located import Located, read_yaml
from blocks_planning.search.randomness import MAX_SEED
from blocks_planning.search.searches import make_own_search, make_search
from blocks_planning.settings import settings_of
from blocks_planning.study.modes import MODES, Effort, Mode
from blocks_planning.study.orders import ORDERS
from blocks_planning.trials.script import (
    Tower,
    list_towers,
    read_budget,
    read_library,
    read_planners,
    read_text,
    read_whole,
)

T = TypeVar('T')
DEFAULT_BREAK = 'Take a break if you like. Go on whenever you are ready.'
MAX_LIMIT_S = 86_400
MOST_TRIALS = 1000
"""Most trials of a participant."""
_NAME = re.compile(r'[A-Za-z0-9_-]{1,32}')
_SPREADS = ('all', 'one')


@dataclass(frozen=True)
class Condition:
    """A kind of trial of a study.

    Attributes:
        name: in tables.
        mode: what is done.
        instructions: pages before its first trial.
        practice: towers to begin with.
        time_limit_s: of a trial [s]; 0: none.
        mark_parts: whether the parts of each silhouette are marked before its trial.
    """

    name: str
    mode: Mode
    instructions: tuple[str, ...]
    practice: tuple[Tower, ...]
    time_limit_s: int
    mark_parts: bool = False


@dataclass(frozen=True)
class Study:
    """What a lab wrote down; see the module for the meaning of each attribute.

    ``order`` is of :data:`ORDERS`; ``break_every`` is 0 for no breaks.
    """

    title: str
    consent: str
    instructions: tuple[str, ...]
    conditions: tuple[Condition, ...]
    towers: tuple[Tower, ...]
    order: str
    conditions_per_person: str
    seed: int
    break_every: int
    break_text: str
    debrief: str
    effort: Effort

    def to_json(self) -> dict[str, Any]:
        """Everything that the study says, silhouettes included."""
        return {
            **{key: value for key, value in vars(self).items() if key not in _MADE_OF_PARTS},
            'conditions': [_condition_to_json(one) for one in self.conditions],
            'towers': [_tower_to_json(one) for one in self.towers],
            'search': {
                'name': self.effort.search.name,
                **settings_of(self.effort.search),
            },
            'budget': self.effort.budget,
        }

    @property
    def study_id(self) -> str:
        """A name made of all of it."""
        text = json.dumps(self.to_json(), sort_keys=True)
        return hashlib.blake2b(text.encode(), digest_size=8).hexdigest()


_MADE_OF_PARTS = ('conditions', 'towers', 'effort')


def _condition_to_json(condition: Condition) -> dict[str, Any]:
    found = {
        **vars(condition),
        'mode': condition.mode.name,
        'practice': [_tower_to_json(one) for one in condition.practice],
    }
    if not condition.mark_parts:
        del found['mark_parts']  # studies that began before this key existed keep their id
    return found


def _tower_to_json(tower: Tower) -> dict[str, Any]:
    board = tower.task.board
    return {
        'name': tower.name,
        'silhouette': board.draw(tower.task.silhouette).split('\n'),
        'library': format_library(tower.task.library),
    }


def read_study(path: Path) -> Study:
    """Read the file of a study.

    Raises:
        ConfigurationError: naming file, line and key, for an unknown or missing key, or a value
            that it cannot have.
        StimulusError: for an address that names nothing.
    """
    top = read_yaml(path).entries(
        *('title', 'consent', 'conditions', 'towers', 'order', 'debrief'),
        optional=(
            *('instructions', 'library', 'conditions_per_person', 'seed', 'break_every'),
            *('break_text', 'search', 'budget'),
        ),
    )
    library = read_library(top)
    towers = tuple(list_towers(top['towers'], library))
    conditions = tuple(_condition(one, library) for one in top['conditions'].items())
    names = [condition.name for condition in conditions]
    if len(set(names)) < len(names):
        raise top['conditions'].fail(f'names must differ, got {", ".join(names)}')
    trials = sum(len(towers) + len(condition.practice) for condition in conditions)
    if trials > MOST_TRIALS:
        raise top['towers'].fail(f'expected at most {MOST_TRIALS} trials, got {trials}')
    return Study(
        title=read_text(top['title']),
        consent=read_text(top['consent']),
        instructions=_optional(top, 'instructions', _texts, ()),
        conditions=conditions,
        towers=towers,
        order=_word(top['order'], tuple(ORDERS)),
        conditions_per_person=_optional(
            top, 'conditions_per_person', partial(_word, words=_SPREADS), _SPREADS[0]
        ),
        seed=_optional(top, 'seed', partial(read_whole, name='seed', least=0, most=MAX_SEED), 0),
        break_every=_optional(
            top,
            'break_every',
            partial(read_whole, name='break_every', least=1, most=MOST_TRIALS),
            0,
        ),
        break_text=_optional(top, 'break_text', read_text, DEFAULT_BREAK),
        debrief=read_text(top['debrief']),
        effort=Effort(_optional(top, 'search', _search, make_search('bfs', {})), read_budget(top)),
    )


def _optional(top: Mapping[str, Located], key: str, read: Callable[[Located], T], default: T) -> T:
    return read(top[key]) if key in top else default


def _texts(listed: Located) -> tuple[str, ...]:
    return tuple(read_text(item) for item in listed.items())


def _word(value: Located, words: tuple[str, ...]) -> str:
    text = read_text(value)
    if text not in words:
        raise value.fail(f'expected one of {", ".join(words)}, got {value}')
    return text


def _flag(value: Located) -> bool:
    if not isinstance(value.content, bool):
        raise value.fail(f'expected true or false, got {value}')
    return value.content


def _search(value: Located) -> Any:
    searches = read_planners(Located([value], value.place), make_own_search)
    if len(searches) != 1:
        raise value.fail(f'expected one search, got {len(searches)}')
    return searches[0]


def _condition(value: Located, library: Library) -> Condition:
    entries = value.entries(
        *('name', 'mode'), optional=('instructions', 'practice', 'time_limit_s', 'mark_parts')
    )
    name = read_text(entries['name'])
    if not _NAME.fullmatch(name):
        raise entries['name'].fail(f'expected up to 32 letters, digits, _ and -, got {name!r}')
    limit = partial(read_whole, name='time_limit_s', least=1, most=MAX_LIMIT_S)
    towers = partial(list_towers, library=library)
    return Condition(
        name=name,
        mode=MODES[_word(entries['mode'], tuple(MODES))],
        instructions=_optional(entries, 'instructions', _texts, ()),
        practice=tuple(_optional(entries, 'practice', towers, [])),
        time_limit_s=_optional(entries, 'time_limit_s', limit, 0),
        mark_parts=_optional(entries, 'mark_parts', _flag, False),
    )
