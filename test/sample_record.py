"""A record of a trial, parts of it to change, and how it is refused when they are."""

from __future__ import annotations

import json
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from builders import CHAIR, record, record_json

from blocks_planning.errors import RecordError
from blocks_planning.trials.reading import read_records

KEYS = [
    *('format', 'version', 'trial_id', 'stimulus', 'width', 'height', 'silhouette', 'library'),
    *('built', 'strategy', 'strategy_settings', 'search', 'search_settings'),
    *('world', 'world_settings', 'seed', 'budget', 'status', 'reason'),
    *('blocks', 'orders', 'surprises', 'subgoals'),
    *('action_planning_cost', 'subgoal_planning_cost', 'solution_cost'),
    *('recall', 'precision', 'f1', 'iou'),
    *('placements', 'observations', 'decisions', 'proposals'),
]
# Three decisions, in the first several candidates, the first of them unsolved.
SAMPLE = record_json(CHAIR, lam=0.2, depth=2)
OBSERVATION, DECISION, REGION, CANDIDATE, SUBGOAL = (
    ('observations', 1),
    ('decisions', 0),
    ('decisions', 0, 'regions', 1),
    ('decisions', 0, 'candidates', 1),
    ('decisions', 0, 'subgoals', 0),
)
Keys = tuple[str | int, ...]


def at(data: Any, path: Keys) -> Any:
    """A part of some JSON."""
    for key in path:
        data = data[key]
    return data


def changed(path: Keys, value: object) -> dict[str, Any]:
    """The sample with one value changed."""
    data = deepcopy(SAMPLE)
    at(data, path[:-1])[path[-1]] = value
    return data


def refused(tmp_path: Path, text: str) -> str:
    """The message, after the place, with which line 2 of a file is refused."""
    path = tmp_path / 'records.jsonl'
    path.write_text(f'{json.dumps(SAMPLE)}\n{text}\n')
    with pytest.raises(RecordError) as caught:
        read_records(path)
    return after_place(caught.value, f'{path}, line 2')


def after_place(error: RecordError, place: str) -> str:
    """The message of an error, which begins with its place and has one line."""
    message = str(error)
    assert len(message.splitlines()) == 1
    assert message.startswith(place)
    return message.removeprefix(place)


LINE = record().to_line()
PARTS: list[Keys] = [(), OBSERVATION, DECISION, REGION, CANDIDATE, SUBGOAL]
OBJECTS = [(path, key) for path in PARTS for key in at(SAMPLE, path)]


def name_of(path: object) -> str:
    return '.'.join(map(str, path)) or 'record' if isinstance(path, tuple) else str(path)


COUNTS = [(path, key) for path, key in OBJECTS if type(at(SAMPLE, (*path, key))) is int]
